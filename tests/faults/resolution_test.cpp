// SPDX-License-Identifier: MIT
/// Does a device that computes a grid's resolution itself get the host's header, bit for bit? For any bounds,
/// and nothing where there is none to be had.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "accel/compact_tables.hpp"
#include "accel/grid_resolution.hpp"
#include "core/launch.hpp"
#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/random.hpp"
#include "support/sizes.hpp"

namespace {

using setka::Report;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

struct Case {
    setka::WorldGeometry geometry;
    setka::GridOptions options;
};

/// As in device/grid/resolution.h, said once more.
std::uint32_t ordered(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return bits >> 31 ? ~bits : bits | 1u << 31;
}

class Resolution : public support::DeviceTest {
  protected:
    void SetUp() override {
        support::DeviceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        if (!device().impl()->has_doubles()) GTEST_SKIP() << "the device has no doubles";
        queue_ = device().make_queue();
        report_ = setka::make_report(*queue_);
    }

    /// What the device reports for these bounds; `bad` is the complement of a triangle that is not finite.
    Report resolve(const Case& asked, std::uint32_t blocks, std::uint32_t bad = 0) {
        Report words{};
        words[SK_REPORT_BAD] = bad;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            words[SK_REPORT_LOWER + axis] = ~ordered(asked.geometry.bounds.lower[axis]);
            words[SK_REPORT_UPPER + axis] = ordered(asked.geometry.bounds.upper[axis]);
        }
        queue_->upload(std::span<const std::uint32_t>(words), report_);
        setka::launch_items(*queue_, setka::Kernel::grid_resolve, 1, blocks, asked.options.density,
                            asked.options.max_cells_per_axis, asked.geometry.triangle_count,
                            asked.geometry.instance_count, report_);
        return setka::read_report(*queue_, report_);
    }

    std::optional<setka::Queue> queue_;
    setka::Buffer<std::uint32_t> report_;
};
SETKA_ON_EVERY_DEVICE(Resolution);

setka::Bounds random_bounds(support::Random& random) {
    setka::Bounds bounds{};
    const std::uint32_t shape = random.below(8);
    for (int axis = 0; axis < 3; ++axis) {
        float lower = random.below(3) ? random.between(-10, 10) : 0.0f;
        float size = random.unit() * std::ldexp(1.0f, static_cast<int>(random.below(60)) - 30);
        if (shape == 0) size = std::floor(random.between(0, 4));
        if (shape == 1 && random.below(2)) size = 0;  // flat, a line or a point
        if (shape == 2) {                             // subnormal
            lower = 0;
            size = std::bit_cast<float>(random.below(1u << 23));
        }
        if (shape == 3) size = random.between(0.5e20f, 1e20f);
        if (shape == 4) size = axis == 0 ? 1000.0f : 1e-3f * size;  // long
        bounds.lower[axis] = lower;
        bounds.upper[axis] = lower + size;
    }
    return bounds;
}

Case random_case(support::Random& random) {
    Case made;
    made.geometry.bounds = random_bounds(random);
    made.geometry.triangle_count = 1 + random.below(std::uint64_t{1} << random.below(28));
    made.geometry.instance_count = 1 + random.below(1000);
    made.options.density = std::ldexp(1.0f + random.unit(), static_cast<int>(random.below(38)) - 19);
    made.options.max_cells_per_axis = 1 + random.below(random.below(2) ? 4096 : 100);
    return made;
}

TEST_P(Resolution, IsTheHosts) {
    support::Random random(51);
    const int cases = support::sized(20000, 200);
    std::uint32_t refused = 0;
    for (int k = 0; k < cases; ++k) {
        const Case asked = random_case(random);
        const setka::GridResolution resolution =
            grid_resolution(asked.geometry.bounds, asked.geometry.triangle_count, asked.options);
        const auto header = setka::make_header(asked.geometry, resolution);
        const std::uint32_t blocks = setka::block_count(header);
        const bool fits = k % 4 != 0;
        const Report report = resolve(asked, fits ? blocks : blocks - 1);
        ASSERT_TRUE(setka::has_header(report, fits ? header : ::SetkaGridHeader{}))
            << k << ": " << resolution.dims[0] << " x " << resolution.dims[1] << " x " << resolution.dims[2]
            << " cells of " << resolution.cell_size;
        refused += fits ? 0 : 1;
    }
    EXPECT_GT(refused, 0u);
}

TEST_P(Resolution, IsNoneWithoutABox) {
    const auto refuses = [&](const setka::Bounds& bounds, std::uint32_t bad) {
        Case asked;
        asked.geometry.bounds = bounds;
        asked.geometry.triangle_count = asked.geometry.instance_count = 1;
        return setka::has_header(resolve(asked, 1u << 24, bad), ::SetkaGridHeader{});
    };
    const setka::Bounds unit{{0, 0, 0}, {1, 1, 1}};
    EXPECT_FALSE(refuses(unit, 0));
    EXPECT_TRUE(refuses(unit, ~0u)) << "triangle 0 is not finite";
    EXPECT_FALSE(refuses({{0, 0, 0}, {1e20f, 1, 1}}, 0));
    EXPECT_TRUE(refuses({{0, 0, 0}, {1.1e20f, 1, 1}}, 0));
    EXPECT_TRUE(refuses({{-3e38f, 0, 0}, {3e38f, 1, 1}}, 0));
    for (std::uint32_t axis = 0; axis < 3; ++axis)
        for (const auto& [lower, upper] : {std::pair{1.0f, 0.0f},
                                           {nan, 1.0f},
                                           {0.0f, nan},
                                           {-infinity, 1.0f},
                                           {0.0f, infinity},
                                           {infinity, -infinity},
                                           {infinity, infinity},
                                           {nan, nan},
                                           {-nan, -nan}}) {
            setka::Bounds bounds = unit;
            bounds.lower[axis] = lower;
            bounds.upper[axis] = upper;
            EXPECT_TRUE(refuses(bounds, 0)) << lower << " to " << upper << " along axis " << axis;
        }
}

}  // namespace
