// SPDX-License-Identifier: MIT
/// What can be rendered without a file? Procedural scenes of any size, the same triangles on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "setka/scene.hpp"

namespace setka {

/// A built-in scene: its name, one sentence, and how many triangles it has unless asked otherwise.
struct BuiltInScene {
    std::string name;
    std::string description;
    std::uint64_t default_triangles = 0;
    bool sizable = false;  ///< takes a triangle count
};

[[nodiscard]] const std::vector<BuiltInScene>& built_in_scenes();

/// Makes the built-in scene `name` with about `triangles` triangles; 0 means its default.
/// Throws InvalidArgument for an unknown name (naming those that exist), a count for a scene that takes none, or a count
/// above 2^28.
[[nodiscard]] Scene make_scene(std::string_view name, std::uint64_t triangles = 0);

}  // namespace setka
