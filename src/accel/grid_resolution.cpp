// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/exact_math.hpp"
#include "setka/grid.hpp"

namespace setka {

GridResolution grid_resolution(const Bounds& bounds, std::uint32_t triangle_count, const GridOptions& options) {
    double extents[3];
    bool active[3] = {true, true, true};
    for (int axis = 0; axis < 3; ++axis) extents[axis] = double(bounds.upper[axis]) - double(bounds.lower[axis]);
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
            resolution.dims[axis] = static_cast<std::uint32_t>(
                std::clamp(std::ceil(extents[axis] / double(resolution.cell_size)), 1.0, double(options.max_cells_per_axis)));
    return resolution;
}

}  // namespace setka
