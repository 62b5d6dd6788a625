// SPDX-License-Identifier: MIT
/// Does work end when a stop is requested? At every launch of every piece of work, at every step of a
/// render's progress, from another thread: soon, with Cancelled, with every byte given back, and with a queue
/// that works again.
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include "faults/faulty_queue.hpp"
#include "faults/work.hpp"
#include "setka/scenes.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"

namespace {

using faults::Step;
using faults::World;
using setka::ErrorCategory;
using setka::Queue;

/// What `call` throws.
template <typename Call>
std::optional<setka::Error> error_of(Call&& call) {
    try {
        call();
    } catch (const setka::Error& error) {
        return error;
    }
    return std::nullopt;
}

class CancelAt : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(CancelAt, faults::work_names());

TEST_P(CancelAt, EveryLaunch) {
    const setka::Device opened = device();
    const auto [steps, made] = faults::make_faulty_queue(opened);
    Queue queue = made;
    const World world(queue);
    const faults::Work& work = faults::find_work(other());
    const std::string expected = work.run(queue, world);
    const std::uint64_t held_bytes = opened.memory_in_use_bytes();
    // The last step before which something is still to come is a read.
    for (const Step step : {Step::Allocate, Step::Launch, Step::Read})
        for (std::uint32_t number = 1;; ++number) {
            ASSERT_LT(number, 5000u);
            SCOPED_TRACE(std::string(to_string(step)) + " " + std::to_string(number));
            std::stop_source stop;
            queue.set_stop_token(stop.get_token());
            std::uint32_t launches_before = 0;
            steps->before(step, number, [&] {
                launches_before = steps->launches();
                stop.request_stop();
            });
            std::string result;
            const auto error = error_of([&] { result = work.run(queue, world); });
            steps->heal();
            EXPECT_EQ(opened.memory_in_use_bytes(), held_bytes);
            EXPECT_TRUE(steps->is_idle()) << "a kernel is left on the queue";
            queue.set_stop_token({});
            if (!steps->has_failed()) {
                EXPECT_FALSE(error) << error->what();
                EXPECT_TRUE(result == expected) << "another result where a stop can be requested";
                break;
            }
            if (error) {
                EXPECT_EQ(error->category(), ErrorCategory::Cancelled) << error->what();
                EXPECT_THAT(error->what(), ::testing::HasSubstr("cancelled before "));
            } else {
                EXPECT_EQ(step, Step::Read) << "the stop was ignored";
                EXPECT_TRUE(result == expected);
            }
            EXPECT_LE(steps->launches(), launches_before + 1) << "more than the launch at hand was done";
            EXPECT_TRUE(work.run(queue, world) == expected) << "another result after the stop";
            if (HasFailure()) return;
        }
}

class Cancel : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Cancel);

