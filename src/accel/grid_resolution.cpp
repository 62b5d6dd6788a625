// SPDX-License-Identifier: MIT
// The dialect's translation for the host comes before every file in it.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/resolution.h"

#include "accel/grid_resolution.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "accel/world_geometry.hpp"
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
    const sk_resolution found =
        sk_find_resolution(bounds, sk_make_cell_wish(options.density, options.max_cells_per_axis, triangle_count, 0));
    GridResolution resolution;
    resolution.cell_size = found.cell_size;
    std::ranges::copy(found.dims, resolution.dims);
    return resolution;
}

::SetkaGridHeader make_header(const WorldGeometry& geometry, const GridResolution& resolution) {
    sk_resolution cells{resolution.cell_size, {}};
    std::ranges::copy(resolution.dims, cells.dims);
    return sk_make_header(geometry.bounds, cells,
                          sk_make_cell_wish(0, 0, geometry.triangle_count, geometry.instance_count));
}

}  // namespace setka
