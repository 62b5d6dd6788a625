// SPDX-License-Identifier: MIT
/// What do all kinds of motion have in common?
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "setka/animation.hpp"

namespace setka::io::detail {

/// What stands behind an Animation.
struct Motion {
    virtual ~Motion() = default;
    [[nodiscard]] virtual SceneUpdate at(double seconds) const;
    [[nodiscard]] virtual SceneUpdate frame(std::uint32_t number) const;

    MotionKind kind = MotionKind::None;
    Scene scene;
    double duration_seconds = 0;
    std::uint32_t frame_count = 1, first_frame = 0;
    std::vector<std::string> names;
    std::vector<std::filesystem::path> files;
};

/// A glTF file with the animation of this name or number.
[[nodiscard]] std::unique_ptr<Motion> open_gltf(const std::filesystem::path& file,
                                                const std::string& animation);
/// A glTF file without its animations: where they would start if they moved nothing.
[[nodiscard]] Scene read_posed_gltf(const std::filesystem::path& file, std::string bytes);

/// Files of one frame each, sorted by their numbers, which have to follow one another.
struct NumberedFiles {
    std::uint32_t first = 0;
    std::vector<std::filesystem::path> files;
};
/// True if a file's name is a pattern with %d.
[[nodiscard]] bool is_frame_pattern(const std::filesystem::path& path);
[[nodiscard]] NumberedFiles find_frames(const std::filesystem::path& pattern_or_folder);
[[nodiscard]] NumberedFiles sort_frames(std::span<const std::filesystem::path> files);
[[nodiscard]] std::unique_ptr<Motion> open_sequence(NumberedFiles frames);

}  // namespace setka::io::detail
