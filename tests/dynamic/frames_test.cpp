// SPDX-License-Identifier: MIT
/// What does frame after frame cost? No memory of the driver once the first are done, no growth, and the same bits as a single frame.
#include <gtest/gtest.h>

#include "dynamic/edited_scene.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"
#include "support/sizes.hpp"

namespace {

/// A ball that is squeezed, so that its tables have another size in each frame, among instances that move.
class Moving {
  public:
    explicit Moving(setka::Queue& queue) : queue_(queue), edited_(queue, start()) {}

    setka::DeviceScene& show(std::uint32_t frame) {
        const float phase = float(frame % 25) / 25;
        setka::Mesh mesh = ball_;
        for (setka::Float3& p : mesh.positions) {
            p.y *= 0.3f + phase * (1 - phase);
            p.x += 0.1f * phase * p.y;
        }
        edited_.set_vertices(0, mesh);
        support::Random random(frame % 25);
        for (std::uint32_t i = 1; i < 6; ++i) edited_.set_transform(i, dynamic::make_transform(random));
        edited_.device().commit(queue_);
        return edited_.device();
    }
    [[nodiscard]] setka::Scene fresh() const { return edited_.fresh(); }

  private:
    setka::Scene start() const {
        setka::Scene scene = dynamic::first_scene();
        setka::Scene with_ball;
        with_ball.meshes.push_back(ball_);
        with_ball.instances.push_back({.mesh = 0, .transform = {}});
        with_ball.materials.emplace_back();
        setka::append(with_ball, scene);
        setka::add_default_lights(with_ball, setka::frame(with_ball.bounds(), 1.5f));
        return with_ball;
    }

    setka::Mesh ball_ = support::ball(2000).meshes.front();
    setka::Queue& queue_;
    dynamic::EditedScene edited_;
};

class Frames : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Frames);

TEST_P(Frames, AskTheDriverForNoMemoryOnceWarm) {
    const setka::Device device = setka::Device::open(GetParam());
    setka::Queue queue = device.make_queue();
    Moving moving(queue);
    const auto builder = setka::make_grid_builder();
    setka::Renderer renderer({.width = 64, .height = 40});
    const setka::Camera camera = setka::frame(moving.fresh().bounds(), 1.5f);
    std::uint64_t warm_allocations = 0, warm_bytes = 0;
    const std::uint32_t frames = support::sized(1000, 60), warm = support::sized(50, 30);
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        {
            const setka::DeviceScene& scene = moving.show(frame);
            const setka::Grid grid = builder->build(queue, scene);
            (void)renderer.render(queue, scene, grid, camera);
        }
        if (frame + 1 == warm) {
            warm_allocations = device.driver_allocations();
            warm_bytes = device.memory_in_use_bytes();
            device.reset_peak_memory();
        }
    }
    EXPECT_GT(warm_allocations, 0u);
    EXPECT_EQ(device.driver_allocations(), warm_allocations);
    EXPECT_EQ(device.memory_in_use_bytes(), warm_bytes);
    // What is cached goes back on request, and is asked for again.
    device.trim();
    const setka::Grid grid = builder->build(queue, moving.show(3));
    EXPECT_GT(device.driver_allocations(), warm_allocations);
    const setka::DeviceScene fresh(queue, moving.fresh());
    EXPECT_EQ(grid.digest(queue), builder->build(queue, fresh).digest(queue));
}

TEST_P(Frames, GrowByNeed) {
    setka::Queue queue = device().make_queue();
    dynamic::EditedScene scene(queue, dynamic::first_scene());
    const auto builder = setka::make_grid_builder();
    for (std::uint32_t size : {100u, 1000u, 10u, 5000u, 1u}) {
        scene.replace_mesh(0, dynamic::make_mesh(size, size));
        scene.device().commit(queue);
        const setka::DeviceScene fresh(queue, scene.fresh());
        EXPECT_EQ(builder->build(queue, scene.device()).digest(queue), builder->build(queue, fresh).digest(queue)) << size;
    }
}

/// The next frame is edited and built while the hits of the last are still to be fetched.
TEST_P(Frames, MayBeInFlightTwoAtATime) {
    setka::Queue queue = device().make_queue();
    Moving moving(queue);
    const auto builder = setka::make_grid_builder();
    const setka::Tracer tracer;
    const auto rays = support::adversarial_rays(oracle::make_world(moving.fresh()), support::sized(5000, 200), 9);
    const auto on_device = queue.upload(std::span<const setka::Ray>(rays), "rays");
    std::vector<std::vector<setka::Hit>> alone;
    for (std::uint32_t frame = 0; frame < 6; ++frame)
        alone.push_back(tracer.closest_hit(queue, builder->build(queue, moving.show(frame)), rays));
    EXPECT_FALSE(support::same_hits(rays, alone[0], alone[1])) << "nothing moves";
    setka::Buffer<setka::Hit> last;
    for (std::uint32_t frame = 0; frame <= 6; ++frame) {
        setka::Buffer<setka::Hit> hits;
        if (frame < 6) {
            const setka::Grid grid = builder->build(queue, moving.show(frame));
            hits = queue.make_buffer<setka::Hit>(rays.size(), "hits");
            tracer.closest_hit(queue, grid, on_device, hits);
        }  // the grid goes while its rays may still run
        if (frame > 0) {
            EXPECT_TRUE(support::same_hits(rays, alone[frame - 1], queue.download(last))) << frame;
        }
        last = hits;
    }
}

}  // namespace
