// SPDX-License-Identifier: MIT
/// What if a scene needs more than tables can number? Totals beyond 2^31 and 2^32 are counted right, and
/// refused with their numbers before anything large is allocated and before anyone has waited long.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>

#include "backend/device.hpp"
#include "scene/limits.hpp"
#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"

namespace {

using setka::ErrorCategory;
using setka::Float3;
using support::Corners;

constexpr std::uint32_t mesh_lines = 4096;
constexpr float length = 4096;

/// Triangles without an area, each as long as 4096 cells and in one row of them or, lying across the rows,
/// one column; and one at each end of the scene. `instances` times 4096 of them: as many cells and rows as
/// that times 4096, and two.
setka::Scene lines(std::uint32_t instances, bool across_rows) {
    std::vector<Corners> triangles;
    for (std::uint32_t i = 0; i < mesh_lines; ++i) {
        const float a = static_cast<float>(i % 16) + 0.5f, b = static_cast<float>(i / 16 % 16) + 0.5f;
        const auto at = [&](float t) { return across_rows ? Float3{a, t, b} : Float3{a, b, t}; };
        triangles.push_back({at(0), at(length), at(length / 2)});
    }
    setka::Scene scene = support::from_triangles(triangles);
    scene.instances.resize(instances, scene.instances.front());
    const Float3 lower{0, 0, 0}, upper = across_rows ? Float3{16, length, 16} : Float3{16, 16, length};
    setka::append(scene, support::from_triangles({{lower, lower, lower}, {upper, upper, upper}}));
    return scene;
}

/// Triangles that cross the whole box.
setka::Scene diagonals(std::uint32_t instances) {
    std::vector<Corners> triangles;
    for (int i = 0; i < 100; ++i) {
        const float t = static_cast<float>(i) / 100;
        triangles.push_back({Float3{t, 0, 0}, Float3{1, 1 - t, t}, Float3{0, 1, 1}});
    }
    setka::Scene scene = support::from_triangles(triangles);
    scene.instances.resize(instances, scene.instances.front());
    return scene;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class Totals : public support::DeviceTest {
  protected:
    /// What plan() says when it refuses.
    std::string refusal(const setka::Scene& scene, const setka::GridOptions& options) {
        const setka::Device opened = device();
        setka::Queue queue = opened.make_queue();
        const setka::DeviceScene device_scene(queue, scene);
        const std::uint64_t before = opened.memory_in_use_bytes();
        opened.reset_peak_memory();
        try {
            (void)setka::make_grid_builder(options)->plan(queue, device_scene);
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::OutOfMemory) << error.what();
            EXPECT_EQ(opened.memory_in_use_bytes(), before) << "bytes are lost";
            peak_bytes_ = opened.peak_memory_bytes() - before;
            return error.what();
        }
        return "nothing was thrown";
    }

    std::uint64_t peak_bytes_ = 0;  ///< of the last refusal
};
SETKA_ON_EVERY_DEVICE(Totals);

TEST_P(Totals, OfPairsBeyond31And32Bits) {
    // 2^31 + 2, the first that does not fit; 2^32 + 2, which 32 bits would take for 2; and more.
    for (const std::uint32_t instances : {128u, 256u, 300u}) {
        const std::uint64_t pairs = std::uint64_t(instances) * mesh_lines * 4096 + 2;
        EXPECT_THAT(refusal(lines(instances, false), {.max_cells_per_axis = 4096}),
                    ::testing::HasSubstr("needs " + std::to_string(pairs) +
                                         " pairs (triangle, cell); tables hold up to 2147483647"));
        // World, rows, counts and the blocks that a scene of so many triangles usually has: nothing of the size of pairs.
        EXPECT_LT(peak_bytes_, std::uint64_t(instances) * mesh_lines * 120);
    }
}

TEST_P(Totals, OfRowsBeyond31And32Bits) {
    for (const std::uint32_t instances : {128u, 256u, 300u}) {
        const std::uint64_t rows = std::uint64_t(instances) * mesh_lines * 4096 + 2;
        EXPECT_THAT(refusal(lines(instances, true), {.max_cells_per_axis = 4096}),
                    ::testing::HasSubstr("needs " + std::to_string(rows) +
                                         " rows of cells; tables hold up to 2147483647"));
        EXPECT_LT(peak_bytes_, std::uint64_t(instances) * mesh_lines * 120);
    }
}

/// The largest total that can be numbered is no reason to refuse; its memory is, where it is not there.
TEST_P(Totals, JustBelow31BitsAreAQuestionOfMemory) {
    constexpr std::uint64_t rows = 127ull * mesh_lines * 4096 + 2;
    const setka::Device limited =
        setka::Device::open(GetParam(), {.memory_budget_bytes = std::uint64_t{1} << 30});
    setka::Queue queue = limited.make_queue();
    const setka::DeviceScene scene(queue, lines(127, true));
    try {
        (void)setka::make_grid_builder({.max_cells_per_axis = 4096})->plan(queue, scene);
        FAIL() << "nothing was thrown";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::OutOfMemory);
        EXPECT_THAT(error.what(),
                    ::testing::HasSubstr("to count pairs in " + std::to_string(rows) + " rows of cells; "));
        EXPECT_THAT(error.what(), ::testing::HasSubstr("of the memory budget of 1073741824 bytes"));
    }
    EXPECT_EQ(limited.memory_in_use_bytes(), scene.size_bytes());
}

