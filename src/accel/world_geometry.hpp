// SPDX-License-Identifier: MIT
/// Where are the scene's triangles in the world? The first stages of every build: transform and bounds.
#pragma once

#include "device/trace/params.h"
#include "setka/structure.hpp"

namespace setka {

/// Transforms every triangle and finds their bounds; waits. Throws InvalidData that names the first triangle that is not
/// finite in world space, or a scene too large to calculate with (an extent above 1e20).
[[nodiscard]] WorldGeometry transform_scene(Queue& queue, const DeviceScene& scene);

/// What transform_scene() holds besides meanwhile.
inline constexpr std::uint64_t transform_scratch_bytes = 7 * sizeof(std::uint32_t);

/// The longest side of the bounds, in float.
[[nodiscard]] float extent_of(const Bounds& bounds) noexcept;

/// What trace kernels need of the geometry.
[[nodiscard]] sk_trace_params trace_params(const WorldGeometry& geometry, std::uint32_t mask) noexcept;

/// The tables that every structure has.
[[nodiscard]] std::vector<Section> geometry_sections(const WorldGeometry& geometry);

}  // namespace setka
