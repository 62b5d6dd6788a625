// SPDX-License-Identifier: MIT
/// How often does a build wait for the device? Once where the device lays out the cells itself, twice where
/// it cannot or does it otherwise than the host; and the tables are the same whatever it does.
#include <gmock/gmock.h>

#include <cstdio>
#include <optional>

#include "accel/binned_lists.hpp"
#include "accel/compact_tables.hpp"
#include "backend/device.hpp"
#include "faults/faulty_queue.hpp"
#include "setka/scenes.hpp"
#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/handmade.hpp"
#include "support/scenes.hpp"
#include "support/sizes.hpp"

namespace {

using setka::CellTables;
using setka::GridOptions;
using setka::Kernel;
using setka::Queue;

/// A build, and what was seen of it.
struct Seen {
    std::uint32_t waits_to_start = 0, waits = 0;
    std::uint64_t peak_bytes = 0;
    std::string digest;
};

class Waits : public support::DeviceTest {
  protected:
    void SetUp() override {
        support::DeviceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (!device().impl()->has_doubles())
            GTEST_SKIP() << "the device has no doubles: every build waits twice";
        pair_ = faults::make_faulty_queue(device());
    }

    [[nodiscard]] Queue& queue() { return pair_->queue; }
    [[nodiscard]] faults::FaultyQueue& steps() { return *pair_->faults; }

    Seen build(const setka::Scene& scene, const GridOptions& options = {}) {
        const setka::DeviceScene on_device(queue(), scene);
        const auto builder = setka::make_grid_builder(options);
        Seen seen;
        const std::uint32_t before = steps().waits();
        setka::StartedGrid started = builder->start(queue(), on_device);
        seen.waits_to_start = steps().waits() - before;
        setka::GridPlan plan = builder->plan(queue(), std::move(started));
        seen.peak_bytes = plan.peak_bytes();
        const setka::Grid grid = builder->build(queue(), std::move(plan));
        seen.waits = steps().waits() - before;
        seen.digest = grid.digest(queue()).to_string();
        return seen;
    }

    /// The digest of the tables that are made by sorting.
    std::string expected(const setka::Scene& scene, GridOptions options = {}) {
        options.cell_tables = CellTables::RunBoundaries;
        return build(scene, options).digest;
    }

    /// The kernel that makes the header: one that clears counters as well, where there are any and a work-item is not a core's.
    [[nodiscard]] Kernel resolve(CellTables tables) {
        const bool is_serial = queue().device().options().primitives == setka::PrimitiveShape::Serial;
        return tables == CellTables::Bins || is_serial ? Kernel::grid_resolve : Kernel::grid_resolve_clear;
    }

