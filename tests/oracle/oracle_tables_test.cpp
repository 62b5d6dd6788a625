// SPDX-License-Identifier: MIT
/// Can the oracle's tables be trusted? They are held against geometry that is decided in double precision,
/// and the exact overlap test against points that are drawn from triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "oracle/oracle.hpp"
#include "support/compare.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace {

class OracleTables : public ::testing::TestWithParam<std::string> {};

TEST_P(OracleTables, ListEveryOverlappingPair) {
    const oracle::World world = oracle::make_world(support::find_scene(GetParam()).make());
    for (const float density : {0.05f, 0.5f, 4.0f, 16.0f, 64.0f}) {
        SCOPED_TRACE(density);
        const oracle::Tables tables = oracle::make_tables(world, {.density = density});
        const auto exact = oracle::overlapping_pairs(world, tables.header);
        EXPECT_TRUE(support::contains_all(oracle::listed_pairs(tables), exact, world, tables.header));
    }
}

TEST_P(OracleTables, OverlapHoldsForPointsOfTriangles) {
    const oracle::World world = oracle::make_world(support::find_scene(GetParam()).make());
    const SetkaGridHeader header = oracle::make_header(world, {});
    const auto pairs = oracle::overlapping_pairs(world, header);
    support::Random random(11);
    for (int k = 0; k < 3000; ++k) {
        const std::uint32_t t = random.below(world.triangles.size());
        double u = random.unit(), v = random.unit();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        std::uint64_t cell = 0;
        bool is_clear = true;  // not so close to a cell plane that rounding decides
        for (int axis = 2; axis >= 0; --axis) {
            const auto& p = world.triangles[t].vertex;
            const double at =
                p[0][axis] + u * (double(p[1][axis]) - p[0][axis]) + v * (double(p[2][axis]) - p[0][axis]);
            const double f = (at - header.origin[axis]) * header.inverse_cell_size;
            is_clear = is_clear && std::fabs(f - std::round(f)) > 1e-9;
            cell = cell * header.dims[axis] +
                   static_cast<std::uint64_t>(std::clamp(std::floor(f), 0.0, double(header.dims[axis] - 1)));
        }
        if (!is_clear) continue;
        EXPECT_TRUE(std::binary_search(pairs.begin(), pairs.end(), oracle::make_pair(cell, t)))
            << "triangle " << t << ", cell " << cell;
    }
}

INSTANTIATE_TEST_SUITE_P(Degenerate, OracleTables,
                         ::testing::ValuesIn(support::names(support::degenerate_scenes())),
                         support::scene_name<::testing::TestParamInfo<std::string>>);

TEST(OracleOverlap, UnitCellsOfOneTriangle) {
    // The plane x + y + z = 1.5 through a 2 x 2 x 2 grid of unit cells, from corner to corner of the box.
    const auto scene =
        support::from_triangles({{setka::Float3{0, 0, 2}, setka::Float3{2, 0, 0}, setka::Float3{0, 2, 0}}});
    const oracle::World world = oracle::make_world(scene);
    SetkaGridHeader header{};
    header.cell_size = header.inverse_cell_size = 1;
    for (auto& dim : header.dims) dim = 2;
    // x + y + z = 2: every cell but none of the open corner (1,1,1) beyond it; cells with two ones touch it
    // in a point.
    const auto pairs = oracle::overlapping_pairs(world, header);
    std::vector<oracle::Pair> expected;
    for (std::uint64_t cell = 0; cell < 7; ++cell) expected.push_back(oracle::make_pair(cell, 0));
    EXPECT_EQ(pairs, expected);
}

TEST(OracleResolution, FollowsThePaperWhereItsFormulaHolds) {
    const setka::Bounds bounds{{0, 0, 0}, {8, 4, 2}};
    const auto resolution = oracle::resolution(bounds, 16, {.density = 4});  // A = cbrt(64 / 64) = 1
    EXPECT_EQ(resolution.cell_size, 1.0f);
    EXPECT_EQ(resolution.dims[0], 8u);
    EXPECT_EQ(resolution.dims[1], 4u);
    EXPECT_EQ(resolution.dims[2], 2u);
}

}  // namespace