/// Far more pairs than tables hold, each found by itself: some 40 billion here. Counting gives up when it has
/// seen 2^31 columns: after the time that the largest grid allowed takes, not after twenty times that.
TEST_P(Totals, OfGiantsAreNotCountedForever) {
    const setka::Scene scene = diagonals(1000);
    const auto start = std::chrono::steady_clock::now();
    const std::string message = refusal(scene, {.density = 1e4f, .max_cells_per_axis = 512});
    std::printf("gave up after %.1f s: %s\n", seconds_since(start), message.c_str());
    const std::string words = "needs at least ";
    const std::size_t at = message.find(words);
    ASSERT_NE(at, std::string::npos) << message;
    const std::uint64_t counted = std::stoull(message.substr(at + words.size()));
    EXPECT_GT(counted, std::uint64_t{1} << 31);
    EXPECT_LT(counted, std::uint64_t{1} << 33) << "counted far beyond what is needed to refuse";
    EXPECT_THAT(message, ::testing::HasSubstr(" pairs (triangle, cell); tables hold up to 2147483647"));
}

/// A device of which one allocation may have only so many bytes.
class SmallAllocations final : public setka::backend::Device {
  public:
    SmallAllocations(const setka::Device& real, std::uint64_t bytes) : real_(real), info_(real.info()) {
        info_.max_allocation_bytes = bytes;
    }
    [[nodiscard]] const setka::DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] const setka::DeviceOptions& options() const noexcept override { return real_.options(); }
    [[nodiscard]] std::shared_ptr<setka::backend::Queue> make_queue() override {
        return real_.impl()->make_queue();
    }
    void trim() override { real_.trim(); }

  private:
    setka::Device real_;
    setka::DeviceInfo info_;
};

TEST_P(Totals, OfOneTableBeyondAnAllocationAreRefusedByThePlan) {
    const setka::Scene scene = support::ball(2000);
    const auto plan = [&](std::uint64_t allocation_bytes) {
        const setka::Device limited(std::make_shared<SmallAllocations>(device(), allocation_bytes));
        setka::Queue queue = limited.make_queue();
        const setka::DeviceScene device_scene(queue, scene);
        return setka::make_grid_builder({.density = 1})->plan(queue, device_scene).pair_count();
    };
    const std::uint64_t pairs = plan(std::uint64_t{1} << 30);
    EXPECT_EQ(plan(pairs * 4), pairs);
    try {
        (void)plan(pairs * 4 - 1);
        FAIL() << "nothing was thrown";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::OutOfMemory);
        EXPECT_THAT(error.what(), ::testing::HasSubstr("'references'"));
        EXPECT_THAT(error.what(), ::testing::HasSubstr(std::to_string(pairs * 4) + " bytes"));
    }
}

TEST_P(Totals, OfTrianglesAreLimitedBeforeAnythingIsUploaded) {
    const setka::Device opened = device();
    setka::Queue queue = opened.make_queue();
    setka::Scene scene = support::ball(1 << 20);
    const std::uint64_t triangles = scene.triangle_count();
    const std::uint64_t instances = (std::uint64_t{1} << 28) / triangles + 1;
    scene.instances.resize(instances, scene.instances.front());
    const std::uint64_t before = opened.memory_in_use_bytes();
    opened.reset_peak_memory();
    try {
        const setka::DeviceScene device_scene(queue, scene);
        FAIL() << "nothing was thrown";
    } catch (const setka::Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument);
        EXPECT_THAT(error.what(), ::testing::HasSubstr("has " + std::to_string(instances * triangles) +
                                                       " triangles; up to 268435456 are accepted"));
    }
    EXPECT_EQ(opened.peak_memory_bytes(), before);
}

/// Counts that no test can hold: what is checked is the check.
TEST(SceneLimits, EachCountHasItsOwn) {
    constexpr std::uint64_t most_triangles = std::uint64_t{1} << 28, most_vertices = std::uint64_t{1} << 30;
    const auto refusal = [](const setka::SceneSize& size) -> std::string {
        try {
            setka::check_scene_size(size);
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument);
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(refusal({most_vertices, most_triangles, most_triangles, most_triangles}), "accepted");
    EXPECT_EQ(refusal({most_vertices + 1, 1, 1, 1}),
              "the scene has 1073741825 vertices; up to 1073741824 are accepted");
    EXPECT_EQ(refusal({3, most_triangles + 1, 1, 1}),
              "the scene's meshes have 268435457 triangles; up to 268435456 are accepted");
    EXPECT_EQ(refusal({3, 1, (std::uint64_t{1} << 32) + 5, 1}),
              "the scene has 4294967301 triangles; up to 268435456 are accepted");
    EXPECT_EQ(refusal({3, 1, 1, most_triangles + 1}),
              "the scene has 268435457 instances; up to 268435456 are accepted");
}

}  // namespace
