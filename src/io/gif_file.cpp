// SPDX-License-Identifier: MIT
/// How do pictures become an animated GIF? OpenImageIO appends them to one file, which is renamed at the end.
#include <OpenImageIO/imageio.h>

#include <cmath>

#include "io/file.hpp"
#include "setka/animation.hpp"

namespace setka::io {

namespace {

using detail::fail_write;

const std::filesystem::path& checked_gif(const std::filesystem::path& file, double frames_per_second) {
    if (detail::lower_extension(file) != "gif") fail_write(file, "an animated picture ends with .gif");
    if (!(frames_per_second > 0) || !std::isfinite(frames_per_second))
        throw Error(
            ErrorCategory::InvalidArgument,
            "frames_per_second = " + std::to_string(frames_per_second) + "; accepted is a positive number");
    return file;
}

}  // namespace

struct GifFile::Impl {
    std::filesystem::path target;
    detail::PendingFile pending;
    std::unique_ptr<OIIO::ImageOutput> output;
    int hundredths;  ///< that a picture is shown
    std::uint32_t width = 0, height = 0;
};

GifFile::GifFile(const std::filesystem::path& file, double frames_per_second)
    : impl_(new Impl{file, detail::PendingFile(checked_gif(file, frames_per_second)),
                     OIIO::ImageOutput::create("gif"),
                     static_cast<int>(std::max(1.0, std::floor(100 / frames_per_second + 0.5)))}) {
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
    const int rate[2] = {100, impl_->hundredths};
    spec.attribute("FramesPerSecond",
                   OIIO::TypeDesc(OIIO::TypeDesc::INT, OIIO::TypeDesc::VEC2, OIIO::TypeDesc::RATIONAL), rate);
    const auto mode = is_first ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
    if (!impl_->output->open(impl_->pending.path().string(), spec, mode) ||
        !impl_->output->write_image(OIIO::TypeDesc::UINT8, image.srgb.data()))
        fail_write(impl_->target, "OpenImageIO: " + impl_->output->geterror());
}

void GifFile::finish() {
    if (impl_->width == 0) fail_write(impl_->target, "there is no picture; at least one is needed");
    if (!impl_->output->close()) fail_write(impl_->target, "OpenImageIO: " + impl_->output->geterror());
    impl_->pending.commit();
}

}  // namespace setka::io