    std::optional<faults::FaultyPair> pair_;
};
SETKA_ON_EVERY_DEVICE(Waits);

TEST_P(Waits, OnceForOrdinaryScenes) {
    const std::uint32_t triangles = support::sized(50000u, 2000u);
    std::vector<std::pair<std::string, setka::Scene>> scenes;
    for (const std::string name : {"terrain", "spheres", "soup"})
        scenes.emplace_back(name, setka::make_scene(name, triangles));
    for (const std::string name : {"torus", "cube"}) scenes.emplace_back(name, setka::make_scene(name));
    scenes.emplace_back("ball", support::ball(triangles));
    scenes.emplace_back("room", support::mirror_and_glass());
    for (const auto& [name, scene] : scenes)
        for (const float density : {0.5f, 8.0f, 32.0f}) {
            const std::string digest = expected(scene, {.density = density});
            for (const auto tables : {CellTables::Bins, CellTables::Scatter}) {
                SCOPED_TRACE(name + ", density " + std::to_string(density) + ", " + to_string(tables));
                const Seen seen = build(scene, {.density = density, .cell_tables = tables});
                EXPECT_EQ(seen.waits_to_start, 0u);
                EXPECT_EQ(seen.waits, 1u);
                EXPECT_EQ(seen.digest, digest);
            }
        }
}

/// Room that is not needed costs little. Where a stop can be requested, there are several launches, and every size but that of pairs in bins is known
/// before it is used. The tables are the same.
TEST_P(Waits, RoomIsSomeThirtyPercentAtMost) {
    if (support::has_small_sizes())
        GTEST_SKIP() << "SETKA_TEST_SIZE=small: sides are a large part of small scenes";
    // Pairs in bins take 4 bytes, and room for 6 a triangle; spheres have 1.8, and hold least of all else. Where bins are not what a device
    // makes by itself, each has counters of its own.
    for (const auto& [tables, most] : {std::pair(CellTables::Scatter, 1.3), std::pair(CellTables::Bins, 1.5)}) {
        if (tables == CellTables::Bins && !setka::prefers_bins(device())) continue;
        for (const std::string name : {"terrain", "spheres", "soup"}) {
            SCOPED_TRACE(name + ", " + to_string(tables));
            const setka::Scene scene = setka::make_scene(name, 100000);
            const Seen roomy = build(scene, {.cell_tables = tables});
            const std::stop_source stop;
            queue().set_stop_token(stop.get_token());
            const Seen careful = build(scene, {.cell_tables = tables});
            queue().set_stop_token({});
            EXPECT_EQ(roomy.digest, careful.digest);
            EXPECT_GT(roomy.peak_bytes, careful.peak_bytes);
            EXPECT_LT(double(roomy.peak_bytes), most * double(careful.peak_bytes));
        }
    }
}

TEST_P(Waits, TwiceForSheetsOfWhichBlocksAreThickerThanCells) {
    const setka::Scene sheet = support::sheet(64);
    for (const auto tables : {CellTables::Bins, CellTables::Scatter}) {
        SCOPED_TRACE(to_string(tables));
        const Seen seen = build(sheet, {.cell_tables = tables});
        EXPECT_EQ(seen.waits_to_start, 0u);
        EXPECT_EQ(seen.waits, 2u);
        EXPECT_EQ(seen.digest, expected(sheet));
    }
}

TEST_P(Waits, OnceOrTwiceForOddScenesAndOptions) {
    std::uint32_t once = 0, twice = 0;
    for (const support::SceneCase& odd : support::degenerate_scenes()) {
        const setka::Scene scene = odd.make();
        if (scene.triangle_count() > 20000) continue;
        for (const GridOptions& options :
             {GridOptions{}, GridOptions{.density = 1e-6f}, GridOptions{.density = 300},
              GridOptions{.max_cells_per_axis = 1}, GridOptions{.density = 64, .max_cells_per_axis = 5}}) {
            SCOPED_TRACE(odd.name + ", density " + std::to_string(options.density) + ", up to " +
                         std::to_string(options.max_cells_per_axis));
            const Seen seen = build(scene, options);
            EXPECT_EQ(seen.waits_to_start, 0u);
            EXPECT_EQ(seen.digest, expected(scene, options));
            once += seen.waits == 1;
            twice += seen.waits > 1;
        }
    }
    EXPECT_GT(once, 4 * twice);
    std::printf("%u builds waited once, %u more often\n", once, twice);
}

TEST_P(Waits, TwiceWhereTheDeviceMakesNoHeader) {
    const setka::Scene scene = support::ball(3000);
    const std::string digest = expected(scene);
    for (const auto tables : {CellTables::Bins, CellTables::Scatter}) {
        SCOPED_TRACE(to_string(tables));
        steps().instead_of(resolve(tables), [](auto&&...) {});
        const Seen seen = build(scene, {.cell_tables = tables});
        EXPECT_EQ(seen.waits, 2u);
        EXPECT_EQ(seen.digest, digest);
    }
}

TEST_P(Waits, TwiceWhereTheDeviceMakesAnotherHeader) {
    const setka::Scene scene = support::ball(3000);
    const std::string digest = expected(scene);
    for (std::size_t word = SK_REPORT_HEADER; word < SK_REPORT; ++word) {
        SCOPED_TRACE("word " + std::to_string(word));
        for (const auto tables : {CellTables::Bins, CellTables::Scatter}) {
            SCOPED_TRACE(to_string(tables));
            const Kernel kernel = resolve(tables);
            steps().instead_of(kernel, [&](setka::backend::Queue& real, std::uint32_t groups, std::uint32_t group_size,
                                           const setka::Arguments& arguments) {
                real.launch(kernel, groups, group_size, arguments);
                setka::backend::Memory& memory = *arguments[arguments.size() - 1].memory;
                setka::Report report;
                real.read(memory, report.data(), sizeof report);
                report[word] -= report[word] > 0 ? 1 : ~0u;  // one less of anything, or one
                real.write(memory, 0, report.data(), sizeof report);
            });
            const Seen seen = build(scene, {.cell_tables = tables});
            EXPECT_EQ(seen.waits, 2u);
            EXPECT_EQ(seen.digest, digest);
        }
        steps().heal();
    }
    EXPECT_EQ(build(scene).waits, 1u) << "nothing is remembered";
}

class Started : public Waits {};
SETKA_ON_EVERY_DEVICE(Started);

/// For every way to the tables, and where a stop can be requested: start() does what it can.
TEST_P(Started, MakesThePlanOfTheSceneAsItWas) {
    const setka::Scene scene = support::ball(2000);
    const std::string digest = expected(scene);
    for (const bool can_stop : {false, true})
        for (const auto tables : {CellTables::Bins, CellTables::Scatter, CellTables::RunBoundaries, CellTables::BinarySearch}) {
            const std::stop_source stop;
            queue().set_stop_token(can_stop ? stop.get_token() : std::stop_token());
            const auto builder = setka::make_grid_builder({.cell_tables = tables});
            setka::DeviceScene on_device(queue(), scene);
            setka::StartedGrid first = builder->start(queue(), on_device);
            on_device.set_transform(0, {{3, 0, 0, 1, 0, 2, 0, 0, 0, 0, 1, 0}});
            on_device.commit(queue());
            setka::StartedGrid second = builder->start(queue(), on_device);
            const auto moved = builder->build(queue(), builder->plan(queue(), std::move(second)));
            const auto grid = builder->build(queue(), builder->plan(queue(), std::move(first)));
            EXPECT_EQ(grid.digest(queue()).to_string(), digest);
            EXPECT_EQ(moved.digest(queue()), builder->build(queue(), on_device).digest(queue()));
            EXPECT_NE(moved.digest(queue()), grid.digest(queue()));
        }
    queue().set_stop_token({});
}

TEST_P(Started, MakesOnePlan) {
    const setka::DeviceScene on_device(queue(), support::ball(500));
    const auto builder = setka::make_grid_builder();
    setka::StartedGrid started = builder->start(queue(), on_device);
    (void)builder->plan(queue(), std::move(started));
    try {
        (void)builder->plan(queue(), std::move(started));  // NOLINT(bugprone-use-after-move): what is asked
        ADD_FAILURE() << "nothing was thrown";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), setka::ErrorCategory::InvalidArgument) << error.what();
    }
}

