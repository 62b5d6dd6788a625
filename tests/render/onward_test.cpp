// SPDX-License-Identifier: MIT
/// Where do mirror and refraction rays go, and what do they bring back?
#include <cmath>
#include <limits>

#include "fixture.hpp"

namespace setka::render_test {
namespace {

constexpr Float3 red{1, 0.125f, 0};

/// A mirror at 45 degrees before the camera, and a glowing wall to its right.
Scene mirror_and_wall() {
    Scene scene = dark_scene();
    add(scene, quad({0, 0, -3}, {1, 0, -1}, {0, 2, 0}), mirror());
    add(scene, quad({10, 0, -3}, {0, 0, -20}, {0, 20, 0}), glowing(red));
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 20);
    return scene;
}

TEST_F(Render, MirrorShowsWhatItReflects) {
    Scene scene = mirror_and_wall();
    const Picture picture = render(scene);
    for (const Float3& colour : picture.image.linear) ASSERT_EQ(colour, red);
    EXPECT_EQ(picture.statistics.secondary_rays, 64u * 64);

    // Turned the other way it shows the background.
    scene.meshes[0] = quad({0, 0, -3}, {-1, 0, -1}, {0, 2, 0});
    scene.background.zenith = scene.background.horizon = scene.background.ground = {0, 0, 0.5f};
    EXPECT_EQ(render(scene).at(20, 40), (Float3{0, 0, 0.5f}));
}

TEST_F(Render, MirrorAnglesAreEqual) {
    // Down to a mirror on the floor and up again to height 2 at a wall that glows above or below that height.
    for (const float shift : {-0.02f, 0.02f}) {
        Scene scene = dark_scene();
        add(scene, quad({0, 0, 0}, {0, 0, 3}, {3, 0, 0}), mirror());
        add(scene, quad({1, 4 + shift, 0}, {0, 2, 0}, {0, 0, 2}), glowing(red));
        scene.camera = look({-1, 2, 0}, {0, 0, 0}, 0.1f);
        const Float3 seen = render(scene, {.width = 1, .height = 1}).at(0, 0);
        EXPECT_EQ(seen, (shift < 0 ? red : black)) << shift;
    }
}

TEST_F(Render, MirrorColourFollowsSchlick) {
    Scene scene = mirror_and_wall();
    scene.materials[0].reflectivity = 0.5f;
    scene.materials[0].specular = {0.25f, 0.25f, 0.25f};
    const float grazing = std::pow(1 - std::sqrt(0.5f), 5.0f), share = 0.5f * (0.25f + 0.75f * grazing);
    EXPECT_TRUE(near(render(scene, {.width = 65, .height = 65}).at(32, 32), {share, share / 8, 0}, 1e-5f));
}

TEST_F(Render, DepthLimitsTheRecursion) {
    // Two facing mirrors, and a glow at the camera's height that each ray meets after three reflections or
    // not at all.
    Scene scene = mirror_and_wall();
    EXPECT_EQ(render(scene, {.width = 8, .height = 8, .max_depth = 0}).at(4, 4), black);
    EXPECT_EQ(render(scene, {.width = 8, .height = 8, .max_depth = 0}).statistics.secondary_rays, 0u);
    EXPECT_EQ(render(scene, {.width = 8, .height = 8, .max_depth = 1}).at(4, 4), red);

    Scene corridor = dark_scene();
    add(corridor, quad({0, 0, -3}, {2, 0, 0}, {0, 2, 0}), mirror());
    add(corridor, quad({0, 0, 3}, {2, 0, 0}, {0, 2, 0}), mirror());
    corridor.camera = look({0, 0, 0}, {0, 0, -1}, 1);
    for (const std::uint32_t depth : {1u, 5u, 16u})
        EXPECT_EQ(render(corridor, {.width = 8, .height = 8, .max_depth = depth}).statistics.secondary_rays,
                  64u * depth);
}

TEST_F(Render, FaintRaysArePruned) {
    Scene corridor = dark_scene();
    Material dim = mirror();
    dim.specular = {0.1f, 0.1f, 0.1f};
    add(corridor, quad({0, 0, -3}, {2, 0, 0}, {0, 2, 0}), dim);
    add(corridor, quad({0, 0, 3}, {2, 0, 0}, {0, 2, 0}), dim);
    corridor.camera = look({0, 0, 0}, {0, 0, -1}, 1);
    // 0.1 and 0.01 are above 1/256, 0.001 is below.
    EXPECT_EQ(render(corridor, {.width = 8, .height = 8, .max_depth = 16}).statistics.secondary_rays,
              64u * 2);
}

/// Coloured balls before a gradient, to be seen through something.
Scene view_through(std::optional<Mesh> pane, const Material& material) {
    Scene scene = dark_scene();
    scene.background = {{0.2f, 0.3f, 0.9f}, {0.8f, 0.8f, 0.8f}, {0.3f, 0.2f, 0.1f}, 0.4f};
    add(scene, sphere({-1, 0, -5}, 1), matte({0.9f, 0.2f, 0.1f}));
    add(scene, sphere({1.2f, 0.3f, -6}, 1.3f), matte({0.1f, 0.7f, 0.3f}));
    if (pane) add(scene, *pane, material);
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 50);
    return scene;
}

/// Pixels that differ by more than `tolerance`.
int differing(const Image& a, const Image& b, float tolerance) {
    int count = 0;
    for (std::size_t i = 0; i < a.linear.size(); ++i) count += !near(a.linear[i], b.linear[i], tolerance);
    return count;
}

