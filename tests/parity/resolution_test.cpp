// SPDX-License-Identifier: MIT
/// Does the library choose the oracle's cells for any bounds, and do the cells always cover the bounds?
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oracle/oracle.hpp"
#include "setka/error.hpp"
#include "setka/grid.hpp"
#include "support/random.hpp"

namespace {

setka::Bounds random_bounds(support::Random& random) {
    setka::Bounds bounds{};
    const std::uint32_t shape = random.below(8);
    for (int axis = 0; axis < 3; ++axis) {
        const float size = random.unit() * std::ldexp(1.0f, static_cast<int>(random.below(60)) - 30);
        bounds.lower[axis] = random.below(3) ? random.between(-10, 10) : 0.0f;
        bounds.upper[axis] = bounds.lower[axis] + size;
        if (shape < 3) bounds.upper[axis] = bounds.lower[axis] + std::floor(random.between(0, 4));
        if (shape == 3) bounds.upper[axis] = bounds.lower[axis] + 1e-30f * size;
    }
    return bounds;
}

TEST(GridResolution, EqualsTheOraclesForAnyBounds) {
    support::Random random(31);
    for (int k = 0; k < 200000; ++k) {
        const setka::Bounds bounds = random_bounds(random);
        const std::uint32_t triangles = 1 + random.below(std::uint64_t{1} << random.below(28));
        const setka::GridOptions options{
            .density = std::ldexp(1.0f + random.unit(), static_cast<int>(random.below(38)) - 19),
            .max_cells_per_axis = 1 + random.below(4096)};
        const auto expected = oracle::resolution(bounds, triangles, options);
        const auto actual = setka::grid_resolution(bounds, triangles, options);
        ASSERT_EQ(actual.cell_size, expected.cell_size) << k;
        for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(actual.dims[axis], expected.dims[axis]) << k;
    }
}

TEST(GridResolution, CellsCoverTheBounds) {
    support::Random random(32);
    for (int k = 0; k < 200000; ++k) {
        const setka::Bounds bounds = random_bounds(random);
        const std::uint32_t triangles = 1 + random.below(1000);
        const setka::GridOptions options{
            .density = std::ldexp(1.0f + random.unit(), static_cast<int>(random.below(38)) - 19)};
        const auto cells = setka::grid_resolution(bounds, triangles, options);
        for (int axis = 0; axis < 3; ++axis) {
            const double side = double(bounds.upper[axis]) - bounds.lower[axis];
            ASSERT_GE(double(cells.cell_size) * cells.dims[axis] * (1 + 1e-6), side)
                << "axis " << axis << ", " << triangles << " triangles, density " << options.density
                << ", dims " << cells.dims[0] << " x " << cells.dims[1] << " x " << cells.dims[2]
                << ", sides " << bounds.upper[0] - bounds.lower[0] << " " << bounds.upper[1] - bounds.lower[1]
                << " " << bounds.upper[2] - bounds.lower[2];
        }
    }
}

// The root is the middle between two floats.
TEST(GridResolution, OfACubeBetweenTwoFloats) {
    const float lower = -0x1p-17f, upper = 0x1.fffffep-1f;
    const setka::Bounds bounds{{lower, lower, lower}, {upper, upper, upper}};
    EXPECT_EQ(setka::grid_resolution(bounds, 16, {.density = 4}).cell_size, 0x1.00008p-2f);
    EXPECT_EQ(oracle::resolution(bounds, 16, {.density = 4}).cell_size, 0x1.00008p-2f);
}

TEST(GridResolution, RefusesWhatIsNoBox) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const setka::Bounds unit{{0, 0, 0}, {1, 1, 1}};
    EXPECT_THROW((void)setka::grid_resolution(unit, 0, {}), setka::Error);
    EXPECT_THROW((void)setka::grid_resolution({{0, 0, 0}, {1, -1, 1}}, 1, {}), setka::Error);
    EXPECT_THROW((void)setka::grid_resolution({{0, 0, nan}, {1, 1, 1}}, 1, {}), setka::Error);
    EXPECT_THROW((void)setka::grid_resolution({{0, 0, 0}, {1, infinity, 1}}, 1, {}), setka::Error);
    EXPECT_THROW((void)setka::grid_resolution({{-3e38f, 0, 0}, {3e38f, 1, 1}}, 1, {}), setka::Error);
    EXPECT_THROW((void)setka::grid_resolution({{0, 0, 0}, {1.1e20f, 1, 1}}, 1, {}), setka::Error);
    EXPECT_THROW((void)setka::grid_resolution(unit, 1, {.density = nan}), setka::Error);
    EXPECT_THROW((void)setka::grid_resolution(unit, 1, {.max_cells_per_axis = 0}), setka::Error);
}

TEST(GridResolution, PaperFormula) {
    const setka::Bounds bounds{{0, 0, 0}, {8, 4, 2}};
    const auto cells = setka::grid_resolution(bounds, 16, {.density = 4});  // A = cbrt(64 / 64) = 1
    EXPECT_EQ(cells.cell_size, 1.0f);
    EXPECT_EQ(cells.dims[0], 8u);
    EXPECT_EQ(cells.dims[1], 4u);
    EXPECT_EQ(cells.dims[2], 2u);
}

}  // namespace
