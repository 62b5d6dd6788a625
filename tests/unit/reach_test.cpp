// SPDX-License-Identifier: MIT
/// Is what a triangle reaches into the same by its box alone, as a mask, and row by row? The kernels' bodies on the host, with
/// vertices on, beside and within the tolerance of cell planes.
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/reach.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <set>
#include <vector>

#include "unit/reach_triangles.hpp"

namespace {

using reach_support::grid_of;
using reach_support::Triangle;
using reach_support::triangle_in;
using support::Random;

/// The cells by the rule, row by row, as the sorted build writes them.
std::set<sk_u32> listed_by_rows(const SetkaGridHeader& grid, const Triangle& triangle) {
    const sk_cell_triangle t = sk_load_cell_triangle(grid, triangle.data());
    std::set<sk_u32> cells;
    for (sk_u32 j = sk_first_row(grid, t); j <= sk_last_row(grid, t); ++j) {
        const sk_u32 count = sk_visit_row(grid, t, j, 0, 0, 0, nullptr, nullptr);
        std::vector<sk_u32> numbers(count), references(count);
        sk_visit_row(grid, t, j, 1, 0, 0, numbers.data(), references.data());
        cells.insert(numbers.begin(), numbers.end());
    }
    return cells;
}

std::set<sk_u32> cells_of(const SetkaGridHeader& grid, sk_reach reach) {
    std::set<sk_u32> cells;
    for (sk_u32 bit = 0; bit < 64; ++bit)
        if ((sk_reach_mask(reach) >> bit & 1u) != 0u) {
            const sk_u32 x = (reach.corner_xy & 0xffff) + bit % 4, y = (reach.corner_xy >> 16) + bit / 4 % 4,
                         z = (reach.corner_z & 0xffff) + bit / 16;
            cells.insert((z * grid.dims[1] + y) * grid.dims[0] + x);
        }
    return cells;
}

TEST(Reach, IsTheSameByBoxAndByRule) {
    std::uint32_t by_box = 0, by_mask = 0, others = 0, unclear = 0;
    for (const auto& dims : {std::array{64u, 48u, 80u}, std::array{4096u, 4096u, 4096u}, std::array{2048u, 3u, 1u},
                             std::array{1u, 1u, 1u}, std::array{5u, 4096u, 2u}}) {
        SetkaGridHeader grid = grid_of(dims[0], dims[1], dims[2]);
        Random random(dims[0] + 5);
        for (int i = 0; i < 300000; ++i) {
            const Triangle t = triangle_in(random, grid);
            const sk_cell_points points = sk_load_cell_points(grid, t.data());
            const sk_box box = sk_box_of(grid, points);
            const sk_reach reach = sk_reach_by_rule(grid, points, sk_reach_by_box(box));
            const bool is_run = (box.first.x == box.last.x) + (box.first.y == box.last.y) +
                                    (box.first.z == box.last.z) >= 2;
            by_box += is_run && box.has_clear_ends;
            unclear += is_run && !box.has_clear_ends;
            by_mask += !is_run && sk_reach_kind(reach) == SK_REACH_MASK;
            others += sk_reach_kind(reach) != SK_REACH_MASK;
            if (sk_reach_kind(reach) != SK_REACH_MASK) continue;
            const auto expected = listed_by_rows(grid, t), actual = cells_of(grid, reach);
            if (expected == actual && !actual.empty()) continue;
            std::string text;
            for (const float c : t) {
                char digits[32];
                std::snprintf(digits, sizeof digits, " %.9g", static_cast<double>(c));
                text += digits;
            }
            FAIL() << "dims " << dims[0] << " " << dims[1] << " " << dims[2] << ", triangle" << text << ": "
                   << actual.size() << " cells, " << expected.size() << " by the rule";
        }
    }
    std::printf("%u by their box, %u of such whose ends are unclear and %u others by the rule, %u larger\n",
                by_box, unclear, by_mask, others);
    for (const std::uint32_t kind : {by_box, by_mask, others, unclear}) EXPECT_GT(kind, 10000u);
}

}  // namespace
