// SPDX-License-Identifier: MIT
/// Are lists the same whether triangles are scattered or pairs sorted, where lists are very long, triangles very large and grids
/// very thin? And do the paper's tables come back unchanged through the tables that are kept?
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

namespace {

using setka::Float3;
using support::Corners;

/// `counts[i]` tiny triangles around the i-th of points far from each other.
setka::Scene piles(const std::vector<std::uint32_t>& counts) {
    support::Random random(counts.size());
    std::vector<Corners> triangles;
    std::vector<std::uint32_t> left = counts;
    // Neighbours in a list are not neighbours in the scene.
    for (std::size_t pile = 0; std::ranges::any_of(left, [](std::uint32_t n) { return n > 0; });
         pile = random.below(counts.size())) {
        if (left[pile] == 0) continue;
        --left[pile];
        const float x = static_cast<float>(pile * 10) + random.between(0.01f, 0.02f);
        const float y = static_cast<float>(pile % 3) + random.between(0.01f, 0.02f);
        triangles.push_back({Float3{x, y, 0}, Float3{x + 0.01f, y, 0}, Float3{x, y + 0.01f, 0.01f}});
    }
    return support::from_triangles(triangles);
}

/// Triangles across the whole box, and small ones.
setka::Scene giants(int count, std::uint32_t small) {
    support::Random random(11);
    setka::Scene scene = support::ball(small);
    std::vector<Corners> triangles;
    for (int k = 0; k < count; ++k) {
        Corners corners;
        for (Float3& c : corners) c = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        corners[0] = {-1, -1, k % 2 == 0 ? -1.0f : 1.0f};
        corners[1] = {1, 1, k % 3 == 0 ? -1.0f : 1.0f};
        triangles.push_back(corners);
    }
    setka::append(scene, support::from_triangles(triangles));
    return scene;
}

/// Small triangles in a plane, or along a line.
setka::Scene flat(bool is_line) {
    support::Random random(3);
    std::vector<Corners> triangles;
    for (int k = 0; k < 3000; ++k) {
        const float x = random.between(0, 100), y = is_line ? 0 : random.between(0, 100);
        const float up = is_line ? 0 : 0.7f;
        triangles.push_back({Float3{x, y, 1}, Float3{x + 0.5f, y, 1}, Float3{x, y + up, 1}});
    }
    return support::from_triangles(triangles);
}

struct Case {
    std::function<setka::Scene()> make;
    setka::GridOptions options;
};

const std::map<std::string, Case>& cases() {
    static const std::map<std::string, Case> all{
        // Around the sizes at which a list is done otherwise, for one work-item and for groups.
        {"piles", {[] { return piles({1, 2, 24, 63, 64, 65, 127, 128, 129, 640, 1023, 1025, 4095, 4096, 4097}); }, {.density = 4}}},
        {"one_pile", {[] { return piles({30000}); }, {.density = 1e-6f}}},
        {"one_cell", {[] { return support::ball(9000); }, {.max_cells_per_axis = 1}}},
        {"giants", {[] { return giants(7, 3000); }, {.density = 8}}},
        // More rows than are provided for.
        {"many_giants", {[] { return giants(100, 1000); }, {.density = 3000}}},
        {"plane", {[] { return flat(false); }, {.density = 8}}},
        {"line", {[] { return flat(true); }, {.density = 8}}},
        {"dense", {[] { return support::ball(2000); }, {.density = 500}}}};
    return all;
}

std::vector<std::string> case_names() {
    std::vector<std::string> names;
    for (const auto& [name, one] : cases()) names.push_back(name);
    return names;
}

class Lists : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(Lists, case_names());

TEST_P(Lists, AreTheSameScatteredAndSorted) {
    const Case& one = cases().at(other());
    const setka::Scene scene = one.make();
    std::string first;
    for (const support::LaunchShape& shape : support::launch_shapes_of(
             std::get<0>(GetParam()), {"defaults", "Serial_64", "Group_64", "Group_256", "Serial_1"})) {
        setka::Queue queue = device(shape.options).make_queue();
        const setka::DeviceScene device_scene(queue, scene);
        for (const setka::CellTables tables : support::all_cell_tables) {
            SCOPED_TRACE(shape.name + ", " + to_string(tables));
            setka::GridOptions options = one.options;
            options.cell_tables = tables;
            const auto builder = setka::make_grid_builder(options);
            const std::uint64_t before = queue.device().memory_in_use_bytes();
            queue.device().reset_peak_memory();
            setka::GridPlan plan = builder->plan(queue, device_scene);
            const std::uint64_t peak_bytes = plan.peak_bytes(), table_bytes = plan.table_bytes();
            if (tables == setka::CellTables::Bins) {
                EXPECT_EQ(plan.row_count(), 0u) << "there were no bins";
            }
            if (tables == setka::CellTables::Scatter) {
                EXPECT_LT(plan.row_count(), std::max<std::uint64_t>(plan.pair_count() / 2, 1)) << "it was sorted";
            }
            const setka::Grid grid = builder->build(queue, std::move(plan));
            EXPECT_EQ(queue.device().peak_memory_bytes() - before, peak_bytes);
            EXPECT_EQ(grid.size_bytes(), table_bytes);
            const std::string digest = grid.digest(queue).to_string();
            if (first.empty()) first = digest;
            EXPECT_EQ(digest, first);
        }
    }
}

TEST_P(Lists, ComeBackThroughFlatTables) {
    const Case& one = cases().at(other());
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, one.make());
    const setka::Grid grid = setka::make_grid_builder(one.options)->build(queue, device_scene);
    const setka::Grid again(queue, grid.geometry(), grid.header(), grid.tables(queue));
    const setka::CompactTables &a = grid.compact_tables(), &b = again.compact_tables();
    EXPECT_EQ(queue.download(a.blocks), queue.download(b.blocks));
    EXPECT_EQ(queue.download(a.cells), queue.download(b.cells));
    EXPECT_EQ(queue.download(a.references), queue.download(b.references));
    EXPECT_EQ(again.digest(queue), grid.digest(queue));
}

class FlatTables : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(FlatTables);

TEST_P(FlatTables, OfOtherSizesAreRefused) {
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, support::ball(500));
    const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
    const auto refusal = [&](const setka::GridTables& tables) -> std::string {
        try {
            (void)setka::Grid(queue, grid.geometry(), grid.header(), tables);
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), setka::ErrorCategory::InvalidArgument);
            return error.what();
        }
        return "accepted";
    };
    const setka::GridTables sound = grid.tables(queue);
    EXPECT_EQ(refusal(sound), "accepted");
    setka::GridTables tables = sound;
    tables.offsets = queue.make_buffer<std::int32_t>(3, "offsets");
    EXPECT_EQ(refusal(tables), "offsets has 3 elements; the header's dims ask for " +
                                   std::to_string(grid.header().cell_count));
    tables = sound;
    tables.references = queue.make_buffer<std::uint32_t>(3, "references");
    EXPECT_EQ(refusal(tables), "counts add up to " + std::to_string(grid.header().reference_count) +
                                   "; references has 3 elements");
}

}  // namespace
