// SPDX-License-Identifier: MIT
/// Do triangles as large as the scene hold up a million small ones? Builds with and without them, in turn, in
/// one process. One giant has a row of cells for each cell along an axis, and each row is a work-item's:
/// beside n small triangles in a grid of about n cells it adds some n^(2/3) pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "setka/scenes.hpp"
#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/sizes.hpp"

namespace {

using setka::Float3;

/// `scene` and two triangles that cross its whole box, one aslant and one in a plane of cells.
setka::Scene with_giants(setka::Scene scene) {
    const setka::Bounds bounds = scene.bounds();
    const auto corner = [&](int x, int y, int z) {
        return Float3{x ? bounds.upper[0] : bounds.lower[0], y ? bounds.upper[1] : bounds.lower[1],
                      z ? bounds.upper[2] : bounds.lower[2]};
    };
    setka::Mesh mesh;
    mesh.positions = {corner(0, 0, 0), corner(1, 0, 1), corner(0, 1, 1),
                      corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0)};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    scene.meshes.push_back(std::move(mesh));
    setka::Instance instance;
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
    scene.instances.push_back(instance);
    return scene;
}

class Giant : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Giant);

TEST_P(Giant, AsLargeAsTheSceneDoesNotStallTheBuild) {
    if (support::has_small_sizes())
        GTEST_SKIP()
            << "SETKA_TEST_SIZE=small is for sanitizers and emulators, under which times say nothing";
    setka::Queue queue = device().make_queue();
    const bool is_cpu = device().info().type == setka::DeviceType::Cpu;
    const setka::Scene small = setka::make_scene("soup", is_cpu ? 200000 : 1000000);
    const setka::DeviceScene without(queue, small), with(queue, with_giants(small));
    const auto builder = setka::make_grid_builder();
    const auto build_ms = [&](const setka::DeviceScene& scene) {
        queue.finish();
        const auto start = std::chrono::steady_clock::now();
        const setka::Grid grid = builder->build(queue, scene);
        queue.finish();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    (void)build_ms(with);  // kernels are compiled, pools filled
    // In turn, so that whatever else the machine does falls on both.
    std::vector<double> small_ms, giant_ms;
    for (int round = 0; round < 5; ++round) {
        small_ms.push_back(build_ms(without));
        giant_ms.push_back(build_ms(with));
    }
    const auto median = [](std::vector<double>& times) {
        std::ranges::sort(times);
        return times[times.size() / 2];
    };
    const double ratio = median(giant_ms) / median(small_ms);
    std::printf("median of 5 builds: %.1f ms, with giants %.1f ms, ratio %.2f\n", median(small_ms),
                median(giant_ms), ratio);
    EXPECT_LE(ratio, 2);
}

}  // namespace
