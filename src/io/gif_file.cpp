// SPDX-License-Identifier: MIT
/// How do pictures become an animated GIF? OpenImageIO appends them to one file, which is renamed at the end.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>

#include "io/file.hpp"
#include "setka/animation.hpp"

namespace setka::io {

namespace {

using detail::fail_write;

const std::filesystem::path& checked_gif(const std::filesystem::path& file) {
    if (detail::lower_extension(file) != "gif") fail_write(file, "an animated picture ends with .gif");
    return file;
}

/// How long a picture is shown; GIF has 16 bits for it.
int checked_hundredths(double frames_per_second) {
    const double hundredths = std::floor(100 / frames_per_second + 0.5);
    if (!(hundredths >= 1 && hundredths <= 65535)) {
        char value[32];
        std::snprintf(value, sizeof value, "%g", frames_per_second);
        throw Error(
            ErrorCategory::InvalidArgument,
            std::string("frames_per_second = ") + value +
                "; accepted is 0.001526 to 200: GIF shows a picture for 1 to 65535 hundredths of a second");
    }
    return static_cast<int>(hundredths);
}

/// The pictures of a GIF whose blocks lead to its end mark, with nothing behind; nullopt for a file that is
/// cut or has a hole. OpenImageIO does not look at whether its writes succeed.
std::optional<std::size_t> count_pictures(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const auto skip_colours = [&](int flags) {
        if (flags & 0x80) stream.ignore(std::streamsize(3) << ((flags & 7) + 1));
    };
    const auto skip_data = [&] {
        for (int size_bytes; (size_bytes = stream.get()) > 0;) stream.ignore(size_bytes);
    };
    std::string header(6, '\0');
    stream.read(header.data(), 6);
    if (header != "GIF89a" && header != "GIF87a") return std::nullopt;
    stream.ignore(4);  // width and height
    const int screen_flags = stream.get();
    stream.ignore(2);  // background and shape of a pixel
    skip_colours(screen_flags);
    for (std::size_t count = 0;;) switch (stream.get()) {
            case 0x21:  // an extension
                (void)stream.get();
                skip_data();
                break;
            case 0x2c:  // a picture
                stream.ignore(8);
                skip_colours(stream.get());
                (void)stream.get();  // bits of a code
                skip_data();
                ++count;
                break;
            case 0x3b:
                if (stream.get() != std::ifstream::traits_type::eof()) return std::nullopt;
                return count;
            default:
                return std::nullopt;
        }
}

}  // namespace

struct GifFile::Impl {
    std::filesystem::path target;
    detail::PendingFile pending;
    std::unique_ptr<OIIO::ImageOutput> output;
    int hundredths;  ///< that a picture is shown
    std::uint32_t width = 0, height = 0;
    std::size_t picture_count = 0;
};

GifFile::GifFile(const std::filesystem::path& file, double frames_per_second)
    : impl_(new Impl{file, detail::PendingFile(checked_gif(file)), OIIO::ImageOutput::create("gif"),
                     checked_hundredths(frames_per_second)}) {
    if (!impl_->output) fail_write(file, "OpenImageIO: " + OIIO::geterror());
}
GifFile::~GifFile() = default;

void GifFile::add(const Image& image) {
    const bool is_first = impl_->width == 0;
    if (image.width == 0 || image.height == 0 ||
        image.srgb.size() != std::size_t(image.width) * image.height * 3 ||
        (!is_first && (image.width != impl_->width || image.height != impl_->height)))
        throw Error(
            ErrorCategory::InvalidArgument,
            "image: " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels and " +
                std::to_string(image.srgb.size()) + " bytes; needed are three bytes a pixel, and " +
                (is_first
                     ? "at least one pixel"
                     : std::to_string(impl_->width) + " x " + std::to_string(impl_->height) + " as before"));
    impl_->width = image.width;
    impl_->height = image.height;
    OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), 3,
                         OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:Movie", 1);
    // OpenImageIO cuts 100 / rate to whole hundredths, in floats: half of one more keeps it from the edge.
    const int rate[2] = {200, 2 * impl_->hundredths + 1};
    spec.attribute("FramesPerSecond",
                   OIIO::TypeDesc(OIIO::TypeDesc::INT, OIIO::TypeDesc::VEC2, OIIO::TypeDesc::RATIONAL), rate);
    const auto mode = is_first ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
    if (!impl_->output->open(impl_->pending.path().string(), spec, mode) ||
        !impl_->output->write_image(OIIO::TypeDesc::UINT8, image.srgb.data()))
        fail_write(impl_->target, "OpenImageIO: " + impl_->output->geterror());
    ++impl_->picture_count;
}

void GifFile::finish() {
    if (impl_->width == 0) fail_write(impl_->target, "there is no picture; at least one is needed");
    if (!impl_->output->close()) fail_write(impl_->target, "OpenImageIO: " + impl_->output->geterror());
    if (count_pictures(impl_->pending.path()) != impl_->picture_count)
        fail_write(impl_->target, "not all bytes could be written: is the disk full?");
    impl_->pending.commit();
}

}  // namespace setka::io
