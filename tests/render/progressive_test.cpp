// SPDX-License-Identifier: MIT
/// Is a picture that grows pass by pass a picture after each, the mean of the samples that are there, and in
/// the end the very picture that is rendered in one call?
#include <algorithm>
#include <cstring>
#include <stop_token>

#include "fixture.hpp"

namespace setka::render_test {
namespace {

/// Mirrors, glass and a shadow, so that every kind of ray takes part.
Scene lively_scene() {
    Scene scene = dark_scene();
    scene.background = {{0.1f, 0.2f, 0.5f}, {0.8f, 0.8f, 0.9f}, {0.3f, 0.2f, 0.1f}, 0.4f};
    Material mirror = matte({0.2f, 0.2f, 0.2f}), glass = matte({0.1f, 0.1f, 0.1f});
    mirror.reflectivity = 1;
    mirror.specular = {0.8f, 0.7f, 0.6f};
    glass.transparency = 0.9f;
    add(scene, quad({0, -1, 0}, {4, 0, 0}, {0, 0, -4}), matte({0.6f, 0.5f, 0.4f}));
    add(scene, sphere({-1, 0, 0}, 1, 24), mirror);
    add(scene, box({0.3f, -0.9f, 0}, {1.3f, 0.6f, 1}), glass);
    scene.point_lights.push_back({{2, 4, 3}, {1, 1, 0.9f}, 0});
    scene.camera = look({0.5f, 1, 5}, {0, -0.2f, 0}, 50);
    return scene;
}

/// A scene with its structure, and a queue of its own.
struct World {
    World(const Device& device, const Scene& host)
        : queue(device.make_queue()),
          scene(queue, host),
          grid(make_grid_builder({.density = 2})->build(queue, scene)),
          camera(*host.camera) {}

    [[nodiscard]] ProgressiveRender begin(const RenderOptions& options) {
        return {queue, scene, grid, camera, options};
    }
    [[nodiscard]] Image whole(const RenderOptions& options) {
        return Renderer(options).render(queue, scene, grid, camera);
    }

