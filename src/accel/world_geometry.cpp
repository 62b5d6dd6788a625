// SPDX-License-Identifier: MIT
// The dialect's translation for the host comes before every file in it.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/resolution.h"

#include "accel/world_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/launch.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

/// How triangles are spread over work-items: one after the other for a lone one, few enough for drivers that end loops
/// early (algo/shape.hpp); side by side in a group.
struct TransformLayout {
    std::uint32_t groups, group_size, elements;
    TransformLayout(const Device& device, std::uint32_t triangles) {
        const bool is_serial = device.options().primitives == PrimitiveShape::Serial;
        group_size = is_serial ? 1 : device.options().work_group_size;
        elements = is_serial ? 2048 : 4;
        groups = static_cast<std::uint32_t>((triangles + std::uint64_t(group_size) * elements - 1) /
                                            (std::uint64_t(group_size) * elements));
    }
};

}  // namespace

StartedTransform start_transform(Queue& queue, const DeviceScene& scene, Buffer<std::uint32_t> report) {
    scene.check_committed();
    StartedTransform started;
    WorldGeometry& geometry = started.geometry;
    geometry.triangle_count = scene.triangle_count();
    geometry.instance_count = scene.instance_count();
    geometry.instances = scene.instances();
    geometry.instance_starts = scene.instance_starts();
    geometry.common_mask = scene.common_mask();
    queue.impl().begin_stage("transform");
    geometry.triangles = queue.make_buffer<float>(std::size_t(geometry.triangle_count) * 9, "world triangles");
    started.report = report.empty() ? make_report(queue) : std::move(report);
    const TransformLayout layout(queue.device(), geometry.triangle_count);
    launch_groups(queue, Kernel::grid_transform, layout.groups, layout.group_size, geometry.triangle_count,
                  layout.elements, geometry.instance_count, scene.positions(), scene.indices(), scene.instances(),
                  scene.instance_starts(), geometry.triangles, started.report);
    return started;
}

void take_bounds(const Report& report, WorldGeometry& geometry) {
    geometry.bounds = sk_reported_bounds(report.data());
    if (const std::uint32_t bad = report[SK_REPORT_BAD]; bad != 0)
        throw Error(ErrorCategory::InvalidData,
                    "scene triangle " + std::to_string(~bad) +
                        " has a vertex that is not finite after its instance's transform; finite vertices are needed");
    constexpr float largest = 1e20f;
    if (!(extent_of(geometry.bounds) <= largest))
        throw Error(ErrorCategory::InvalidData, "the scene's extent is " + std::to_string(extent_of(geometry.bounds)) +
                                                    "; up to 1e20 can be calculated with in float");
}

WorldGeometry transform_scene(Queue& queue, const DeviceScene& scene) {
    StartedTransform started = start_transform(queue, scene);
    take_bounds(read_report(queue, started.report), started.geometry);
    return std::move(started.geometry);
}

namespace {

/// The power of two that brings the extent to [2^20, 2^21); for extents outside [2^-100, 2^100] that of the nearest bound.
float unit_of(float extent) noexcept {
    if (extent == 0) return 1;
    return std::ldexp(1.0f, 20 - std::clamp(std::ilogb(extent), -100, 100));
}

}  // namespace

float extent_of(const Bounds& bounds) noexcept { return sk_extent_of(bounds); }

sk_trace_params trace_params(const WorldGeometry& geometry, std::uint32_t mask) noexcept {
    sk_trace_params params{};
    for (int axis = 0; axis < 3; ++axis) {
        params.lower[axis] = geometry.bounds.lower[axis];
        params.size[axis] = geometry.bounds.upper[axis] - geometry.bounds.lower[axis];
    }
    params.extent = extent_of(geometry.bounds);
    params.pad = params.extent * 0x1p-16f;
    params.unit = unit_of(params.extent);
    params.mask = mask;
    params.filters = (geometry.common_mask & mask) == 0;
    params.instance_count = geometry.instance_count;
    params.triangle_count = geometry.triangle_count;
    return params;
}

std::vector<Section> geometry_sections(const WorldGeometry& geometry) {
    return {{"triangles", geometry.triangles.size_bytes()},
            {"instance starts", geometry.instance_starts.size_bytes()},
            {"instances", geometry.instances.size_bytes()}};
}

}  // namespace setka