TEST_P(Started, GivesBackWhatItHolds) {
    const setka::DeviceScene on_device(queue(), support::ball(500));
    const std::uint64_t before = device().memory_in_use_bytes();
    {
        const setka::StartedGrid dropped = setka::make_grid_builder()->start(queue(), on_device);
        EXPECT_GT(device().memory_in_use_bytes(), before);
    }
    EXPECT_EQ(device().memory_in_use_bytes(), before);
}

TEST_P(Started, LeavesErrorsOfTheSceneToThePlan) {
    setka::Scene scene = support::ball(100, {}, 1e30f);
    scene.instances[0].transform.rows[0] = 1e20f;  // finite here, infinite there
    const setka::DeviceScene on_device(queue(), scene);
    const std::uint64_t before = device().memory_in_use_bytes();
    const auto builder = setka::make_grid_builder();
    try {
        (void)builder->plan(queue(), builder->start(queue(), on_device));
        ADD_FAILURE() << "nothing was thrown";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), setka::ErrorCategory::InvalidData);
        EXPECT_THAT(error.what(), ::testing::HasSubstr("scene triangle 0 has a vertex that is not finite"));
    }
    EXPECT_EQ(device().memory_in_use_bytes(), before);
}

/// The budget is that of the moment at which the plan is made: what is given back after start() is there again.
TEST_P(Started, CountsWhatIsHeldWhenItIsPlanned) {
    const setka::Scene scene = support::ball(support::sized(20000u, 2000u));
    const auto builder = setka::make_grid_builder();
    std::uint64_t scene_bytes = 0, started_bytes = 0, peak_bytes = 0;
    std::vector<std::uint32_t> references;
    {
        const setka::DeviceScene on_device(queue(), scene);
        scene_bytes = device().memory_in_use_bytes();
        setka::StartedGrid started = builder->start(queue(), on_device);
        started_bytes = device().memory_in_use_bytes() - scene_bytes;
        setka::GridPlan plan = builder->plan(queue(), std::move(started));
        peak_bytes = plan.peak_bytes();
        references = queue().download(builder->build(queue(), std::move(plan)).compact_tables().references);
    }
    ASSERT_GT(peak_bytes, started_bytes);
    const setka::Device limited = setka::Device::open(GetParam(), {.memory_budget_bytes = scene_bytes + peak_bytes});
    setka::Queue other = limited.make_queue();
    const setka::DeviceScene on_device(other, scene);
    auto last_frame = other.make_buffer<std::uint8_t>(peak_bytes - started_bytes, "a grid");
    setka::StartedGrid started = builder->start(other, on_device);
    last_frame = {};
    setka::GridPlan plan = builder->plan(other, std::move(started));
    EXPECT_EQ(plan.peak_bytes(), peak_bytes);
    EXPECT_EQ(other.download(builder->build(other, std::move(plan)).compact_tables().references), references);
}

TEST_P(Started, IsPlannedWhereItWasStarted) {
    const setka::DeviceScene on_device(queue(), support::ball(500));
    const auto sorting = setka::make_grid_builder({.cell_tables = CellTables::RunBoundaries});
    const auto builder = setka::make_grid_builder();
    setka::Queue other = device().make_queue();
    const auto refused = [](const auto& action, const char* phrase) {
        try {
            action();
            ADD_FAILURE() << "nothing was thrown";
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), setka::ErrorCategory::InvalidArgument);
            EXPECT_THAT(error.what(), ::testing::HasSubstr(phrase));
        }
    };
    refused([&] { (void)builder->plan(queue(), sorting->start(queue(), on_device)); }, "'run-boundaries', the builder 'auto'");
    refused([&] { (void)sorting->plan(queue(), builder->start(queue(), on_device)); }, "'auto', the builder 'run-boundaries'");
    refused([&] { (void)builder->plan(other, builder->start(queue(), on_device)); }, "another queue");
    const auto denser = setka::make_grid_builder({.density = 16});
    EXPECT_EQ(denser->build(queue(), denser->plan(queue(), builder->start(queue(), on_device))).digest(queue()),
              denser->build(queue(), on_device).digest(queue()));
}

}  // namespace
