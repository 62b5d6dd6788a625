// SPDX-License-Identifier: MIT
/// Do the tables of real meshes equal the oracle's and hold every overlap with at most 5 % more? Needs the
/// folder of scene files: the environment's SETKA_SCENES, or ../shared/scenes beside the project.
#include <gtest/gtest.h>

#include "setka/io.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

namespace {

const std::vector<std::string> files{"scan/stanford-bunny.obj", "scan/dragon.obj", "arch/sponza_dabrovic.obj",
                                     "cad/cycloidal.ply", "gltf/2CylinderEngine.glb"};

class FileTables : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(FileTables, files);

TEST_P(FileTables, EqualTheOraclesAndHoldEveryOverlapAndLittleElse) {
    const auto folder = support::scene_folder();
    if (!folder) GTEST_SKIP() << "no folder of scene files: set SETKA_SCENES";
    const auto file = *folder / other();
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
    const setka::Scene scene = setka::io::load_scene(file);
    const oracle::World world = oracle::make_world(scene);
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, scene);
    for (const float density : {0.5f, 4.0f, 16.0f}) {
        SCOPED_TRACE("density " + std::to_string(density));
        setka::GridOptions options{.density = density};
        const oracle::Tables expected = oracle::make_tables(world, options);
        for (const setka::CellTables tables : support::all_cell_tables) {
            options.cell_tables = tables;
            const setka::Grid grid = setka::make_grid_builder(options)->build(queue, device_scene);
            ASSERT_TRUE(support::same_tables(expected, support::download(queue, grid)));
        }
        const auto listed = oracle::listed_pairs(expected);
        const auto exact = oracle::overlapping_pairs(world, expected.header);
        EXPECT_TRUE(support::contains_all(listed, exact, world, expected.header));
        const double ratio = static_cast<double>(listed.size()) / static_cast<double>(exact.size());
        EXPECT_LE(ratio, 1.05);
        std::cout << other() << ", density " << density << ": " << listed.size() << " pairs, "
                  << 100 * (ratio - 1) << " % more than overlap\n";
    }
}

}  // namespace
