// SPDX-License-Identifier: MIT
/// Is the digest of a grid the same for every work-group size, primitive layout, cell-table method, queue and
/// run?
#include <gtest/gtest.h>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

namespace {

const std::vector<std::string> scenes{"single_triangle", "slivers",    "giant", "placed",
                                      "on_cell_planes",  "offset_1e6", "ball"};

setka::Scene make(const std::string& name) {
    return name == "ball" ? support::ball(100000) : support::find_scene(name).make();
}

class Digests : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(Digests, scenes);

TEST_P(Digests, DoNotDependOnTheLaunch) {
    const setka::Scene scene = make(other());
    const auto shapes = support::launch_shapes_of(std::get<0>(GetParam()));
    for (const float density : {0.5f, 4.0f, 16.0f}) {
        SCOPED_TRACE(density);
        std::string first;
        for (const support::LaunchShape& shape : shapes) {
            setka::Queue queue = device(shape.options).make_queue();
            const setka::DeviceScene device_scene(queue, scene);
            for (const setka::CellTables tables : support::all_cell_tables) {
                const auto builder = setka::make_grid_builder({.density = density, .cell_tables = tables});
                const std::string digest = builder->build(queue, device_scene).digest(queue).to_string();
                if (first.empty()) first = digest;
                ASSERT_EQ(digest, first)
                    << shape.name << ", " << to_string(tables);
            }
        }
        EXPECT_EQ(first.size(), 32u);
    }
}

TEST_P(Digests, DoNotDependOnTheRun) {
    const setka::Scene scene = make(other());
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, scene);
    const auto builder = setka::make_grid_builder();
    const auto first = builder->build(queue, device_scene).digest(queue);
    for (int run = 0; run < 5; ++run) EXPECT_EQ(builder->build(queue, device_scene).digest(queue), first);
}

TEST_P(Digests, TellGridsApart) {
    const setka::Scene scene = make(other());
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, scene);
    const auto coarse = setka::make_grid_builder({.density = 1})->build(queue, device_scene).digest(queue);
    const auto fine = setka::make_grid_builder({.density = 500})->build(queue, device_scene).digest(queue);
    EXPECT_NE(coarse, fine);
}

}  // namespace
