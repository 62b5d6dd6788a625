// SPDX-License-Identifier: MIT
/// Are a device's hits the oracle's, and those of grids of any density and stepping rule those of brute
/// force, bit for bit?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stop_token>

#include "setka/error.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"
#include "support/sizes.hpp"

namespace {

constexpr float densities[] = {0.05f, 0.5f, 4.0f, 16.0f, 64.0f};
constexpr setka::GridStep steps[] = {setka::GridStep::Dda, setka::GridStep::BranchFree};

const char* name(setka::GridStep step) { return step == setka::GridStep::Dda ? "DDA" : "branch-free"; }

std::size_t count_hits(const std::vector<setka::Hit>& hits) {
    return static_cast<std::size_t>(std::count_if(
        hits.begin(), hits.end(), [](const setka::Hit& hit) { return hit.primitive != SETKA_NO_HIT; }));
}

class Hits : public support::DeviceAndTest<std::string> {
  protected:
    [[nodiscard]] setka::Scene scene() const { return support::find_scene(other()).make(); }
};
SETKA_ON_EVERY_DEVICE_AND(Hits, support::names(support::all_scenes()));

TEST_P(Hits, OfBruteForceEqualTheOracles) {
    const setka::Scene host_scene = scene();
    const oracle::World world = oracle::make_world(host_scene);
    const auto rays = support::adversarial_rays(world, support::sized(6000, 300), 41);
    const auto expected = oracle::closest_hits(world, rays);
    for (const support::LaunchShape& shape :
         support::launch_shapes_of(std::get<0>(GetParam()), {"defaults", "Serial_1", "Group_256"})) {
        SCOPED_TRACE(shape.name);
        setka::Queue queue = device(shape.options).make_queue();
        const auto brute = setka::BruteForce::build(queue, setka::DeviceScene(queue, host_scene));
        EXPECT_TRUE(support::same_hits(rays, expected, setka::Tracer().closest_hit(queue, brute, rays)));
        EXPECT_TRUE(support::same_occlusion(rays, expected, setka::Tracer().any_hit(queue, brute, rays)));
    }
    std::cout << count_hits(expected) << " of " << rays.size() << " rays hit\n";
}

TEST_P(Hits, OfGridsEqualThoseOfBruteForce) {
    const setka::Scene host_scene = scene();
    const oracle::World world = oracle::make_world(host_scene);
    const auto rays = support::adversarial_rays(world, support::sized(100000, 1000), 42);
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto brute = setka::BruteForce::build(queue, device_scene);
    const auto expected = setka::Tracer().closest_hit(queue, brute, rays);
    for (const float density : densities) {
        const auto grid = setka::make_grid_builder({.density = density})->build(queue, device_scene);
        for (const auto step : steps) {
            SCOPED_TRACE("density " + std::to_string(density) + ", " + name(step));
            const setka::Tracer tracer({.step = step});
            EXPECT_TRUE(support::same_hits(rays, expected, tracer.closest_hit(queue, grid, rays)));
            EXPECT_TRUE(support::same_occlusion(rays, expected, tracer.any_hit(queue, grid, rays)));
        }
    }
}

/// Where neighbours go together through the grid, also with what they skip.
TEST_P(Hits, OfBundlesEqualThoseOfBruteForce) {
    const setka::Scene host_scene = scene();
    const auto rays = support::bundled_rays(oracle::make_world(host_scene), support::sized(65536, 4096), 46);
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto brute = setka::BruteForce::build(queue, device_scene);
    const auto unskipped = setka::Tracer().closest_hit(queue, brute, rays);
    std::vector<setka::Primitive> skip(rays.size(), {SETKA_NO_HIT, SETKA_NO_HIT});
    for (std::size_t i = 0; i < rays.size(); i += 5) skip[i] = {unskipped[i].primitive, unskipped[i].instance};
    const auto expected = setka::Tracer().closest_hit(queue, brute, rays, skip);
    setka::RayBatch batch(queue.upload(std::span(rays), "rays"), queue.upload(std::span(skip), "skip"));
    const auto hits = queue.make_buffer<setka::Hit>(rays.size(), "hits");
    const auto flags = queue.make_buffer<std::uint32_t>(rays.size(), "flags");
    for (const float density : densities) {
        const auto grid = setka::make_grid_builder({.density = density})->build(queue, device_scene);
        for (const std::uint32_t row : {0u, 16u, 64u}) {  // in rows of 16 a bundle is a block of what is traced together
            SCOPED_TRACE("density " + std::to_string(density) + ", rows of " + std::to_string(row));
            batch.row_length = row;
            setka::Tracer().closest_hit(queue, grid, batch, hits);
            setka::Tracer().any_hit(queue, grid, batch, flags);
            EXPECT_TRUE(support::same_hits(rays, expected, queue.download(hits)));
            EXPECT_TRUE(support::same_occlusion(rays, expected, queue.download(flags)));
        }
    }
}

TEST_P(Hits, OfLongThinGridsEqualThoseOfBruteForce) {
    const setka::Scene host_scene = scene();
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), 20000, 43);
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto brute = setka::BruteForce::build(queue, device_scene);
    const auto expected = setka::Tracer().closest_hit(queue, brute, rays);
    for (const std::uint32_t cap : {1u, 2u, 3u, 17u}) {
        const auto grid = setka::make_grid_builder({.density = 1000, .max_cells_per_axis = cap})
                              ->build(queue, device_scene);
        for (const auto step : steps) {
            SCOPED_TRACE("at most " + std::to_string(cap) + " cells an axis, " + name(step));
            EXPECT_TRUE(support::same_hits(rays, expected,
                                           setka::Tracer({.step = step}).closest_hit(queue, grid, rays)));
        }
    }
}

