// SPDX-License-Identifier: MIT
/// Do SK_WIDTH triangles side by side reach into the cells that each reaches into alone? In runs of any length, with vertices on, beside and
/// within the tolerance of cell planes, and some that are no numbers.
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/reach_lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <map>
#include <vector>

#include "unit/reach_triangles.hpp"

namespace {

using reach_support::grid_of;
using reach_support::triangle_in;

sk_reach alone(const SetkaGridHeader& grid, const float* triangle) {
    const sk_cell_points points = sk_load_cell_points(grid, triangle);
    const sk_box box = sk_box_of(grid, points);
    return sk_reach_in_bin(sk_reach_by_rule(grid, points, sk_reach_by_box(box)), box, sk_bin_dims(sk_cell_dims(grid)));
}

bool is_finite(const float* triangle) {
    return std::all_of(triangle, triangle + 9, [](float c) { return std::isfinite(c); });
}

bool is_inside(const SetkaGridHeader& grid, sk_reach reach) {
    sk_dims corner = sk_reach_corner(reach);
    if (sk_reach_kind(reach) == SK_REACH_IN_BIN) {
        const sk_dims bins = sk_bin_dims(sk_cell_dims(grid));
        corner.x = reach.corner_xy % bins.x * SK_BIN_SIDE + (reach.corner_z & 15u);
        corner.y = reach.corner_xy / bins.x % bins.y * SK_BIN_SIDE + (reach.corner_z >> 4 & 15u);
        corner.z = reach.corner_xy / bins.x / bins.y * SK_BIN_SIDE + (reach.corner_z >> 8 & 15u);
    }
    for (sk_u32 bit = 0; bit < 64; ++bit)
        if ((sk_reach_mask(reach) >> bit & 1u) != 0u &&
            !(corner.x + bit % 4 < grid.dims[0] && corner.y + bit / 4 % 4 < grid.dims[1] && corner.z + bit / 16 < grid.dims[2]))
            return false;
    return true;
}

TEST(ReachLanes, AreTheSameAsAlone) {
    constexpr sk_u32 guard = 0xdeadbeefu;
    std::map<sk_u32, sk_u32> kinds;
    sk_u32 not_numbers = 0;
    for (const auto& dims : {std::array{64u, 48u, 80u}, std::array{4096u, 4096u, 4096u}, std::array{2048u, 3u, 1u},
                             std::array{1u, 1u, 1u}, std::array{5u, 4096u, 2u}}) {
        const SetkaGridHeader grid = grid_of(dims[0], dims[1], dims[2]);
        support::Random random(dims[0] + 7);
        for (int batch = 0; batch < 600; ++batch) {
            const sk_u32 first = random.below(40), count = random.below(500);
            std::vector<float> triangles;
            for (sk_u32 i = 0; i < first + count; ++i) {
                auto triangle = triangle_in(random, grid);
                if (random.below(50) == 0) {
                    triangle[random.below(9)] = random.below(2) ? std::numeric_limits<float>::quiet_NaN()
                                                                : -std::numeric_limits<float>::infinity();
                    ++not_numbers;
                }
                triangles.insert(triangles.end(), triangle.begin(), triangle.end());
            }
            std::vector<sk_reach> reaches(first + count + 1, sk_reach{guard, guard, guard, guard});
            const sk_u64 units = sk_find_reaches(first, first + count, grid, triangles.data(), reaches.data());
            sk_u64 expected_units = 0;
            for (sk_u32 i = 0; i <= first + count; ++i) {
                const sk_reach actual = reaches[i];
                if (i < first || i == first + count) {
                    ASSERT_EQ(actual.corner_xy, guard) << "triangle " << i << " is none of the run's";
                    continue;
                }
                const sk_reach expected = alone(grid, &triangles[9 * std::size_t(i)]);
                ASSERT_EQ(sk_reach_kind(actual), sk_reach_kind(expected));
                ++kinds[sk_reach_kind(expected)];
                if (sk_reach_kind(expected) == SK_REACH_LARGE)
                    expected_units += sk_longest_side(sk_box_of(grid, sk_load_cell_points(grid, &triangles[9 * std::size_t(i)]))) / SK_LONG_ROW;
                ASSERT_EQ(actual.corner_xy, expected.corner_xy);
                ASSERT_EQ(actual.corner_z, expected.corner_z);
                // A scene with something that is no number is refused when it is counted; until then no kernel may leave the grid.
                if (is_finite(&triangles[9 * std::size_t(i)]))
                    ASSERT_EQ(sk_reach_mask(actual), sk_reach_mask(expected)) << "triangle " << i << " of run " << batch;
                else
                    ASSERT_TRUE(is_inside(grid, actual)) << "triangle " << i << " of run " << batch;
            }
            ASSERT_EQ(units, expected_units);
        }
    }
    for (const sk_u32 kind : {SK_REACH_MASK, SK_REACH_IN_BIN, SK_REACH_ROWS, SK_REACH_LARGE}) EXPECT_GT(kinds[kind], 10000u);
    EXPECT_GT(not_numbers, 1000u);
}

}  // namespace
