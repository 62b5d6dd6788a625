// SPDX-License-Identifier: MIT
/// What moves in a file, or from file to file? The public class over the kinds of motion.
#include "setka/animation.hpp"

#include <cmath>
#include <string_view>

#include "io/file.hpp"
#include "io/motion.hpp"
#include "setka/io.hpp"

namespace setka::io {

namespace {

using detail::Motion;

std::unique_ptr<Motion> open_still(const std::filesystem::path& file, const std::string& animation) {
    auto motion = std::make_unique<Motion>();
    motion->scene = load_scene(file);
    motion->files = {file};
    if (!animation.empty())
        throw Error(ErrorCategory::InvalidArgument, "animation = " + detail::in_quotes(animation, 60) + ": " +
                                                        detail::in_quotes(file.string()) +
                                                        " has no animation");
    return motion;
}

std::unique_ptr<Motion> open(const std::filesystem::path& source, const std::string& animation) {
    std::error_code error;
    const bool is_file =
        std::filesystem::exists(source, error) && !std::filesystem::is_directory(source, error);
    if (!is_file && (std::filesystem::is_directory(source, error) || detail::is_frame_pattern(source))) {
        if (!animation.empty())
            throw Error(ErrorCategory::InvalidArgument,
                        "animation = " + detail::in_quotes(animation, 60) +
                            ": a sequence of files has no names of animations");
        return detail::open_sequence(detail::find_frames(source));
    }
    const std::string extension = detail::lower_extension(source);
    return is_file && (extension == "gltf" || extension == "glb") ? detail::open_gltf(source, animation)
                                                                  : open_still(source, animation);
}

std::unique_ptr<Motion> checked(std::unique_ptr<Motion> motion) {
    try {
        motion->scene.validate();
    } catch (const Error& error) {
        detail::fail_read(motion->files.front(), error.what());
    }
    return motion;
}

}  // namespace

struct Animation::Impl {
    std::unique_ptr<Motion> motion;
};

Animation::Animation(const std::filesystem::path& source, const std::string& animation)
    : impl_(new Impl{checked(open(source, animation))}) {}
Animation::Animation(std::span<const std::filesystem::path> frames)
    : impl_(new Impl{checked(detail::open_sequence(detail::sort_frames(frames)))}) {}
Animation::~Animation() = default;
Animation::Animation(Animation&&) noexcept = default;
Animation& Animation::operator=(Animation&&) noexcept = default;

MotionKind Animation::kind() const noexcept { return impl_->motion->kind; }
const Scene& Animation::scene() const noexcept { return impl_->motion->scene; }
double Animation::duration_seconds() const noexcept { return impl_->motion->duration_seconds; }
std::uint32_t Animation::frame_count() const noexcept { return impl_->motion->frame_count; }
std::uint32_t Animation::first_frame() const noexcept { return impl_->motion->first_frame; }
const std::vector<std::string>& Animation::names() const noexcept { return impl_->motion->names; }
const std::vector<std::filesystem::path>& Animation::files() const noexcept { return impl_->motion->files; }

SceneUpdate Animation::at(double seconds) const {
    if (!std::isfinite(seconds))
        throw Error(ErrorCategory::InvalidArgument,
                    "seconds = " + std::to_string(seconds) + "; a finite number is accepted");
    return impl_->motion->at(seconds);
}

SceneUpdate Animation::frame(std::uint32_t number) const { return impl_->motion->frame(number); }

namespace detail {

SceneUpdate Motion::at(double) const { return {}; }

SceneUpdate Motion::frame(std::uint32_t number) const {
    throw Error(ErrorCategory::InvalidArgument,
                "frame = " + std::to_string(number) + ": the file has no frames; times are accepted");
}

}  // namespace detail

}  // namespace setka::io