class Rays : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Rays);

TEST_P(Rays, OfAnyNumber) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = support::ball(200);
    const oracle::World world = oracle::make_world(host_scene);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 255u, 257u, 4099u}) {
        const auto rays = support::adversarial_rays(world, count, 44);
        const auto expected = oracle::closest_hits(world, rays);
        EXPECT_TRUE(support::same_hits(rays, expected, setka::Tracer().closest_hit(queue, grid, rays)));
        EXPECT_TRUE(support::same_occlusion(rays, expected, setka::Tracer().any_hit(queue, grid, rays)));
    }
}

/// About as many as teams have at once, with half of their members and with all of them, and some more.
TEST_P(Rays, OfAsManyAsTeamsHave) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = support::ball(200);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    const std::size_t members = device().info().compute_units * std::size_t(28) * 32;  // as Tracer launches
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), members + members / 4 + 1, 47);
    const auto expected = setka::Tracer({.step = setka::GridStep::BranchFree}).closest_hit(queue, grid, rays);
    for (const std::size_t count : {members / 2 - 1, members / 2, members / 2 + 1, members - 1, members, members + 1, members + 33, rays.size()}) {
        SCOPED_TRACE(std::to_string(count) + " rays");
        const auto some = std::span(rays).first(count);
        const auto expected_of_some = std::span(expected).first(count);
        EXPECT_TRUE(support::same_hits(some, expected_of_some, setka::Tracer().closest_hit(queue, grid, some)));
        EXPECT_TRUE(support::same_occlusion(some, expected_of_some, setka::Tracer().any_hit(queue, grid, some)));
    }
}

/// Launches of two queues run side by side: what the teams of one have taken is nothing to the other.
TEST_P(Rays, OfTwoQueues) {
    setka::Queue queue = device().make_queue(), other = device().make_queue();
    const setka::Scene host_scene = support::ball(200);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), 200000, 48);
    const auto expected = setka::Tracer({.step = setka::GridStep::BranchFree}).closest_hit(queue, grid, rays);
    const setka::RayBatch batch(queue.upload(std::span(rays), "rays"));
    const std::vector<setka::Hit> no_hits(rays.size(), {-1, -1, -1, 0x5e7ca, 0x5e7ca});
    constexpr int times = 4;
    std::vector<setka::Buffer<setka::Hit>> hits;
    for (int i = 0; i < 2 * times; ++i) hits.push_back(queue.upload(std::span(no_hits), "hits"));
    queue.finish();
    for (int i = 0; i < times; ++i) {
        setka::Tracer().closest_hit(queue, grid, batch, hits[static_cast<std::size_t>(i)]);
        setka::Tracer().closest_hit(other, grid, batch, hits[static_cast<std::size_t>(times + i)]);
    }
    queue.finish();
    other.finish();
    for (const auto& of_one_launch : hits) EXPECT_TRUE(support::same_hits(rays, expected, queue.download(of_one_launch)));
}

