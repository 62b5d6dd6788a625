// SPDX-License-Identifier: MIT
#include "accel/grid_resolution.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "accel/world_geometry.hpp"
#include "core/exact_math.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

void check_bounds(const Bounds& bounds, std::uint32_t triangle_count) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(bounds.lower[axis] <= bounds.upper[axis] &&
              std::isfinite(bounds.upper[axis] - bounds.lower[axis])))
            throw Error(ErrorCategory::InvalidArgument,
                        "bounds reach from " + std::to_string(bounds.lower[axis]) + " to " +
                            std::to_string(bounds.upper[axis]) + " along axis " + std::to_string(axis) +
                            "; finite numbers, the lower one first, are accepted");
    constexpr float largest = 1e20f;
    if (!(extent_of(bounds) <= largest))
        throw Error(
            ErrorCategory::InvalidArgument,
            "bounds have an extent of " + std::to_string(extent_of(bounds)) + "; up to 1e20 is accepted");
    if (triangle_count == 0)
        throw Error(ErrorCategory::InvalidArgument, "triangle_count is 0; at least one triangle is needed");
}

}  // namespace

void check_options(const GridOptions& options) {
    if (!(options.density >= 1e-6f && options.density <= 1e6f))
        throw Error(ErrorCategory::InvalidArgument, "density is " + std::to_string(options.density) +
                                                        "; 1e-6 to 1e6 cells a triangle are accepted");
    if (options.max_cells_per_axis < 1 || options.max_cells_per_axis > 4096)
        throw Error(ErrorCategory::InvalidArgument, "max_cells_per_axis is " +
                                                        std::to_string(options.max_cells_per_axis) +
                                                        "; 1 to 4096 are accepted");
}

GridResolution grid_resolution(const Bounds& bounds, std::uint32_t triangle_count,
                               const GridOptions& options) {
    check_options(options);
    check_bounds(bounds, triangle_count);
    double extents[3];
    bool active[3] = {true, true, true};
    for (int axis = 0; axis < 3; ++axis)
        extents[axis] = double(bounds.upper[axis]) - double(bounds.lower[axis]);
    const double cells = double(options.density) * triangle_count;

    const double longest = *std::ranges::max_element(extents);
    const double whole = longest > 0 ? longest : 1;  // one cell holds everything
    double size = whole;
    for (unsigned count = 3; count > 0; --count) {
        double volume = 1;
        int shortest = -1;
        for (int axis = 0; axis < 3; ++axis) {
            if (!active[axis]) continue;
            volume *= extents[axis];
            if (shortest < 0 || extents[axis] < extents[shortest]) shortest = axis;
        }
        size = exact::root(volume / cells, count);
        if (extents[shortest] > 0 && !(extents[shortest] < size)) break;
        active[shortest] = false;  // one cell thick: the others alone decide how long a cell is
        size = whole;
    }
    size = std::max({size, longest / options.max_cells_per_axis, 0x1p-80});

    GridResolution resolution;
    resolution.cell_size = static_cast<float>(size);
    for (int axis = 0; axis < 3; ++axis)
        if (active[axis])
            resolution.dims[axis] =
                static_cast<std::uint32_t>(std::clamp(std::ceil(extents[axis] / double(resolution.cell_size)),
                                                      1.0, double(options.max_cells_per_axis)));
    return resolution;
}

}  // namespace setka
