// SPDX-License-Identifier: MIT
/// Which scene, which options and which rays does an input describe? Any: indices out of range, infinite
/// positions and density NaN among them.
#pragma once

#include <vector>

#include "fuzz/input.hpp"
#include "setka/grid.hpp"
#include "setka/scene.hpp"

namespace fuzz {

/// Up to three meshes of up to 24 triangles in up to four instances.
[[nodiscard]] setka::Scene read_scene(Input& input);

[[nodiscard]] setka::GridOptions read_grid_options(Input& input);

/// Up to `most` rays; some are aimed at corners and edges of these triangles (nine floats each).
[[nodiscard]] std::vector<setka::Ray> read_rays(Input& input, std::uint32_t most,
                                                std::span<const float> triangles);

/// None, or one for each of so many rays.
[[nodiscard]] std::vector<setka::Primitive> read_skip(Input& input, std::size_t rays);

[[nodiscard]] setka::Float3 read_vector(Input& input, const Floats& floats);

}  // namespace fuzz