/// Batches so large that teams take rays again and again, and that a queue which may be stopped traces in several launches.
TEST_P(Rays, OfManyInSeveralLaunches) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = support::ball(200);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    const std::size_t a_launch = device().info().type == setka::DeviceType::Cpu ? 1u << 17 : 1u << 20;
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), a_launch + 70001, 46);
    const auto expected = setka::Tracer({.step = setka::GridStep::BranchFree}).closest_hit(queue, grid, rays);
    const std::stop_source stop;
    for (const bool stoppable : {false, true}) {
        SCOPED_TRACE(stoppable ? "in parts" : "at once");
        queue.set_stop_token(stoppable ? stop.get_token() : std::stop_token());
        EXPECT_TRUE(support::same_hits(rays, expected, setka::Tracer().closest_hit(queue, grid, rays)));
        EXPECT_TRUE(support::same_occlusion(rays, expected, setka::Tracer().any_hit(queue, grid, rays)));
    }
}

/// Whatever a row's length is said to be, each ray is traced, once, with what it skips.
TEST_P(Rays, InRowsOfAnyLength) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = support::ball(200);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    constexpr std::size_t count = 1003;
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), count, 45);
    std::vector<setka::Primitive> skip(count, {SETKA_NO_HIT, SETKA_NO_HIT});
    const auto unskipped = setka::Tracer().closest_hit(queue, grid, rays);
    for (std::size_t i = 0; i < count; i += 3) skip[i] = {unskipped[i].primitive, unskipped[i].instance};
    const auto expected = setka::Tracer().closest_hit(queue, grid, rays, skip);
    ASSERT_NE(count_hits(expected), count_hits(unskipped));

    setka::RayBatch batch(queue.upload(std::span(rays), "rays"), queue.upload(std::span(skip), "skip"));
    const std::vector<setka::Hit> no_hits(count, {-1, -1, -1, 0x5e7ca, 0x5e7ca});
    const std::vector<std::uint32_t> no_flags(count, 0x5e7ca);
    for (const std::uint32_t row :
         {1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 11u, 13u, 14u, 16u, 17u, 25u, 31u, 40u, 125u, 250u, 251u, 1003u, 1004u, 0xffffffffu}) {
        SCOPED_TRACE("rows of " + std::to_string(row));
        batch.row_length = row;
        const auto hits = queue.upload(std::span(no_hits), "hits");
        const auto flags = queue.upload(std::span(no_flags), "flags");
        setka::Tracer().closest_hit(queue, grid, batch, hits);
        setka::Tracer().any_hit(queue, grid, batch, flags);
        EXPECT_TRUE(support::same_hits(rays, expected, queue.download(hits)));
        EXPECT_TRUE(support::same_occlusion(rays, expected, queue.download(flags)));
    }
}

/// No ray slips through a closed mesh: every ray from inside hits, if it is aimed at a vertex or edge too.
TEST_P(Rays, DoNotLeaveAClosedMesh) {
    setka::Queue queue = device().make_queue();
    for (const float offset : {0.0f, 1000.0f}) {
        const setka::Scene host_scene = support::ball(2000, {offset, -offset, offset});
        const oracle::World world = oracle::make_world(host_scene);
        auto rays = support::adversarial_rays(world, 64000, 45);
        const auto inner = [&](int axis) { return axis == 1 ? -offset : offset; };
        std::vector<setka::Ray> inside;
        for (setka::Ray ray : rays) {
            bool is_usable = true;
            float longest = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const float target = ray.origin[axis] + ray.direction[axis];
                ray.origin[axis] = inner(axis);
                ray.direction[axis] = target - ray.origin[axis];
                is_usable = is_usable && std::isfinite(ray.direction[axis]);
                longest = std::max(longest, std::fabs(ray.direction[axis]));
            }
            ray.tmin = 0;
            ray.tmax = std::numeric_limits<float>::infinity();
            if (is_usable && longest > 1e-3f && longest < 1e3f) inside.push_back(ray);
        }
        ASSERT_GT(inside.size(), 10000u);
        const setka::DeviceScene device_scene(queue, host_scene);
        for (const float density : {0.5f, 4.0f, 64.0f}) {
            const auto grid = setka::make_grid_builder({.density = density})->build(queue, device_scene);
            EXPECT_EQ(count_hits(setka::Tracer().closest_hit(queue, grid, inside)), inside.size());
        }
    }
}

