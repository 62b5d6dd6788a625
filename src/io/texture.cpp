// SPDX-License-Identifier: MIT
/// Which colour has a texture on the whole? Its mean, taken in linear light.
#include "io/texture.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <array>

#include "core/exact_math.hpp"

namespace setka::io::detail {

namespace {

/// A larger image is not worth the wait for one colour.
constexpr std::uint64_t max_pixels = std::uint64_t(1) << 26;

const std::array<double, 256>& linear_of_byte() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = exact::srgb_to_linear(static_cast<double>(i) / 255);
        return values;
    }();
    return table;
}

std::optional<Float3> mean_of(OIIO::ImageInput& input) {
    const OIIO::ImageSpec& spec = input.spec();
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    if (spec.width <= 0 || spec.height <= 0 || spec.depth > 1 || spec.nchannels < 1 || spec.nchannels > 16)
        return {};
    if (std::uint64_t(spec.width) * std::uint64_t(spec.height) > max_pixels) return {};
    const auto pixel_count = std::size_t(spec.width) * std::size_t(spec.height);
    std::vector<unsigned char> pixels(pixel_count * channels);
    if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, pixels.data())) return {};
    const bool grey = channels < 3;
    const bool has_alpha = channels == 2 || channels == 4;
    double sums[3] = {}, weight = 0;
    for (std::size_t i = 0; i < pixel_count; ++i) {
        const unsigned char* pixel = pixels.data() + i * channels;
        const double alpha = has_alpha ? pixel[channels - 1] / 255.0 : 1.0;
        for (std::size_t c = 0; c < 3; ++c) sums[c] += alpha * linear_of_byte()[pixel[grey ? 0 : c]];
        weight += alpha;
    }
    if (weight <= 0) return {};
    return Float3{static_cast<float>(sums[0] / weight), static_cast<float>(sums[1] / weight),
                  static_cast<float>(sums[2] / weight)};
}

}  // namespace

std::optional<Float3> mean_colour(const std::filesystem::path& image) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(image, error)) return {};
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(image.string(), &config);
    if (!input) (void)OIIO::geterror();
    return input ? mean_of(*input) : std::nullopt;
}

std::optional<Float3> mean_colour(std::span<const unsigned char> encoded) {
    // The reader is chosen by the first bytes: PNG or JPEG, the two that glTF knows.
    const bool png = encoded.size() > 4 && encoded[0] == 0x89 && encoded[1] == 'P';
    OIIO::Filesystem::IOMemReader memory(const_cast<unsigned char*>(encoded.data()), encoded.size());
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    // Created by format first: ImageInput::open() would look for a file of this name.
    const auto input = OIIO::ImageInput::create(png ? "png" : "jpeg");
    OIIO::ImageSpec spec;
    if (!input) (void)OIIO::geterror();
    if (!input || !input->set_ioproxy(&memory) || !input->open("memory", spec, config)) return {};
    const std::optional<Float3> mean = mean_of(*input);
    input->close();  // before the bytes go away
    return mean;
}

}  // namespace setka::io::detail