    Queue queue;
    DeviceScene scene;
    Grid grid;
    Camera camera;
};

::testing::AssertionResult same_bits(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.linear.size() != b.linear.size() ||
        a.srgb.size() != b.srgb.size())
        return ::testing::AssertionFailure() << "sizes differ";
    for (std::size_t i = 0; i < a.linear.size(); ++i)
        if (std::memcmp(&a.linear[i], &b.linear[i], sizeof(Float3)) != 0)
            return ::testing::AssertionFailure()
                   << "pixel " << i << " differs: " << a.linear[i].x << " and " << b.linear[i].x;
    for (std::size_t i = 0; i < a.srgb.size(); ++i)
        if (a.srgb[i] != b.srgb[i]) return ::testing::AssertionFailure() << "code " << i << " differs";
    return ::testing::AssertionSuccess();
}

constexpr View views[] = {View::Shaded, View::Normals, View::Depth, View::Steps, View::Tests};

TEST_F(Render, PassesEndInThePictureOfOneCall) {
    World world(*device_, lively_scene());
    for (const View view : views) {
        SCOPED_TRACE(static_cast<int>(view));
        const RenderOptions options{.width = 60, .height = 45, .samples_per_axis = 3, .view = view};
        ProgressiveRender picture = world.begin(options);
        EXPECT_EQ(picture.passes(), 9u);
        for (std::uint32_t pass = 1; pass <= 9; ++pass) {
            picture.add_pass();
            EXPECT_EQ(picture.passes_done(), pass);
        }
        Renderer renderer(options);
        const Image whole = renderer.render(world.queue, world.scene, world.grid, world.camera);
        EXPECT_TRUE(same_bits(picture.image(), whole));
        EXPECT_EQ(picture.statistics().primary_rays, 60u * 45 * 9);
        EXPECT_EQ(picture.statistics().secondary_rays, renderer.statistics().secondary_rays);
        EXPECT_EQ(picture.statistics().shadow_rays, renderer.statistics().shadow_rays);
        EXPECT_EQ(picture.statistics().heat_maximum, renderer.statistics().heat_maximum);
        EXPECT_EQ(picture.statistics().shadow_rays > 0, view == View::Shaded);
        picture.add_pass();  // there are no more
        EXPECT_EQ(picture.passes_done(), 9u);
        EXPECT_TRUE(same_bits(picture.image(), whole));
    }
}

/// Samples and pixels of a 2 x 2 grid are the pixels of a picture of twice the size, whose camera rays have
/// the same bits.
TEST_F(Render, APictureIsTheMeanOfItsPasses) {
    World world(*device_, lively_scene());
    const Image fine = world.whole({.width = 64, .height = 48});
    ProgressiveRender picture = world.begin({.width = 32, .height = 24, .samples_per_axis = 2});
    for (std::uint32_t pass = 1; pass <= 4; ++pass) {
        picture.add_pass();
        const Image mean = picture.image();
        ASSERT_EQ(mean.linear.size(), 32u * 24);
        for (std::uint32_t i = 0; i < mean.linear.size(); ++i) {
            const std::uint32_t x = 2 * (i % 32), y = 2 * (i / 32);
            Float3 sum;
            for (std::uint32_t k = 0; k < pass; ++k) {
                const Float3& sample = fine.linear[(y + k / 2) * 64 + x + k % 2];
                sum = {sum.x + sample.x, sum.y + sample.y, sum.z + sample.z};
            }
            const auto n = static_cast<float>(pass);
            ASSERT_EQ(mean.linear[i], (Float3{sum.x / n, sum.y / n, sum.z / n}))
                << "pixel " << i << ", pass " << pass;
        }
        EXPECT_EQ(picture.statistics().primary_rays, 32u * 24 * pass);
    }
}

TEST_F(Render, PassesAndTheRestMayBeMixed) {
    World world(*device_, lively_scene());
    const RenderOptions options{.width = 40, .height = 30, .samples_per_axis = 3};
    ProgressiveRender picture = world.begin(options);
    picture.add_pass();
    picture.add_pass();
    (void)picture.image();
    picture.finish();
    EXPECT_EQ(picture.passes_done(), 9u);
    EXPECT_TRUE(same_bits(picture.image(), world.whole(options)));
}

TEST_F(Render, ARestartShowsTheNewCamera) {
    World world(*device_, lively_scene());
    const RenderOptions options{.width = 40, .height = 30, .samples_per_axis = 2};
    ProgressiveRender picture = world.begin(options);
    picture.add_pass();
    picture.add_pass();
    world.camera.eye.x += 1;
    picture.restart(world.camera);
    EXPECT_EQ(picture.passes_done(), 0u);
    EXPECT_TRUE(fails_with(ErrorCategory::InvalidArgument, "0 passes", [&] { (void)picture.image(); }));
    picture.finish();
    EXPECT_TRUE(same_bits(picture.image(), world.whole(options)));
    EXPECT_EQ(picture.statistics().primary_rays, 40u * 30 * 4);
    world.camera.target = world.camera.eye;
    EXPECT_TRUE(
        fails_with(ErrorCategory::InvalidData, "eye and target", [&] { picture.restart(world.camera); }));
}

TEST_F(Render, ACancelledPassLeavesThePictureBeforeIt) {
    Scene scene = dark_scene();
    add(scene, quad({0, 0, -2}, {1, 0.1f, 0}, {0.2f, 1, 0}), glowing({1, 0.5f, 3}));
    scene.camera = look({0, 0, 0}, {0, 0, -1});
    World world(*device_, scene);
    RenderOptions options{.width = 1500, .height = 1500, .samples_per_axis = 2, .max_depth = 0};
    std::stop_source stop;
    int batches = 0;
    // 1500 x 1500 pixels are two batches: the stop comes in the middle of the second pass.
    options.progress = [&](double) {
        if (++batches == 3) stop.request_stop();
    };
    ProgressiveRender picture = world.begin(options);
    world.queue.set_stop_token(stop.get_token());
    picture.add_pass();
    ASSERT_EQ(batches, 2);
    const Image before = picture.image();
    EXPECT_TRUE(fails_with(ErrorCategory::Cancelled, "", [&] { picture.add_pass(); }));
    EXPECT_EQ(picture.passes_done(), 1u);
    EXPECT_TRUE(fails_with(ErrorCategory::Cancelled, "", [&] { (void)picture.image(); }));
    world.queue.set_stop_token({});
    EXPECT_TRUE(same_bits(picture.image(), before));
    picture.finish();
    options.progress = {};
    EXPECT_TRUE(same_bits(picture.image(), world.whole(options)));
}

/// Where a whole picture of sums would take too much of the memory, they lie on the host and come piece by
/// piece.
TEST_F(Render, SumsThatDoNotFitTheDeviceStayOnTheHost) {
    const RenderOptions options{.width = 200, .height = 150, .samples_per_axis = 2};
    for (const View view : views) {
        SCOPED_TRACE(static_cast<int>(view));
        RenderOptions shown = options;
        shown.view = view;
        World world(*device_, lively_scene());
        const Image expected = world.whole(shown);
        const std::uint64_t scene_bytes = device_->memory_in_use_bytes();
        const Device small =
            Device::open(device_->info().id, {.memory_budget_bytes = scene_bytes + (256u << 10)});
        World tight(small, lively_scene());
        ProgressiveRender picture = tight.begin(shown);
        small.reset_peak_memory();
        for (int pass = 0; pass < 2; ++pass) picture.add_pass();
        // A table of sums on the device would still be there now; the host's are not.
        EXPECT_LT(small.memory_in_use_bytes(), scene_bytes + (64u << 10));
        picture.finish();
        EXPECT_TRUE(same_bits(picture.image(), expected));
        EXPECT_LE(small.peak_memory_bytes(), scene_bytes + (256u << 10));
    }
}

TEST_F(Render, LinearPixelsMayBeLeftOut) {
    World world(*device_, lively_scene());
    for (const View view : views) {
        RenderOptions options{.width = 40, .height = 30, .view = view};
        const Image both = world.whole(options);
        options.pixels = Pixels::Srgb;
        const Image codes = world.whole(options);
        EXPECT_EQ(codes.linear.size(), 0u);
        EXPECT_EQ(codes.srgb, both.srgb);
    }
    EXPECT_TRUE(fails_with(ErrorCategory::InvalidArgument, "pixels is 2",
                           [&] { Renderer renderer({.pixels = static_cast<Pixels>(2)}); }));
}

}  // namespace
}  // namespace setka::render_test