TEST_P(Rays, CostsAreSane) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = support::ball(2000);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto rays = support::adversarial_rays(oracle::make_world(host_scene), 10000, 46);
    const auto device_rays = queue.upload(std::span(rays), "rays");
    const auto grid = setka::make_grid_builder({.density = 16})->build(queue, device_scene);
    const auto& dims = grid.header().dims;
    const std::uint32_t most_steps = dims[0] + dims[1] + dims[2];
    for (const auto step : steps) {
        const auto costs = queue.make_buffer<setka::TraceCost>(rays.size(), "costs");
        const setka::Tracer tracer({.step = step});
        tracer.closest_hit_cost(queue, grid, device_rays, costs);
        const auto hits = tracer.closest_hit(queue, grid, rays);
        const auto host_costs = queue.download(costs);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_LE(host_costs[i].steps, most_steps) << "ray " << i << ", " << name(step);
            if (hits[i].primitive != SETKA_NO_HIT) {
                ASSERT_GT(host_costs[i].steps, 0u) << "ray " << i;
                ASSERT_GT(host_costs[i].tests, 0u) << "ray " << i;
            }
        }
    }
}

/// Origins may be the largest floats: their working parameters are as large.
TEST_P(Rays, FromTheEndOfTheFloatsHit) {
    constexpr float farthest = std::numeric_limits<float>::max(),
                    infinity = std::numeric_limits<float>::infinity();
    std::vector<setka::Ray> rays;
    for (const float distance : {3.1e38f, 0x1.f4p+127f, farthest})
        for (const float speed : {1.0f, -1.0f, 0x1p96f, -0x1p118f, 0x1p-100f})
            for (unsigned corner = 1; corner < 27; ++corner) {
                setka::Ray ray{{0.01f, 0.02f, 0.03f}, -infinity, {0, 0, 0}, infinity};
                for (unsigned axis = 0, digits = corner; axis < 3; ++axis, digits /= 3) {
                    const float side = static_cast<float>(digits % 3) - 1;
                    if (side != 0) ray.origin[axis] = side * distance;
                    ray.direction[axis] = side * speed;
                }
                rays.push_back(ray);
            }
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = support::ball(200);
    const auto expected = oracle::closest_hits(oracle::make_world(host_scene), rays);
    EXPECT_GT(count_hits(expected), rays.size() / 2);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto brute = setka::BruteForce::build(queue, device_scene);
    EXPECT_TRUE(support::same_hits(rays, expected, setka::Tracer().closest_hit(queue, brute, rays)));
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    for (const auto step : steps) {
        SCOPED_TRACE(name(step));
        const setka::Tracer tracer({.step = step});
        EXPECT_TRUE(support::same_hits(rays, expected, tracer.closest_hit(queue, grid, rays)));
        EXPECT_TRUE(support::same_occlusion(rays, expected, tracer.any_hit(queue, grid, rays)));
    }
}

TEST_P(Rays, ShortOutputsAreRefused) {
    setka::Queue queue = device().make_queue();
    const setka::Scene host_scene = support::ball(200);
    const setka::DeviceScene device_scene(queue, host_scene);
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    const auto rays = queue.make_buffer<setka::Ray>(10, "rays");
    EXPECT_THROW(setka::Tracer().closest_hit(queue, grid, rays, queue.make_buffer<setka::Hit>(9, "hits")),
                 setka::Error);
    EXPECT_THROW(setka::Tracer().any_hit(queue, grid, rays, queue.make_buffer<std::uint32_t>(9, "flags")),
                 setka::Error);
}

}  // namespace
