// SPDX-License-Identifier: MIT
/// Do the other views show what they claim: normals, depth, and what the trace cost?
#include <algorithm>
#include <cmath>
#include <cstring>

#include "fixture.hpp"

namespace setka::render_test {
namespace {

TEST_F(Render, NormalsFaceTheViewer) {
    Scene scene = dark_scene();
    add(scene, quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), matte(black));
    scene.camera = look({0, 0, 0}, {0, 0, -1});
    const RenderOptions options{.width = 16, .height = 16, .view = View::Normals};
    EXPECT_EQ(render(scene, options).at(8, 8), (Float3{0.5f, 0.5f, 1}));
    EXPECT_EQ(render(scene, options).at(0, 0), black);
    scene.camera = look({0, 0, -4}, {0, 0, -1});
    EXPECT_EQ(render(scene, options).at(8, 8), (Float3{0.5f, 0.5f, 0}));
}

TEST_F(Render, NormalsSurviveUnevenScaling) {
    // A ball, four times as wide as high and turned by 30 degrees: an ellipsoid with known normals.
    Scene scene = dark_scene();
    add(scene, sphere({0, 0, 0}, 1, 96), matte(black));
    const float c = std::cos(0.5235988f), s = std::sin(0.5235988f);
    scene.instances[0].transform.rows = {4 * c, -s, 0, 0, 4 * s, c, 0, 0, 0, 0, 1, -10};
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 40);
    const Picture picture = render(scene, {.width = 65, .height = 65, .view = View::Normals});
    int compared = 0;
    for (std::uint32_t y = 0; y < 65; ++y) {
        for (std::uint32_t x = 0; x < 65; ++x) {
            // In the ball's space: the ray, the point, and the normal's image under the inverse transpose.
            const double tangent = std::tan(20 * 3.14159265358979 / 180);
            const double dx = ((x + 0.5) / 65 * 2 - 1) * tangent, dy = (1 - (y + 0.5) / 65 * 2) * tangent,
                         dz = -1;
            const double ox = 0, oy = 0, oz = 10;
            const double ex = (c * dx + s * dy) / 4, ey = -s * dx + c * dy, ez = dz;
            const double a = ex * ex + ey * ey + ez * ez, b = ox * ex + oy * ey + oz * ez, q = oz * oz - 1;
            if (b * b - a * q < 0.05 * b * b * 0.01) continue;
            const double t = (-b - std::sqrt(b * b - a * q)) / a;
            const double px = ex * t / 4, py = ey * t, pz = oz + ez * t;
            const double nx = c * px - s * py, ny = s * px + c * py, nz = pz;
            const double n = std::sqrt(nx * nx + ny * ny + nz * nz);
            if (nz / n < 0.3) continue;
            ++compared;
            ASSERT_TRUE(near(picture.at(x, y),
                             {static_cast<float>(nx / n / 2 + 0.5), static_cast<float>(ny / n / 2 + 0.5),
                              static_cast<float>(nz / n / 2 + 0.5)},
                             0.01f))
                << x << ", " << y;
        }
    }
    EXPECT_GT(compared, 200);
}

TEST_F(Render, DepthIsRelativeToTheFarthest) {
    Scene scene = dark_scene();
    add(scene, quad({-1, 0, -1}, {0.999f, 0, 0}, {0, 0.5f, 0}), matte(black));
    add(scene, quad({4, 0, -4}, {3.99f, 0, 0}, {0, 2, 0}), matte(black));
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 90);
    const Picture picture = render(scene, {.width = 65, .height = 65, .view = View::Depth});
    float darkest = 1;
    for (std::uint32_t y = 16; y < 49; ++y)
        for (std::uint32_t x = 33; x < 65; ++x) darkest = std::min(darkest, picture.at(x, y).x);
    EXPECT_NEAR(darkest, 0, 0.001f);
    // Across the middle a ray to the left meets the near quad at a quarter of the distance at which it meets
    // the far one.
    EXPECT_NEAR(1 - picture.at(16, 32).x, (1 - picture.at(48, 32).x) / 4, 1e-4f);
    EXPECT_EQ(picture.at(32, 0), black);
}

TEST_F(Render, HeatMapsShowWhatTracingCosts) {
    Scene scene = dark_scene();
    add(scene, sphere({0, 0, -3}, 1), matte(black));
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 60);
    Queue queue = device_->make_queue();
    const DeviceScene device_scene(queue, scene);
    const Grid grid = make_grid_builder()->build(queue, device_scene);
    const auto rays = camera_rays(queue, *scene.camera, 32, 32);
    const auto buffer = queue.make_buffer<TraceCost>(rays.size(), "costs");
    Tracer().closest_hit_cost(queue, grid, rays, buffer);
    const auto costs = queue.download(buffer);
    for (const View view : {View::Steps, View::Tests}) {
        Renderer renderer({.width = 32, .height = 32, .view = view});
        const Image image = renderer.render(queue, device_scene, grid, *scene.camera);
        const auto cost = [&](std::size_t i) {
            return view == View::Steps ? costs[i].steps : costs[i].tests;
        };
        std::uint32_t maximum = 0;
        double sum = 0;
        for (std::size_t i = 0; i < costs.size(); ++i) {
            maximum = std::max(maximum, cost(i));
            sum += cost(i);
        }
        ASSERT_GT(maximum, 0u);
        EXPECT_EQ(renderer.statistics().heat_maximum, maximum);
        EXPECT_DOUBLE_EQ(renderer.statistics().heat_mean, sum / 1024);
        // Hotter is lighter, and equal costs have equal colours.
        const auto luminance = [&](std::size_t i) {
            return 0.2126f * image.linear[i].x + 0.7152f * image.linear[i].y + 0.0722f * image.linear[i].z;
        };
        for (std::size_t i = 0; i + 1 < costs.size(); ++i) {
            if (cost(i) < cost(i + 1)) {
                ASSERT_LT(luminance(i), luminance(i + 1));
            }
            if (cost(i) == cost(i + 1)) {
                ASSERT_EQ(image.linear[i], image.linear[i + 1]);
            }
        }
    }
}

}  // namespace
}  // namespace setka::render_test
