// SPDX-License-Identifier: MIT
#include "algo/reduce.hpp"

#include <bit>
#include <limits>
#include <string>
#include <vector>

#include "algo/shape.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

constexpr std::uint32_t values = 6;

}  // namespace

float float_of_ordered(std::uint32_t ordered) noexcept {
    return std::bit_cast<float>((ordered & 0x80000000u) ? ordered & 0x7fffffffu : ~ordered);
}

std::uint64_t reduce_scratch_bytes(const Device& device, std::uint32_t n) {
    if (n == 0) return 0;
    const std::uint32_t groups = primitive_layout(device, n).groups;
    const std::uint64_t next = groups > 1 ? primitive_layout(device, groups).groups : 0;
    return (groups + next) * values * sizeof(std::uint32_t);
}

Bounds reduce_bounds(Queue& queue, const Buffer<float>& triangles, std::uint32_t n) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    if (n == 0) return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    if (triangles.size() < std::size_t(n) * 9)
        throw Error(ErrorCategory::InvalidArgument, "triangles has " + std::to_string(triangles.size()) +
                                                        " elements; 9 for each of " + std::to_string(n) +
                                                        " triangles are needed");
    PrimitiveLayout layout = primitive_layout(queue.device(), n);
    auto partials = queue.make_buffer<std::uint32_t>(std::size_t(layout.groups) * values, "partial bounds");
    launch_groups(queue, Kernel::reduce_bounds, layout.groups, layout.group_size, n, layout.elements, triangles,
                  partials);
    while (layout.groups > 1) {
        const std::uint32_t count = layout.groups;
        layout = primitive_layout(queue.device(), count);
        auto next = queue.make_buffer<std::uint32_t>(std::size_t(layout.groups) * values, "partial bounds");
        launch_groups(queue, Kernel::reduce_bounds_partial, layout.groups, layout.group_size, count, layout.elements,
                      partials, next);
        partials = std::move(next);
    }
    const std::vector<std::uint32_t> result = queue.download(partials);
    Bounds bounds{};
    for (int axis = 0; axis < 3; ++axis) {
        bounds.lower[axis] = float_of_ordered(result[axis]);
        bounds.upper[axis] = float_of_ordered(result[axis + 3]);
    }
    return bounds;
}

}  // namespace setka
