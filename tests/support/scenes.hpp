// SPDX-License-Identifier: MIT
/// On which scenes is everything compared? Ordinary ones, degenerate ones made by hand, and files where they
/// are at hand.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "setka/scene.hpp"

namespace support {

using Corners = std::array<setka::Float3, 3>;

/// One mesh of separate triangles, one instance.
[[nodiscard]] setka::Scene from_triangles(const std::vector<Corners>& triangles);

/// A ball of about `triangles` triangles, independent of the library.
[[nodiscard]] setka::Scene ball(std::uint32_t triangles, setka::Float3 centre = {}, float radius = 1);

struct SceneCase {
    std::string name;
    std::function<setka::Scene()> make;
    /// Why many triangles lie in cell planes but for rounding; empty if few do. There, the exact test sees a
    /// triangle in one cell that has to be listed in both, so that surplus pairs are counted beyond cells
    /// widened by twice the tolerance instead.
    std::string edges_on_cell_planes;
};
inline void PrintTo(const SceneCase& c, std::ostream* out) { *out << c.name; }

[[nodiscard]] std::vector<SceneCase> procedural_scenes();
[[nodiscard]] std::vector<SceneCase> degenerate_scenes();
/// Both of the above.
[[nodiscard]] std::vector<SceneCase> all_scenes();
[[nodiscard]] const SceneCase& find_scene(const std::string& name);
[[nodiscard]] std::vector<std::string> names(const std::vector<SceneCase>& scenes);

/// Names a test by its scene.
template <typename Info>
std::string scene_name(const Info& test) {
    return test.param;
}

/// The folder of scene files: the environment's SETKA_SCENES, else ../shared/scenes beside the project, if it
/// is there.
[[nodiscard]] std::optional<std::filesystem::path> scene_folder();

}  // namespace support
