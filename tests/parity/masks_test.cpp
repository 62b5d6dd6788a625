// SPDX-License-Identifier: MIT
/// Do hits name the right instance and triangle, and does a mask hide exactly the instances that it should?
#include <gtest/gtest.h>

#include <algorithm>

#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"

namespace {

class Masks : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Masks);

TEST_P(Masks, HideInstances) {
    setka::Queue queue = device().make_queue();
    const setka::Scene scene = support::find_scene("placed").make();
    const oracle::World world = oracle::make_world(scene);
    const auto rays = support::adversarial_rays(world, 8000, 51);
    const setka::DeviceScene device_scene(queue, scene);
    const auto brute = setka::BruteForce::build(queue, device_scene);
    const auto coarse = setka::make_grid_builder({.density = 0.5f})->build(queue, device_scene);
    const auto fine = setka::make_grid_builder({.density = 16})->build(queue, device_scene);
    for (const std::uint32_t mask :
         {0u, 1u, 2u, 4u, 5u, 8u, 16u, SETKA_MASK_OPAQUE, ~SETKA_MASK_OPAQUE, ~0u}) {
        SCOPED_TRACE("mask " + std::to_string(mask));
        const auto expected = oracle::closest_hits(world, rays, mask);
        const auto hit = [](const setka::Hit& h) { return h.primitive != SETKA_NO_HIT; };
        EXPECT_EQ(std::any_of(expected.begin(), expected.end(), hit), mask != 0 && mask != 16);
        for (const setka::Structure* structure :
             {static_cast<const setka::Structure*>(&brute), static_cast<const setka::Structure*>(&coarse),
              static_cast<const setka::Structure*>(&fine)})
            for (const auto step : {setka::GridStep::Dda, setka::GridStep::BranchFree}) {
                const setka::Tracer tracer({.step = step, .mask = mask});
                EXPECT_TRUE(support::same_hits(rays, expected, tracer.closest_hit(queue, *structure, rays)));
                EXPECT_TRUE(support::same_occlusion(rays, expected, tracer.any_hit(queue, *structure, rays)));
            }
    }
}

/// A row of equal triangles, each an instance of one mesh with another one before it.
TEST_P(Masks, HitsNumberInstancesAndTheirTriangles) {
    setka::Queue queue = device().make_queue();
    setka::Scene scene =
        support::from_triangles({{setka::Float3{0, 0, 5}, setka::Float3{1, 0, 5}, setka::Float3{0, 1, 5}},
                                 {setka::Float3{0, 0, 0}, setka::Float3{1, 0, 0}, setka::Float3{0, 1, 0}}});
    scene.instances.clear();
    for (int k = 0; k < 20; ++k) {
        setka::Instance instance;
        instance.transform.rows[3] = static_cast<float>(2 * k);
        scene.instances.push_back(instance);
    }
    const setka::DeviceScene device_scene(queue, scene);
    const auto brute = setka::BruteForce::build(queue, device_scene);
    const auto grid = setka::make_grid_builder()->build(queue, device_scene);
    std::vector<setka::Ray> rays;
    for (int k = 0; k < 20; ++k)
        rays.push_back({{static_cast<float>(2 * k) + 0.25f, 0.5f, -1}, 0, {0, 0, 2}, 100});
    for (const setka::Structure* structure :
         {static_cast<const setka::Structure*>(&brute), static_cast<const setka::Structure*>(&grid)}) {
        const auto hits = setka::Tracer().closest_hit(queue, *structure, rays);
        for (std::uint32_t k = 0; k < 20; ++k) {
            EXPECT_EQ(hits[k].instance, k);
            EXPECT_EQ(hits[k].primitive, 1u);
            EXPECT_EQ(hits[k].t, 0.5f);
            EXPECT_EQ(hits[k].u, 0.25f);
            EXPECT_EQ(hits[k].v, 0.5f);
        }
    }
}

/// Equal triangles at equal distance: the lowest number wins.
TEST_P(Masks, TiesGoToTheFirst) {
    setka::Queue queue = device().make_queue();
    const support::Corners corners{setka::Float3{0, 0, 0}, setka::Float3{4, 0, 0}, setka::Float3{0, 4, 0}};
    std::vector<support::Corners> triangles(40, corners);
    for (std::size_t k = 20; k < 40; ++k) triangles[k] = {corners[1], corners[2], corners[0]};
    const setka::Scene scene = support::from_triangles(triangles);
    const setka::DeviceScene device_scene(queue, scene);
    const auto rays = support::adversarial_rays(oracle::make_world(scene), 4000, 52);
    const auto grid = setka::make_grid_builder({.density = 4})->build(queue, device_scene);
    for (const auto& hit : setka::Tracer().closest_hit(queue, grid, rays))
        EXPECT_TRUE(hit.primitive == SETKA_NO_HIT || hit.primitive == 0 || hit.primitive == 20)
            << hit.primitive;
}

}  // namespace
