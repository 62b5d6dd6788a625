// SPDX-License-Identifier: MIT
/// What do the renderer's tests stand on? Small scenes made by hand (support/handmade.hpp), and a picture of
/// one in a line.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "setka/setka.hpp"
#include "support/compare.hpp"
#include "support/handmade.hpp"

namespace setka::render_test {

using namespace support;

struct Picture {
    Image image;
    RenderStatistics statistics;

    [[nodiscard]] Float3 at(std::uint32_t x, std::uint32_t y) const {
        return image.linear[y * image.width + x];
    }
};

/// One device serves all cases of a suite; without any they are skipped, or fail if SETKA_REQUIRE asks for
/// one.
class Render : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        if (!enumerate_devices().empty()) device_ = Device::open();
    }
    static void TearDownTestSuite() { device_.reset(); }
    void SetUp() override {
        if (device_) return;
        if (std::getenv("SETKA_REQUIRE")) FAIL() << "SETKA_REQUIRE is set, but there is no device";
        GTEST_SKIP() << "no device";
    }

    /// A picture of `scene` through its camera.
    [[nodiscard]] Picture render(const Scene& scene,
                                 const RenderOptions& options = {.width = 64, .height = 64}) {
        return render_on(*device_, scene, options);
    }

    [[nodiscard]] static Picture render_on(const Device& device, const Scene& scene,
                                           const RenderOptions& options,
                                           StructureKind kind = StructureKind::UniformGrid) {
        Queue queue = device.make_queue();
        const DeviceScene device_scene(queue, scene);
        Renderer renderer(options);
        Image image;
        if (kind == StructureKind::UniformGrid) {
            // Coarse, so that the pictures need more memory than the grid, and budgets divide them.
            const Grid grid = make_grid_builder({.density = 2})->build(queue, device_scene);
            image = renderer.render(queue, device_scene, grid, *scene.camera);
        } else {
            const BruteForce brute_force = BruteForce::build(queue, device_scene);
            image = renderer.render(queue, device_scene, brute_force, *scene.camera);
        }
        return {std::move(image), renderer.statistics()};
    }

    inline static std::optional<Device> device_;
};

[[nodiscard]] inline bool near(const Float3& a, const Float3& b, float tolerance) {
    return std::fabs(a.x - b.x) <= tolerance && std::fabs(a.y - b.y) <= tolerance &&
           std::fabs(a.z - b.z) <= tolerance;
}

/// The largest difference of a channel between two pictures of one size.
[[nodiscard]] inline float largest_difference(const Image& a, const Image& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.linear.size(); ++i)
        largest =
            std::max({largest, std::fabs(a.linear[i].x - b.linear[i].x),
                      std::fabs(a.linear[i].y - b.linear[i].y), std::fabs(a.linear[i].z - b.linear[i].z)});
    return largest;
}

/// Success if `call` throws an Error of this category whose message has these words.
template <typename Call>
[[nodiscard]] ::testing::AssertionResult fails_with(ErrorCategory category, const std::string& words,
                                                    const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        if (error.category() == category && std::string(error.what()).find(words) != std::string::npos)
            return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure() << to_string(error.category()) << ": " << error.what();
    }
    return ::testing::AssertionFailure() << "nothing was thrown";
}

}  // namespace setka::render_test