TEST_F(Render, GlassOfIndexOneIsInvisible) {
    const Picture without = render(view_through(std::nullopt, {}));
    const Picture pane = render(view_through(quad({0, 0, -2}, {3, 1, 0}, {0, 3, 1}), glass(1)));
    EXPECT_LE(differing(pane.image, without.image, 1e-4f), 2);  // an outline may move by a rounding
    const Picture ball = render(view_through(sphere({0.2f, 0, -2.5f}, 0.9f), glass(1)));
    EXPECT_LE(differing(ball.image, without.image, 1e-4f), 2);
    EXPECT_GT(ball.statistics.secondary_rays, 1000u);
}

TEST_F(Render, PlateLetsThroughWhatFresnelLeaves) {
    // Straight through a plate of glass before a glow: the direct ray and the twice reflected one, in closed
    // form.
    Scene scene = dark_scene();
    add(scene, quad({0, 0, -10}, {9, 0, 0}, {0, 9, 0}), glowing({1, 1, 1}));
    add(scene, box({-2, -2, -3}, {2, 2, -2}), glass(1.5f));
    scene.materials[1].transmission = {1, 0.5f, 0.25f};
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 1);
    const Picture picture = render(scene, {.width = 3, .height = 3, .max_depth = 2});
    EXPECT_TRUE(near(picture.at(1, 1), {0.96f * 0.96f, 0.96f * 0.96f / 4, 0.96f * 0.96f / 16}, 1e-4f));
}

TEST_F(Render, RefractionFollowsSnell) {
    // A ray at 45 degrees into glass of index sqrt(2) goes on at 30 degrees. Under the surface lies a floor
    // that glows where x > tan(30 degrees) on its far half.
    const float x = std::tan(3.14159265f / 6);
    for (const float shift : {-0.02f, 0.02f}) {
        Scene scene = dark_scene();
        add(scene, box({-5, -3, -5}, {5, 0, 5}), glass(std::sqrt(2.0f)));
        add(scene, quad({2 + x + shift, -1, 0}, {0, 0, 2}, {2, 0, 0}), glowing(red));
        scene.camera = look({-1, 1, 0}, {0, 0, 0}, 0.1f);
        const Float3 seen = render(scene, {.width = 1, .height = 1}).at(0, 0);
        EXPECT_EQ(seen.x > 0.5f, shift < 0) << shift;
    }
}

TEST_F(Render, SteepLightStaysInsideGlass) {
    // From under water at 60 degrees the surface is a mirror: what glows above is not seen, what glows below
    // is.
    Scene scene = dark_scene();
    add(scene, box({-20, -10, -20}, {20, 0, 20}), glass(1.5f));
    add(scene, quad({0, 5, 0}, {0, 0, 100}, {100, 0, 0}), glowing({0, 1, 0}));
    add(scene, quad({0, -2, 0}, {0, 0, 15}, {15, 0, 0}), glowing(red));
    const float slope = std::sqrt(1.0f / 3);
    scene.camera = look({-1, -slope, 0}, {0, 0, 0}, 0.1f);
    EXPECT_TRUE(near(render(scene, {.width = 1, .height = 1}).at(0, 0), red, 1e-4f));
    // Straight up it is a window.
    scene.camera = look({0, -1, 0}, {0, 0, 0}, 0.1f, {0, 0, 1});
    EXPECT_GT(render(scene, {.width = 1, .height = 1}).at(0, 0).y, 0.9f);
}

TEST_F(Render, MirroredInstancesAreNotInsideOut) {
    Scene scene = view_through(sphere({0.2f, 0, -2.5f}, 0.9f), glass(1.5f));
    const Picture plain = render(scene, {.width = 96, .height = 96});
    // The same ball, mirrored in a plane through its centre; the facets are symmetrical.
    scene.instances.back().transform.rows = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0};
    const Picture mirrored = render(scene, {.width = 96, .height = 96});
    EXPECT_LE(differing(plain.image, mirrored.image, 0.05f), 96);
}

TEST_F(Render, LightBeyondFloatsLeavesNoNan) {
    // A red mirror looks straight at a wall of infinite brightness: green is 0 times infinity.
    Scene scene = dark_scene();
    add(scene, quad({0, 0, -3}, {2, 0, 0}, {0, 2, 0}), mirror());
    scene.materials.back().specular = {1, 0, 0};
    Material wall = glowing({3e38f, 3e38f, 3e38f});
    wall.diffuse = {1, 1, 1};
    add(scene, quad({0, 0, 3}, {2, 0, 0}, {0, 2, 0}), wall);
    scene.point_lights.push_back({{0, 0, 1}, {3e38f, 3e38f, 3e38f}, 0});
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 1);
    const Picture picture = render(scene, {.width = 3, .height = 3});
    EXPECT_EQ(picture.at(1, 1).x, std::numeric_limits<float>::infinity());
    EXPECT_EQ(picture.at(1, 1).y, 0);
    EXPECT_EQ(picture.image.srgb[3 * 4], 255);
    EXPECT_EQ(picture.image.srgb[3 * 4 + 1], 0);
}

TEST_F(Render, HalfTransparentSurfacesShowBoth) {
    Scene scene = dark_scene();
    add(scene, quad({0, 0, -4}, {9, 0, 0}, {0, 9, 0}), glowing({1, 0, 0}));
    Material veil = glass(1);
    veil.transparency = 0.75f;
    veil.diffuse = {0, 1, 0};
    add(scene, quad({0, 0, -2}, {2, 0, 0}, {0, 2, 0}), veil);
    scene.background = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, 1};
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 10);
    EXPECT_TRUE(near(render(scene).at(30, 30), {0.75f, 0.25f, 0}, 1e-5f));
}

}  // namespace
}  // namespace setka::render_test
