// SPDX-License-Identifier: MIT
/// How is a picture written? OpenImageIO by the file's extension: 8-bit sRGB, or linear floats where the
/// format has them.
#include <OpenImageIO/imageio.h>

#include <bit>
#include <string_view>

#include "io/file.hpp"
#include "setka/io.hpp"

namespace setka::io {

namespace {

using detail::fail_write;

enum class Pixels { Srgb8, LinearFloat };

struct ImageFormat {
    std::string_view extension;
    Pixels pixels;
};

constexpr ImageFormat formats[] = {
    {"png", Pixels::Srgb8},       {"jpg", Pixels::Srgb8},      {"jpeg", Pixels::Srgb8},
    {"tif", Pixels::Srgb8},       {"tiff", Pixels::Srgb8},     {"bmp", Pixels::Srgb8},
    {"tga", Pixels::Srgb8},       {"ppm", Pixels::Srgb8},      {"exr", Pixels::LinearFloat},
    {"hdr", Pixels::LinearFloat}, {"pfm", Pixels::LinearFloat}};

const ImageFormat& format_of(const std::filesystem::path& file) {
    const std::string extension = detail::lower_extension(file);
    for (const ImageFormat& format : formats)
        if (extension == format.extension) return format;
    fail_write(
        file,
        (extension.empty() ? "it has no extension" : "unknown image format '" + extension + "'") +
            "; known are png, jpg, tif, bmp, tga and ppm (8-bit sRGB), exr, hdr and pfm (linear float)");
}

/// An 8-bit file takes nothing of the linear colours, which may have been left out.
void check_pixels(const Image& image, Pixels pixels) {
    const std::size_t pixel_count = std::size_t(image.width) * image.height;
    const bool has_linear =
        image.linear.size() == pixel_count || (pixels == Pixels::Srgb8 && image.linear.empty());
    if (pixel_count == 0 || !has_linear || image.srgb.size() != pixel_count * 3)
        throw Error(ErrorCategory::InvalidArgument,
                    "image: " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                        " pixels need as many linear colours (there are " +
                        std::to_string(image.linear.size()) + ") and three times as many sRGB bytes (" +
                        std::to_string(image.srgb.size()) + "), and at least one");
}

/// OpenImageIO 2.4 reads PFM but does not write it. Rows go from the bottom up; -1 says little-endian.
void write_pfm(detail::PendingStream& stream, const Image& image) {
    const std::string header =
        "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
    stream.write(header.data(), header.size());
    std::string row;
    for (std::uint32_t y = image.height; y-- > 0;) {
        row.clear();
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const Float3& pixel = image.linear[std::size_t(y) * image.width + x];
            for (const float channel : {pixel.x, pixel.y, pixel.z}) {
                const auto bits = std::bit_cast<std::uint32_t>(channel);
                for (int i = 0; i < 4; ++i) row += static_cast<char>(bits >> (8 * i) & 0xff);
            }
        }
        stream.write(row.data(), row.size());
    }
}

void write_with_oiio(const std::filesystem::path& target, const std::filesystem::path& temporary,
                     const Image& image, Pixels pixels) {
    const auto output = OIIO::ImageOutput::create(temporary.string());
    if (!output) fail_write(target, "OpenImageIO: " + OIIO::geterror());
    const bool srgb = pixels == Pixels::Srgb8;
    OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 3,
                         srgb ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    spec.attribute("oiio:ColorSpace", srgb ? "sRGB" : "Linear");
    spec.attribute("Software", "setka");
    if (const std::string extension = detail::lower_extension(target); extension.starts_with("jp"))
        spec.attribute("Compression", "jpeg:95");
    const bool written = output->open(temporary.string(), spec) &&
                         (srgb ? output->write_image(OIIO::TypeDesc::UINT8, image.srgb.data())
                               : output->write_image(OIIO::TypeDesc::FLOAT, &image.linear.data()->x)) &&
                         output->close();
    if (!written) fail_write(target, "OpenImageIO: " + output->geterror());
}

}  // namespace

void write_image(const std::filesystem::path& file, const Image& image) {
    static_assert(sizeof(Float3) == 12, "rows of pixels are handed over as floats");
    const ImageFormat& format = format_of(file);
    check_pixels(image, format.pixels);
    if (format.extension == "pfm") {
        detail::PendingStream stream(file);
        write_pfm(stream, image);
        stream.finish();
        return;
    }
    detail::PendingFile pending(file);
    write_with_oiio(file, pending.path(), image, format.pixels);
    pending.commit();
}

void check_image_writable(const std::filesystem::path& file) {
    const ImageFormat& format = format_of(file);
    if (format.extension != "pfm" && !OIIO::ImageOutput::create(std::string(format.extension)))
        fail_write(file, "OpenImageIO: " + OIIO::geterror());
    detail::PendingFile pending(file);  // made and removed again
}

}  // namespace setka::io
