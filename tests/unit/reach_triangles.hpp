// SPDX-License-Identifier: MIT
/// Triangles that like to be on, beside and within the tolerance of cell planes. Include the dialect's translation for the host before.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "setka/layout.h"
#include "support/random.hpp"

namespace reach_support {

using support::Random;
using Triangle = std::array<float, 9>;

/// Cells of size 1 from 0 on, so that a coordinate is its own in cells.
inline SetkaGridHeader grid_of(sk_u32 x, sk_u32 y, sk_u32 z) {
    SetkaGridHeader grid{};
    grid.cell_size = grid.inverse_cell_size = 1;
    grid.dims[0] = x;
    grid.dims[1] = y;
    grid.dims[2] = z;
    grid.cell_count = x * y * z;
    grid.tolerance = static_cast<float>(std::max({x, y, z})) * 0x1p-17f;
    return grid;
}

/// A coordinate within [0, dim] that likes cell planes: on one, beside it by roundings, or by shares of the tolerance.
inline float coordinate(Random& random, const SetkaGridHeader& grid, float near, float spread, float dim) {
    float c = near + random.between(-spread, spread);
    switch (random.below(6)) {
        case 0:
            c = std::round(c);
            break;
        case 1:
            c = std::round(c) + static_cast<float>(static_cast<int>(random.below(17)) - 8) * 0.25f * grid.tolerance;
            break;
        case 2: {
            c = std::round(c) + (random.below(2) ? 1.0f : -1.0f) * grid.tolerance * static_cast<float>(random.below(3));
            for (std::uint32_t steps = random.below(4); steps > 0; --steps)
                c = std::nextafter(c, random.below(2) ? 1e9f : -1e9f);
            break;
        }
        default:
            break;
    }
    return std::clamp(c, 0.0f, dim);
}

/// Some are points, segments, needles and lie in planes of cells.
inline Triangle triangle_in(Random& random, const SetkaGridHeader& grid) {
    static constexpr float spreads[] = {1e-6f, 1e-3f, 0.1f, 0.6f, 1.2f, 2.5f, 12.0f};
    Triangle t;
    const float spread = spreads[random.below(std::size(spreads))];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto dim = static_cast<float>(grid.dims[axis]);
        const float near = random.between(0, dim), own = random.below(3) == 0 ? spread * 1e-2f : spread;
        for (std::size_t v = 0; v < 3; ++v) t[3 * v + axis] = coordinate(random, grid, near, own, dim);
        if (random.below(8) == 0) t[3 + axis] = t[6 + axis] = t[axis];
        if (random.below(8) == 0) t[6 + axis] = t[3 + axis];
    }
    return t;
}

}  // namespace reach_support
