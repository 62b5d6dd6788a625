// SPDX-License-Identifier: MIT
/// Where are the scene's triangles in the world? The first stages of every build: transform and bounds.
#pragma once

#include "accel/compact_tables.hpp"
#include "device/trace/params.h"
#include "setka/structure.hpp"

namespace setka {

/// Triangles on their way into the world. Their bounds will be in the report, the geometry does not have them yet.
struct StartedTransform {
    WorldGeometry geometry;
    Buffer<std::uint32_t> report;
};
/// Enqueues the transform of every triangle. `report` is words that are 0; one is made if it is empty.
[[nodiscard]] StartedTransform start_transform(Queue& queue, const DeviceScene& scene, Buffer<std::uint32_t> report = {});
/// Takes the bounds from what was reported. Throws InvalidData that names the first triangle that is not finite in world space, or
/// a scene too large to calculate with (an extent above 1e20).
void take_bounds(const Report& report, WorldGeometry& geometry);
/// Both; waits.
[[nodiscard]] WorldGeometry transform_scene(Queue& queue, const DeviceScene& scene);

/// The longest side of the bounds, in float.
[[nodiscard]] float extent_of(const Bounds& bounds) noexcept;

/// What trace kernels need of the geometry.
[[nodiscard]] sk_trace_params trace_params(const WorldGeometry& geometry, std::uint32_t mask) noexcept;

/// The tables that every structure has.
[[nodiscard]] std::vector<Section> geometry_sections(const WorldGeometry& geometry);

}  // namespace setka
