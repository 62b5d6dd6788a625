// SPDX-License-Identifier: MIT
/// Does plan() know the exact bytes of a build, and is a build that would not fit refused before anything is
/// lost?
#include <gmock/gmock.h>

#include <cmath>
#include <optional>
#include <stop_token>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

namespace {

using setka::Device;
using setka::Error;
using setka::ErrorCategory;

const std::vector<std::string> scenes{"single_triangle", "single_point",   "slivers", "giant",
                                      "placed",          "built_in_torus", "ball"};

setka::Scene make(const std::string& name) {
    return name == "ball" ? support::ball(100000) : support::find_scene(name).make();
}

class Plan : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(Plan, scenes);

TEST_P(Plan, IsExact) {
    const setka::Scene scene = make(other());
    for (const support::LaunchShape& shape : support::launch_shapes_of(
             std::get<0>(GetParam()), {"defaults", "Serial_64", "Group_64", "Group_256", "Serial_1"})) {
        const Device opened = device(shape.options);
        setka::Queue queue = opened.make_queue();
        const setka::DeviceScene device_scene(queue, scene);
        for (const float density : {0.5f, 4.0f, 16.0f})
            for (const setka::CellTables tables : support::all_cell_tables) {
                SCOPED_TRACE(shape.name + ", density " + std::to_string(density) + ", " + to_string(tables));
                const std::uint64_t before = opened.memory_in_use_bytes();
                opened.reset_peak_memory();
                const auto builder = setka::make_grid_builder({.density = density, .cell_tables = tables});
                setka::GridPlan plan = builder->plan(queue, device_scene);
                const std::uint64_t peak_bytes = plan.peak_bytes(), table_bytes = plan.table_bytes();
                const std::uint64_t pairs = plan.pair_count();
                const setka::Grid grid = builder->build(queue, std::move(plan));
                EXPECT_EQ(opened.peak_memory_bytes() - before, peak_bytes);
                EXPECT_EQ(grid.size_bytes(), table_bytes);
                const setka::CompactTables& kept = grid.compact_tables();
                EXPECT_EQ(opened.memory_in_use_bytes() - before,
                          kept.blocks.size_bytes() + kept.cells.size_bytes() +
                              kept.references.size_bytes() + grid.geometry().triangles.size_bytes())
                    << "what is left beyond the scene is the grid alone";
                std::uint64_t sum = 0;
                for (const setka::Section& section : grid.sections()) sum += section.size_bytes;
                EXPECT_EQ(sum, table_bytes);
                EXPECT_EQ(kept.references.size(), pairs);
                EXPECT_EQ(grid.header().reference_count, pairs);
            }
        EXPECT_EQ(opened.memory_in_use_bytes(), device_scene.size_bytes()) << "all grids are gone";
    }
}

/// What a grid's own tables hold.
using Words = std::vector<std::uint32_t>;

Words words_of(setka::Queue& queue, const setka::CompactTables& tables) {
    Words words = queue.download(tables.blocks);
    for (const Words& more : {queue.download(tables.cells), queue.download(tables.references)}) words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The peak of the plan that is made within a budget beside the scene; 0 if there is none, which plan() says. Where a stop can
/// be requested, nothing is allocated before its size is known. `tables` are those of the grid that is built, or become them where there are none.
std::uint64_t peak_within(const std::string& device, const setka::Scene& scene, std::uint64_t bytes, Words& tables,
                          const std::stop_token& token = {}) {
    const setka::GridOptions options{.density = 64};
    std::uint64_t scene_bytes = 0;
    {
        setka::Queue queue = support::open_once(device).make_queue();
        const std::uint64_t before = queue.device().memory_in_use_bytes();
        const setka::DeviceScene device_scene(queue, scene);
        scene_bytes = queue.device().memory_in_use_bytes() - before;
    }
    const Device limited = Device::open(device, {.memory_budget_bytes = scene_bytes + bytes});
    setka::Queue queue = limited.make_queue();
    const setka::DeviceScene device_scene(queue, scene);
    queue.set_stop_token(token);
    const auto builder = setka::make_grid_builder(options);
    std::optional<setka::GridPlan> plan;
    try {
        plan = builder->plan(queue, device_scene);
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::OutOfMemory) << error.what();
        return 0;
    }
    const std::uint64_t peak_bytes = plan->peak_bytes();
    const setka::Grid grid = builder->build(queue, std::move(*plan));
    EXPECT_GT(grid.header().reference_count, 0u);
    const Words own = words_of(queue, grid.compact_tables());
    if (tables.empty()) tables = own;
    EXPECT_TRUE(own == tables) << "other tables within " << bytes << " bytes";
    return peak_bytes;
}

/// A budget of exactly the peak suffices, and the tables are the same within each. With one byte less there is no room for counts that are kept, for
/// blocks that there might be, or for bins; the smallest way of all with one byte less is refused by plan() already, whether each launch is waited for or none.
TEST_P(Plan, IsEnoughAndNotTooMuch) {
    const setka::Scene scene = make(other());
    const std::string& device = std::get<0>(GetParam());
    constexpr std::uint64_t plenty = std::uint64_t{1} << 30;
    const std::stop_source stop;
    Words tables;
    std::uint64_t peak_bytes = peak_within(device, scene, plenty, tables), least_bytes = 0;
    EXPECT_GE(peak_bytes, peak_within(device, scene, plenty, tables, stop.get_token()));
    for (std::uint32_t smaller = 0; peak_bytes != 0; ++smaller) {
        ASSERT_LT(smaller, 8u) << "each with another peak";
        EXPECT_EQ(peak_within(device, scene, peak_bytes, tables), peak_bytes);
        least_bytes = peak_bytes;
        peak_bytes = peak_within(device, scene, least_bytes - 1, tables);
        ASSERT_LT(peak_bytes, least_bytes);
    }
    EXPECT_EQ(peak_within(device, scene, least_bytes, tables, stop.get_token()), least_bytes);
    EXPECT_EQ(peak_within(device, scene, least_bytes - 1, tables, stop.get_token()), 0u);
}

class GridErrors : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(GridErrors);

TEST_P(GridErrors, APlanMakesOneGrid) {
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, setka::make_scene("cube"));
    for (const auto tables : {setka::CellTables::Bins, setka::CellTables::Scatter, setka::CellTables::RunBoundaries}) {
        const auto builder = setka::make_grid_builder({.cell_tables = tables});
        setka::GridPlan plan = builder->plan(queue, device_scene);
        EXPECT_GT(builder->build(queue, std::move(plan)).header().reference_count, 0u);
        try {
            (void)builder->build(queue, std::move(plan));  // NOLINT(bugprone-use-after-move): what is asked
            ADD_FAILURE() << "nothing was thrown";
        } catch (const Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument) << error.what();
        }
    }
}

