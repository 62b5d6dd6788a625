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

/// The ends of [low, high], in which coordinate q of a triangle lies where coordinate p is between start and end.
std::pair<double, double> interval_of(const float* triangle, std::size_t p, std::size_t q, double start, double end) {
    double low = 1e30, high = -1e30;
    for (std::size_t i = 0; i < 3; ++i) {
        const double pa = triangle[3 * i + p], qa = triangle[3 * i + q], pb = triangle[(3 * i + 3) % 9 + p], qb = triangle[(3 * i + 3) % 9 + q];
        for (const double t : {0.0, 1.0, (start - pa) / (pb - pa), (end - pa) / (pb - pa)}) {
            const double at = pa + (pb - pa) * t;
            if (!(t >= 0 && t <= 1) || at < start - 1e-9 || at > end + 1e-9) continue;
            low = std::min(low, qa + (qb - qa) * t);
            high = std::max(high, qa + (qb - qa) * t);
        }
    }
    return {low, high};
}

/// Flat triangles, in 2 x 2 x 1 cells, whose lists one interval decides, unless it ends where roundings of the rule's other intervals might.
TEST(ReachLanes, AreTheSameAsAloneWhereFlatOnesEndAtAPlane) {
    sk_u32 partial = 0, certain = 0, uncertain = 0;
    for (const auto& dims : {std::array{64u, 48u, 80u}, std::array{4096u, 4096u, 4096u}}) {
        const SetkaGridHeader grid = grid_of(dims[0], dims[1], dims[2]);
        const double tolerance = grid.tolerance;
        support::Random random(dims[0] + 1);
        std::vector<float> triangles;
        while (triangles.size() < 9 * 200000) {
            const std::size_t single = random.below(3), p = (single + 1 + random.below(2)) % 3, q = 3 - single - p;
            std::array<float, 9> t;
            std::array<double, 3> cell;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                cell[axis] = random.below(dims[axis] - 1);
                for (std::size_t v = 0; v < 3; ++v)
                    t[3 * v + axis] = static_cast<float>(cell[axis]) + (axis == single ? random.between(0.1f, 0.9f) : random.between(0.1f, 1.9f));
            }
            // An end of the interval of q comes to the plane between its cells, or to where shares of the tolerance are left.
            const bool second = random.below(2) != 0, at_low = random.below(2) != 0;
            const double start = cell[p] + (second ? 1 : 0);
            const auto [low, high] = interval_of(t.data(), p, q, start - tolerance, start + 1 + tolerance);
            if (low > high) continue;
            const double share = (static_cast<int>(random.below(13)) - 6) / 8.0 * tolerance;
            const double move = cell[q] + 1 + share + (at_low ? tolerance - low : -tolerance - high);
            for (std::size_t v = 0; v < 3; ++v) {
                t[3 * v + q] = static_cast<float>(t[3 * v + q] + move);
                for (std::uint32_t steps = random.below(3); steps > 0; --steps) t[3 * v + q] = std::nextafter(t[3 * v + q], random.below(2) ? 1e9f : -1e9f);
            }
            triangles.insert(triangles.end(), t.begin(), t.end());
        }
        const auto count = static_cast<sk_u32>(triangles.size() / 9);
        std::vector<sk_reach> reaches(count);
        (void)sk_find_reaches(0, count, grid, triangles.data(), reaches.data());
        for (sk_u32 i = 0; i < count; ++i) {
            const float* triangle = &triangles[9 * std::size_t{i}];
            const sk_reach expected = alone(grid, triangle);
            ASSERT_EQ(sk_reach_mask(reaches[i]), sk_reach_mask(expected)) << "triangle " << i << " of " << dims[0];
            partial += sk_bit_count(sk_reach_mask(expected)) == 2 || sk_bit_count(sk_reach_mask(expected)) == 3;
        }
        for (sk_u32 i = 0; i + SK_WIDTH <= count; i += SK_WIDTH) {
            const sk_points_lanes points = sk_load_cell_points_lanes(grid, &triangles[9 * std::size_t{i}]);
            const sk_boxes_lanes boxes = sk_boxes_of(grid, points);
            const sk_flat_lanes flat =
                sk_flat_rule_of(grid, points, boxes.xy & 0xffff, boxes.xy >> 16 & 0xffff, boxes.z & 0xffff, boxes.z >> 16);
            certain += sk_popcount(boxes.flats & sk_lane_bits(flat.is_certain));
            uncertain += sk_popcount(boxes.flats & sk_lane_bits(~flat.is_certain));
        }
    }
    EXPECT_GT(partial, 100000u);
    EXPECT_GT(certain, 50000u);
    EXPECT_GT(uncertain, 50000u);
}

}  // namespace
