// SPDX-License-Identifier: MIT
/// Do pixels lie where the camera says, and do 8-bit codes say what the pixels are?
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/launch.hpp"
#include "fixture.hpp"
#include "trace/shading_tables.hpp"

namespace setka::render_test {
namespace {

TEST_F(Render, CameraRaysPassThroughSampleCentres) {
    Queue queue = device_->make_queue();
    const auto rays = queue.download(camera_rays(queue, look({1, 2, 3}, {1, 2, -4}), 6, 4, 2));
    ASSERT_EQ(rays.size(), 6u * 4 * 4);
    // 90 degrees: the picture reaches from -1 to 1 upwards, and from -1.5 to 1.5 sideways, at distance 1.
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        const std::uint32_t pixel = i / 4, column = 2 * (pixel % 6) + i % 2,
                            row = 2 * (pixel / 6) + (i % 4) / 2;
        const double x = ((column + 0.5) / 12 * 2 - 1) * 1.5, y = 1 - (row + 0.5) / 8 * 2;
        const double length = std::sqrt(x * x + y * y + 1);
        EXPECT_NEAR(rays[i].direction[0], x / length, 1e-6) << i;
        EXPECT_NEAR(rays[i].direction[1], y / length, 1e-6) << i;
        EXPECT_NEAR(rays[i].direction[2], -1 / length, 1e-6) << i;
        EXPECT_EQ(rays[i].origin[0], 1);
        EXPECT_EQ(rays[i].origin[1], 2);
        EXPECT_EQ(rays[i].origin[2], 3);
        EXPECT_EQ(rays[i].tmin, 0);
        EXPECT_EQ(rays[i].tmax, std::numeric_limits<float>::infinity());
    }
}

TEST_F(Render, CameraRaysRefuseWhatDoesNotFit) {
    Queue queue = device_->make_queue();
    const Camera camera = look({0, 0, 1}, {0, 0, 0});
    EXPECT_TRUE(
        fails_with(ErrorCategory::InvalidArgument, "width", [&] { (void)camera_rays(queue, camera, 0, 4); }));
    EXPECT_TRUE(fails_with(ErrorCategory::InvalidArgument, "rays",
                           [&] { (void)camera_rays(queue, camera, 16384, 16384, 16); }));
}

TEST_F(Render, OptionsOutOfRangeAreRefused) {
    const auto refuses = [](const RenderOptions& options, const char* name) {
        EXPECT_TRUE(fails_with(ErrorCategory::InvalidArgument, name, [&] { Renderer renderer(options); }));
    };
    refuses({.width = 0}, "width is 0");
    refuses({.width = 16385}, "width is 16385");
    refuses({.height = 0}, "height is 0");
    refuses({.height = 20000}, "16384");
    refuses({.samples_per_axis = 0}, "samples_per_axis");
    refuses({.samples_per_axis = 17}, "samples_per_axis");
    refuses({.max_depth = 17}, "max_depth");
    refuses({.view = static_cast<View>(5)}, "view");
    EXPECT_NO_THROW(Renderer({.width = 16384, .height = 1, .samples_per_axis = 16, .max_depth = 16}));
}

TEST_F(Render, DegenerateCamerasAreRefused) {
    Scene scene = dark_scene();
    add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), matte({1, 1, 1}));
    Queue queue = device_->make_queue();
    const DeviceScene device_scene(queue, scene);
    const BruteForce structure = BruteForce::build(queue, device_scene);
    Renderer renderer({.width = 4, .height = 4});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto refuses = [&](const Camera& camera, const char* name) {
        EXPECT_TRUE(fails_with(ErrorCategory::InvalidData, name,
                               [&] { (void)renderer.render(queue, device_scene, structure, camera); }));
    };
    refuses(look({1, 1, 1}, {1, 1, 1}), "eye and target");
    refuses(look({0, 2, 0}, {0, 0, 0}), "up");
    refuses(look({0, 0, 1}, {0, 0, 0}, 90, {0, 0, 0}), "up");
    refuses(look({0, 0, nan}, {0, 0, 0}), "finite");
    refuses(look({0, 0, 1}, {0, 0, 0}, 0), "vertical_fov_degrees");
    refuses(look({0, 0, 1}, {0, 0, 0}, 180), "vertical_fov_degrees");
    refuses(look({0, 0, 1}, {0, 0, 0}, nan), "vertical_fov_degrees");
    // And the renderer still works.
    EXPECT_EQ(renderer.render(queue, device_scene, structure, look({0, 0, 1}, {0, 0, 0})).linear.size(), 16u);
}

TEST_F(Render, AStructureOfAnotherSceneIsRefused) {
    Scene one = dark_scene(), other = dark_scene();
    add(one, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), matte({1, 1, 1}));
    add(other, box({0, 0, 0}, {1, 1, 1}), matte({1, 1, 1}));
    Queue queue = device_->make_queue();
    const DeviceScene scene(queue, one), other_scene(queue, other);
    const BruteForce structure = BruteForce::build(queue, other_scene);
    Renderer renderer({.width = 4, .height = 4});
    EXPECT_TRUE(fails_with(ErrorCategory::InvalidArgument, "structure", [&] {
        (void)renderer.render(queue, scene, structure, look({0, 0, 1}, {0, 0, 0}));
    }));
}