TEST_P(GridErrors, OptionsOutOfRange) {
    const auto refused = [](const setka::GridOptions& options) {
        try {
            (void)setka::make_grid_builder(options);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument) << error.what();
        }
    };
    for (const float density : {0.0f, -1.0f, 1e-7f, 1.1e6f, NAN, INFINITY, -INFINITY})
        refused({.density = density});
    for (const std::uint32_t cap : {0u, 4097u, ~0u}) refused({.max_cells_per_axis = cap});
    (void)setka::make_grid_builder({.density = 1e-6f});
    (void)setka::make_grid_builder({.density = 1e6f, .max_cells_per_axis = 4096});
    (void)setka::make_grid_builder({.density = 1e6f, .max_cells_per_axis = 1});
}

TEST_P(GridErrors, TrianglesThatAreNotFiniteInTheWorld) {
    setka::Queue queue = device().make_queue();
    setka::Scene scene = support::ball(100, {}, 1e30f);
    scene.instances[0].transform.rows[0] = 1e20f;  // finite here, infinite there
    const auto refused = [&](auto&& build) {
        try {
            build();
            ADD_FAILURE() << "nothing was thrown";
        } catch (const Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidData) << error.what();
        }
    };
    const std::uint64_t before = device().memory_in_use_bytes();
    refused([&] { (void)setka::make_grid_builder()->build(queue, setka::DeviceScene(queue, scene)); });
    refused([&] { (void)setka::BruteForce::build(queue, setka::DeviceScene(queue, scene)); });
    EXPECT_EQ(device().memory_in_use_bytes(), before);
}

TEST_P(GridErrors, AbsurdDensityIsRefusedCleanly) {
    const Device limited = Device::open(GetParam(), {.memory_budget_bytes = 64 << 20});
    setka::Queue queue = limited.make_queue();
    const setka::DeviceScene device_scene(queue, support::ball(20000));
    try {
        (void)setka::make_grid_builder({.density = 1e6f})->plan(queue, device_scene);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::OutOfMemory) << error.what();
    }
    EXPECT_EQ(limited.memory_in_use_bytes(), device_scene.size_bytes());
    EXPECT_GT(setka::make_grid_builder()->build(queue, device_scene).header().reference_count, 0u)
        << "usable after it";
}

}  // namespace