TEST_P(Cancel, AStopThatWasRequestedBeforeLetsNothingStart) {
    const setka::Device opened = device();
    Queue queue = opened.make_queue();
    const setka::DeviceScene scene(queue, support::ball(500));
    std::stop_source stop;
    stop.request_stop();
    queue.set_stop_token(stop.get_token());
    EXPECT_TRUE(queue.stop_token().stop_requested());
    const std::uint64_t before = opened.memory_in_use_bytes();
    const auto error = error_of([&] { (void)setka::make_grid_builder()->build(queue, scene); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->category(), ErrorCategory::Cancelled);
    EXPECT_STREQ(error->what(), "cancelled before allocating 'world triangles'");
    EXPECT_EQ(opened.memory_in_use_bytes(), before);
    queue.finish();  // waiting is no work
    (void)queue.take_timings();
    queue.set_stop_token({});
    EXPECT_GT(setka::make_grid_builder()->build(queue, scene).header().reference_count, 0u);
}

TEST_P(Cancel, CopiesOfAQueueShareItsToken) {
    Queue queue = device().make_queue(), copy = queue, other = device().make_queue();
    std::stop_source stop;
    queue.set_stop_token(stop.get_token());
    stop.request_stop();
    EXPECT_TRUE(error_of([&] { (void)copy.make_buffer<int>(1, "of the copy"); }));
    EXPECT_FALSE(error_of([&] { (void)other.make_buffer<int>(1, "of another queue"); }));
}

TEST_P(Cancel, AtEveryStepOfARendersProgress) {
    // So little memory that there are several batches.
    const setka::Device opened = setka::Device::open(GetParam(), {.memory_budget_bytes = 1 << 19});
    Queue queue = opened.make_queue();
    const setka::Scene scene = support::mirror_and_glass();
    const setka::DeviceScene device_scene(queue, scene);
    const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
    setka::RenderOptions options;
    options.width = 96;
    options.height = 64;
    std::uint32_t steps = 0;
    const auto render = [&] {
        (void)setka::Renderer(options).render(queue, device_scene, grid, *scene.camera);
    };
    options.progress = [&](double) { ++steps; };
    render();
    ASSERT_GT(steps, 3u) << "too few batches to stop between";
    const std::uint64_t held_bytes = opened.memory_in_use_bytes();
    for (std::uint32_t stop_at = 1; stop_at < steps; ++stop_at) {
        std::stop_source stop;
        queue.set_stop_token(stop.get_token());
        std::uint32_t calls = 0;
        options.progress = [&](double) {
            if (++calls == stop_at) stop.request_stop();
        };
        const auto error = error_of(render);
        queue.set_stop_token({});
        ASSERT_TRUE(error) << stop_at;
        EXPECT_EQ(error->category(), ErrorCategory::Cancelled);
        EXPECT_EQ(calls, stop_at) << "another batch was done";
        EXPECT_EQ(opened.memory_in_use_bytes(), held_bytes);
    }
    std::uint32_t calls = 0;
    options.progress = [&](double) { ++calls; };
    render();
    EXPECT_EQ(calls, steps);
}

/// Asks for a stop after `delay` from another thread; how long `work` goes on after that, in seconds.
template <typename Call>
double stopped_after_s(Queue& queue, std::chrono::milliseconds delay, const Call& work) {
    std::stop_source stop;
    queue.set_stop_token(stop.get_token());
    std::chrono::steady_clock::time_point asked;
    std::jthread other([&] {
        std::this_thread::sleep_for(delay);
        asked = std::chrono::steady_clock::now();
        stop.request_stop();
    });
    const auto error = error_of(work);
    const auto ended = std::chrono::steady_clock::now();
    other.join();
    queue.set_stop_token({});
    EXPECT_TRUE(error) << "the work was over before it was to stop";
    if (error) {
        EXPECT_EQ(error->category(), ErrorCategory::Cancelled) << error->what();
        std::printf("%s; ", error->what());
    }
    return std::chrono::duration<double>(ended - asked).count();
}

/// For machines that do a lot else; a launch takes a fraction of a second.
constexpr double bound_s = 10;

TEST_P(Cancel, ALongRenderFromAnotherThread) {
    const setka::Device opened = device();
    Queue queue = opened.make_queue();
    const setka::Scene scene = support::mirror_and_glass();
    const setka::DeviceScene device_scene(queue, scene);
    const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
    const std::uint64_t held_bytes = opened.memory_in_use_bytes();
    setka::RenderOptions options;
    options.width = options.height = 4096;
    options.samples_per_axis = 16;
    setka::Renderer renderer(options);
    const double waited_s = stopped_after_s(queue, std::chrono::milliseconds(300), [&] {
        (void)renderer.render(queue, device_scene, grid, *scene.camera);
    });
    std::printf("the render ended %.3f s after the request\n", waited_s);
    EXPECT_LT(waited_s, bound_s);
    EXPECT_EQ(opened.memory_in_use_bytes(), held_bytes);
}

/// One call of the user's, and hours of work.
TEST_P(Cancel, OneLongTraceByBruteForceFromAnotherThread) {
    const setka::Device opened = device();
    Queue queue = opened.make_queue();
    const setka::Scene scene = setka::make_scene("soup", 1000000);
    const setka::DeviceScene device_scene(queue, scene);
    const setka::BruteForce structure = setka::BruteForce::build(queue, device_scene);
    const setka::Camera camera = setka::frame(scene.bounds(), 1);
    const auto rays = setka::camera_rays(queue, camera, 4096, 4096);
    const auto occluded = queue.make_buffer<setka::Hit>(rays.size(), "hits");
    const std::uint64_t held_bytes = opened.memory_in_use_bytes();
    const double waited_s = stopped_after_s(queue, std::chrono::milliseconds(200), [&] {
        setka::Tracer().closest_hit(queue, structure, rays, occluded);
        queue.finish();
        (void)queue.download(occluded);
    });
    std::printf("the trace ended %.3f s after the request\n", waited_s);
    EXPECT_LT(waited_s, bound_s);
    EXPECT_EQ(opened.memory_in_use_bytes(), held_bytes);
}

/// Twenty billion pairs to count, of which no build would come.
TEST_P(Cancel, ALongPlanFromAnotherThread) {
    const setka::Device opened = device();
    if (opened.info().type != setka::DeviceType::Cpu)
        GTEST_SKIP() << "a GPU has counted enough to refuse before it is asked to stop";
    Queue queue = opened.make_queue();
    setka::Scene scene = support::from_triangles(
        {{setka::Float3{0, 0, 0}, setka::Float3{1, 1, 0.5f}, setka::Float3{0, 1, 1}}});
    scene.instances.resize(60000, scene.instances.front());
    const setka::DeviceScene device_scene(queue, scene);
    const std::uint64_t held_bytes = opened.memory_in_use_bytes();
    const auto builder = setka::make_grid_builder({.density = 1e4f, .max_cells_per_axis = 512});
    const double waited_s = stopped_after_s(queue, std::chrono::milliseconds(2000),
                                            [&] { (void)builder->plan(queue, device_scene); });
    std::printf("the plan ended %.3f s after the request\n", waited_s);
    EXPECT_LT(waited_s, bound_s);
    EXPECT_EQ(opened.memory_in_use_bytes(), held_bytes);
}

}  // namespace
