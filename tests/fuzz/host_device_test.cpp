// SPDX-License-Identifier: MIT
/// Is the host a device like any other, and may threads share a device? Kernels on the host pass the probe; threads
/// with a queue each build and trace at once, which the thread sanitizer watches where everything is compiled with it.
#include "fuzz/host_device.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

#include "core/probe.hpp"
#include "oracle/oracle.hpp"
#include "setka/grid.hpp"
#include "setka/tracer.hpp"
#include "support/compare.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"

namespace {

TEST(HostDevice, ComputesAsEveryDevice) {
    setka::Queue queue = fuzz::host_device().make_queue();
    EXPECT_EQ(setka::run_probe(queue).differences, std::vector<std::string>());
}

/// A work-item traces eight rays: the last may have fewer. Cells of the coarse grid list more than the 32 triangles of a round.
TEST(HostDevice, TracesBatchesOfEverySize) {
    setka::Queue queue = fuzz::host_device().make_queue();
    const setka::Scene scene = support::ball(300);
    const setka::DeviceScene device_scene(queue, scene);
    setka::GridOptions coarse;
    coarse.density = 0.02f;
    const std::array grids{setka::make_grid_builder()->build(queue, device_scene),
                           setka::make_grid_builder(coarse)->build(queue, device_scene)};
    const setka::BruteForce brute_force = setka::BruteForce::build(queue, device_scene);
    const auto rays = support::adversarial_rays(oracle::make_world(scene), 40, 11);
    const setka::Tracer tracer;
    for (std::size_t n = 0; n <= rays.size(); ++n) {
        const std::span batch(rays.data(), n);
        const auto right = tracer.closest_hit(queue, brute_force, batch);
        const auto occluded = tracer.any_hit(queue, brute_force, batch);
        // Past what was hit, each ray another triangle.
        std::vector<setka::Primitive> skip;
        for (const setka::Hit& hit : right) skip.push_back({hit.primitive, hit.instance});
        const auto behind = tracer.closest_hit(queue, brute_force, batch, skip);
        for (const setka::Grid& grid : grids) {
            EXPECT_TRUE(support::same_hits(batch, right, tracer.closest_hit(queue, grid, batch))) << n << " rays";
            EXPECT_EQ(tracer.any_hit(queue, grid, batch), occluded) << n << " rays";
            EXPECT_TRUE(support::same_hits(batch, behind, tracer.closest_hit(queue, grid, batch, skip)))
                << n << " rays";
        }
    }
}

TEST(HostDevice, IsSharedByThreads) {
    const setka::Device device = fuzz::host_device();
    const setka::Scene scene = support::ball(100);
    const oracle::World world = oracle::make_world(scene);
    const auto rays = support::adversarial_rays(world, 200, 3);
    const auto right = oracle::closest_hits(world, rays);
    std::vector<std::vector<setka::Hit>> hits(3);  // four may need more than the memory that the device says it has, all at once
    {
        std::vector<std::jthread> threads;
        for (auto& own : hits)
            threads.emplace_back([&] {
                setka::Queue queue = device.make_queue();
                for (int round = 0; round < 5; ++round) {
                    const setka::DeviceScene device_scene(queue, scene);
                    const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
                    own = setka::Tracer().closest_hit(queue, grid, rays);
                }
            });
    }
    for (const auto& own : hits) EXPECT_TRUE(support::same_hits(rays, right, own));
    EXPECT_EQ(device.memory_in_use_bytes(), 0u);
}

}  // namespace
