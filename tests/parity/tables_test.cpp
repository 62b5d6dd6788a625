// SPDX-License-Identifier: MIT
/// Are a device's tables the oracle's, byte for byte, and does every list hold what truly overlaps and little
/// else?
#include <gtest/gtest.h>

#include <algorithm>

#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

namespace {

constexpr float densities[] = {0.5f, 4.0f, 16.0f};

/// Which launch shapes there are is the matter of digest_test.cpp.
class Tables : public support::DeviceAndTest<std::string> {
  protected:
    [[nodiscard]] setka::Scene scene() const { return support::find_scene(other()).make(); }
};
SETKA_ON_EVERY_DEVICE_AND(Tables, support::names(support::all_scenes()));

TEST_P(Tables, EqualTheOracles) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = scene();
    const oracle::World world = oracle::make_world(host_scene);
    const setka::DeviceScene device_scene(queue, host_scene);
    for (const float density : {0.05f, 0.5f, 4.0f, 16.0f}) {
        setka::GridOptions options{.density = density};
        const oracle::Tables expected = oracle::make_tables(world, options);
        for (const setka::CellTables tables : support::all_cell_tables) {
            SCOPED_TRACE(
                "density " + std::to_string(density) + ", " + to_string(tables));
            options.cell_tables = tables;
            const setka::Grid grid = setka::make_grid_builder(options)->build(queue, device_scene);
            ASSERT_TRUE(support::same_tables(expected, support::download(queue, grid)));
        }
    }
}

TEST_P(Tables, EqualTheOraclesWhereAxesAreShort) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = scene();
    const oracle::World world = oracle::make_world(host_scene);
    const setka::DeviceScene device_scene(queue, host_scene);
    for (const std::uint32_t cap : {1u, 2u, 7u}) {
        SCOPED_TRACE("at most " + std::to_string(cap) + " cells an axis");
        const setka::GridOptions options{.density = 16, .max_cells_per_axis = cap};
        const setka::Grid grid = setka::make_grid_builder(options)->build(queue, device_scene);
        ASSERT_TRUE(
            support::same_tables(oracle::make_tables(world, options), support::download(queue, grid)));
    }
}

TEST_P(Tables, HoldEveryOverlapAndLittleElse) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = scene();
    const oracle::World world = oracle::make_world(host_scene);
    const setka::DeviceScene device_scene(queue, host_scene);
    const std::string& edges = support::find_scene(other()).edges_on_cell_planes;
    if (!edges.empty())
        std::cout << "surplus is counted beyond cells widened by the tolerance: " << edges << "\n";
    for (const float density : densities) {
        SCOPED_TRACE("density " + std::to_string(density));
        const setka::Grid grid = setka::make_grid_builder({.density = density})->build(queue, device_scene);
        const oracle::Tables tables = support::download(queue, grid);
        const auto listed = oracle::listed_pairs(tables);
        const auto exact = oracle::overlapping_pairs(world, tables.header);
        EXPECT_TRUE(support::contains_all(listed, exact, world, tables.header));
        const auto allowed =
            edges.empty() ? exact
                          : oracle::overlapping_pairs(world, tables.header, 2.0 * tables.header.tolerance);
        const double ratio = static_cast<double>(listed.size()) / static_cast<double>(allowed.size());
        std::cout << "density " << density << ": " << listed.size() << " pairs, " << exact.size()
                  << " exact, " << 100 * (ratio - 1) << " % more\n";
        EXPECT_LE(ratio, 1.05);
    }
}

}  // namespace