TEST_F(Render, AGlowingQuadFillsItsPixels) {
    // 2 x 1 at distance 2, seen under 90 degrees: the middle 32 x 16 of 64 x 64 pixels, moved right by 8 and
    // up by 4.
    Scene scene = dark_scene();
    add(scene, quad({0.5f, 0.25f, -2}, {1, 0, 0}, {0, 0.5f, 0}), glowing({1, 0.5f, 3}));
    scene.camera = look({0, 0, 0}, {0, 0, -1});
    const Picture picture = render(scene);
    for (std::uint32_t y = 0; y < 64; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            const bool inside = x >= 24 && x < 56 && y >= 20 && y < 36;
            ASSERT_EQ(picture.at(x, y), (inside ? Float3{1, 0.5f, 3} : black)) << x << ", " << y;
            const std::uint8_t* code = &picture.image.srgb[3 * (64 * y + x)];
            ASSERT_THAT(std::vector<int>(code, code + 3),
                        ::testing::ElementsAre(inside ? 255 : 0, inside ? 188 : 0, inside ? 255 : 0));
        }
    }
    EXPECT_EQ(picture.statistics.primary_rays, 64u * 64);
    EXPECT_EQ(picture.statistics.secondary_rays, 0u);
    EXPECT_EQ(picture.statistics.shadow_rays, 0u);
    EXPECT_GT(picture.statistics.wall_ms, 0);
}

TEST_F(Render, SamplesAreAveraged) {
    // The quad's edge divides the pixels of column 8 at a quarter.
    Scene scene = dark_scene();
    add(scene, quad({-1 + 1.0f / 64, 0, -1}, {1.0f + 1.0f / 64, 0, 0}, {0, 2, 0}), glowing({1, 1, 1}));
    scene.camera = look({0, 0, 0}, {0, 0, -1});
    const Picture picture = render(scene, {.width = 16, .height = 16, .samples_per_axis = 4});
    EXPECT_EQ(picture.at(7, 3), (Float3{1, 1, 1}));
    EXPECT_EQ(picture.at(8, 3), (Float3{0.25f, 0.25f, 0.25f}));
    EXPECT_EQ(picture.at(9, 3), black);
    EXPECT_EQ(picture.statistics.primary_rays, 16u * 16 * 16);
}

TEST_F(Render, TheBackgroundIsAGradient) {
    Scene scene = dark_scene();
    scene.background = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 0};
    add(scene, quad({0, 0, 100}, {0.1f, 0, 0}, {0, 0.1f, 0}), matte(black));
    scene.camera = look({0, 0, 0}, {0, 0, -1}, 170);
    const Picture picture = render(scene, {.width = 1, .height = 65});
    EXPECT_EQ(picture.at(0, 32), (Float3{0, 1, 0}));
    EXPECT_TRUE(near(picture.at(0, 0), {0, 0, 1}, 0.02f));
    EXPECT_TRUE(near(picture.at(0, 64), {1, 0, 0}, 0.02f));
    for (std::uint32_t y = 0; y < 32; ++y) EXPECT_LT(picture.at(0, y).y, picture.at(0, y + 1).y);
}

TEST_F(Render, CodesFollowTheSrgbCurve) {
    Queue queue = device_->make_queue();
    std::vector<float> linear = {0.0f,
                                 1.0f,
                                 -0.0f,
                                 -1.0f,
                                 2.0f,
                                 std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::infinity(),
                                 -std::numeric_limits<float>::infinity()};
    const std::size_t special = linear.size();
    for (int i = 0; i <= 100000; ++i) linear.push_back(static_cast<float>(i) / 100000);
    const auto& thresholds = srgb_thresholds();
    const auto values = queue.upload(std::span<const float>(linear), "values");
    const auto table = queue.upload(std::span<const float>(thresholds), "thresholds");
    const auto buffer = queue.make_buffer<std::uint8_t>(linear.size(), "codes");
    launch_items(queue, Kernel::shade_encode, static_cast<std::uint32_t>(linear.size()), values, table,
                 buffer);
    const auto codes = queue.download(buffer);
    EXPECT_THAT(std::vector<int>(codes.begin(), codes.begin() + special),
                ::testing::ElementsAre(0, 255, 0, 0, 255, 0, 255, 0));
    int different = 0;
    for (std::size_t i = special; i < linear.size(); ++i) {
        const double v = linear[i];
        const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
        const int expected = static_cast<int>(encoded * 255 + 0.5);
        ASSERT_NEAR(codes[i], expected, 1) << v;
        different += codes[i] != expected;
    }
    EXPECT_LT(different, 5);
}

TEST_F(Render, ProgressRisesToOne) {
    Scene scene = dark_scene();
    add(scene, quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), glowing({1, 1, 1}));
    scene.camera = look({0, 0, 0}, {0, 0, -1});
    std::vector<double> shares;
    RenderOptions options{.width = 96, .height = 96, .samples_per_axis = 16};
    options.progress = [&](double share) { shares.push_back(share); };
    (void)render(scene, options);
    ASSERT_GE(shares.size(), 2u);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1.0);
}

}  // namespace
}  // namespace setka::render_test
