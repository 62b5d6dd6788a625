// SPDX-License-Identifier: MIT
/// May two frames be in flight? Pictures that nobody waits for: what the host waits for on the way, whether edits of the next frame show in
/// the last, and what becomes of pictures that fail, are cancelled, or are left.
#include <gmock/gmock.h>

#include <cstring>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "faults/faulty_queue.hpp"
#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/handmade.hpp"
#include "support/scenes.hpp"
#include "support/sizes.hpp"

namespace {

using faults::Step;
using setka::Error;
using setka::ErrorCategory;
using setka::PendingImage;
using setka::Queue;

/// Some balls without mirrors or glass, each of which moves in each frame; one is squeezed.
setka::Scene balls() {
    setka::Scene scene = support::ball(support::sized(2000u, 100u));
    scene.materials.assign(1, setka::Material{});
    scene.instances.assign(5, {.mesh = 0, .transform = {}});
    setka::add_default_lights(scene, setka::frame(support::ball(8, {}, 4).bounds(), 1.5f));
    return scene;
}

const setka::Camera camera = setka::frame(support::ball(8, {}, 4).bounds(), 1.5f);

/// The loop of a renderer, on a queue that counts.
class Frames {
  public:
    explicit Frames(const setka::Device& device, const setka::RenderOptions& options = {.width = 60, .height = 40})
        : pair_(faults::make_faulty_queue(device)), scene_(pair_.queue, host_), renderer_(options) {}

    void edit(std::uint32_t frame) {
        for (std::uint32_t i = 0; i < 5; ++i) {
            const float s = 0.5f + 0.1f * float((frame + i) % 4);
            scene_.set_transform(i, {{s, 0, 0, float(i) - 2, 0, s, 0, 0.5f * float((frame * (i + 1)) % 5) - 1, 0, 0, s, 0}});
        }
        auto positions = host_.meshes[0].positions;
        for (setka::Float3& p : positions) p.z *= 0.4f + 0.2f * float(frame % 4);
        scene_.set_vertices(queue(), 0, positions);
        setka::Material material;
        material.diffuse = {0.2f * float(frame % 5), 0.5f, 0.9f};
        scene_.set_material(0, material);
        scene_.commit(queue());
    }
    [[nodiscard]] setka::Grid build() { return setka::make_grid_builder()->build(queue(), scene_); }
    /// The structure goes while its rays may still run.
    [[nodiscard]] PendingImage render_later(std::uint32_t frame) {
        edit(frame);
        return renderer_.render_later(queue(), scene_, build(), camera);
    }
    [[nodiscard]] setka::Image render(std::uint32_t frame) {
        edit(frame);
        return renderer_.render(queue(), scene_, build(), camera);
    }

    [[nodiscard]] Queue& queue() { return pair_.queue; }
    [[nodiscard]] faults::FaultyQueue& faults() { return *pair_.faults; }
    [[nodiscard]] setka::DeviceScene& scene() { return scene_; }
    [[nodiscard]] setka::Renderer& renderer() { return renderer_; }

  private:
    setka::Scene host_ = balls();
    faults::FaultyPair pair_;
    setka::DeviceScene scene_;
    setka::Renderer renderer_;
};

bool same_bits(const setka::Image& a, const setka::Image& b) {
    return a.srgb == b.srgb && a.linear.size() == b.linear.size() &&
           std::memcmp(a.linear.data(), b.linear.data(), a.linear.size() * sizeof(setka::Float3)) == 0;
}

bool same_numbers(const setka::RenderStatistics& a, const setka::RenderStatistics& b) {
    return a.primary_rays == b.primary_rays && a.secondary_rays == b.secondary_rays && a.shadow_rays == b.shadow_rays &&
           a.heat_maximum == b.heat_maximum && a.heat_mean == b.heat_mean;
}

class InFlight : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(InFlight);

TEST_P(InFlight, FramesWaitForTheBuildOnly) {
    Frames frames(device());
    const auto waits = [&](const auto& action) {
        const std::uint32_t before = frames.faults().waits();
        action();
        return frames.faults().waits() - before;
    };
    EXPECT_EQ(waits([&] { frames.edit(1); }), 0u);
    std::optional<setka::Grid> grid;
    const std::uint32_t of_a_build = waits([&] { grid = frames.build(); });
    EXPECT_GE(of_a_build, 1u);
    EXPECT_LE(of_a_build, 2u);
    PendingImage last;
    EXPECT_EQ(waits([&] { last = frames.renderer().render_later(frames.queue(), frames.scene(), *grid, camera); }), 0u);
    PendingImage next;
    for (std::uint32_t frame = 2; frame < 8; ++frame) {
        EXPECT_EQ(waits([&] { next = frames.render_later(frame); }), of_a_build) << frame;
        EXPECT_GT(waits([&] { (void)last.get(); }), 0u) << "waits are not counted";
        last = std::move(next);
    }
}

TEST_P(InFlight, PassesWaitForNothing) {
    Frames frames(device());
    frames.edit(1);
    const setka::Grid grid = frames.build();
    setka::ProgressiveRender picture(frames.queue(), frames.scene(), grid, camera,
                                     {.width = 30, .height = 20, .samples_per_axis = 3, .pixels = setka::Pixels::Srgb});
    std::vector<PendingImage> pictures;
    const std::uint32_t before = frames.faults().waits();
    while (picture.passes_done() < picture.passes()) {
        picture.add_pass();
        pictures.push_back(picture.image_later());
    }
    EXPECT_EQ(frames.faults().waits(), before);
    const setka::Image whole = picture.image();
    const setka::RenderStatistics statistics = picture.statistics();
    for (PendingImage& pending : pictures) {
        const std::uint64_t rays = std::uint64_t(30 * 20) * (&pending - pictures.data() + 1);
        EXPECT_EQ(pending.statistics().primary_rays, 0u);
        const setka::Image image = pending.get();
        EXPECT_TRUE(image.linear.empty());
        EXPECT_EQ(pending.statistics().primary_rays, rays);
        if (&pending == &pictures.back()) {
            EXPECT_EQ(image.srgb, whole.srgb);
            EXPECT_TRUE(same_numbers(pending.statistics(), statistics));
            EXPECT_GT(statistics.shadow_rays, 0u);
        } else {
            EXPECT_NE(image.srgb, whole.srgb);
            EXPECT_LT(pending.statistics().shadow_rays, statistics.shadow_rays);
        }
    }
    // The numbers of an image are in the next, too.
    (void)picture.image();
    EXPECT_TRUE(same_numbers(picture.statistics(), statistics));
}

class InFlightView : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(InFlightView, (std::vector<std::string>{"shaded", "normals", "depth", "steps", "mirrors"}));

TEST_P(InFlightView, EditsOfTheNextFrameDoNotShowInTheLast) {
    setka::RenderOptions options{.width = 60, .height = 40};
    options.view = other() == "normals" ? setka::View::Normals
                   : other() == "depth" ? setka::View::Depth
                   : other() == "steps" ? setka::View::Steps
                                        : setka::View::Shaded;
    Frames alone(device(), options), frames(device(), options);
    if (other() == "mirrors")
        for (Frames* each : {&alone, &frames}) {
            setka::Material mirror;
            mirror.reflectivity = 0.5f;
            each->scene().set_instance(1, {.mesh = 0, .transform = {}, .material = each->scene().add_material(mirror)});
        }
    std::vector<setka::Image> expected;
    std::vector<setka::RenderStatistics> statistics;
    for (std::uint32_t frame = 0; frame < 5; ++frame) {
        expected.push_back(alone.render(frame));
        statistics.push_back(alone.renderer().statistics());
    }
    EXPECT_FALSE(same_bits(expected[0], expected[1])) << "nothing moves";
    EXPECT_EQ(statistics[0].secondary_rays > 0, other() == "mirrors");

    PendingImage last;
    for (std::uint32_t frame = 0; frame <= 5; ++frame) {
        PendingImage next;
        if (frame < 5) next = frames.render_later(frame);
        if (frame == 4) frames.edit(77);
        if (frame > 0) {
            EXPECT_TRUE(same_bits(last.get(), expected[frame - 1])) << frame;
            EXPECT_TRUE(same_numbers(last.statistics(), statistics[frame - 1])) << frame;
        }
        last = std::move(next);
    }
}

TEST_P(InFlight, APictureOfSeveralBatches) {
    const setka::RenderOptions options{.width = 2048, .height = support::sized(1500u, 100u)};
    Frames frames(device(), options);
    const setka::Image expected = frames.render(1);
    PendingImage first = frames.render_later(1), second = frames.render_later(2);
    EXPECT_TRUE(same_bits(first.get(), expected));
    EXPECT_FALSE(same_bits(second.get(), expected));
}

TEST_P(InFlight, APictureIsFetchedOnce) {
    Frames frames(device());
    PendingImage picture = frames.render_later(1);
    (void)picture.get();
    EXPECT_TRUE(picture.is_ready());
    PendingImage of_nothing;
    for (PendingImage* none : {&picture, &of_nothing}) {
        try {
            (void)none->get();
            ADD_FAILURE() << "a picture was given away twice";
        } catch (const Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument);
            EXPECT_THAT(error.what(), ::testing::HasSubstr("fetched"));
        }
    }
}

TEST_P(InFlight, APictureMayBeLeftAndMayOutliveAll) {
    PendingImage picture;
    setka::Image expected;
    const setka::Device opened = device();
    const std::uint64_t held = opened.memory_in_use_bytes();
    {
        Frames frames(opened);
        expected = frames.render(2);
        for (std::uint32_t frame = 0; frame < 3; ++frame) (void)frames.render_later(frame);
        picture = frames.render_later(1);
        picture = frames.render_later(2);
    }
    EXPECT_EQ(opened.memory_in_use_bytes(), held);
    EXPECT_TRUE(same_bits(picture.get(), expected));
}

TEST_P(InFlight, AFailureOnTheWayShowsInItsPictureOnly) {
    Frames frames(device());
    const setka::Image expected = frames.render(2);
    for (std::uint32_t number = 1; number < 4; ++number) {  // pixels, codes, numbers of shadow rays
        PendingImage first = frames.render_later(1), second = frames.render_later(2);
        frames.faults().fail(Step::Arrive, number);
        try {
            (void)first.get();
            ADD_FAILURE() << "the failure was swallowed";
        } catch (const Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::DeviceFailed);
            EXPECT_THAT(error.what(), ::testing::HasSubstr("arrival of '" + frames.faults().failed_name() + "'"));
        }
        EXPECT_THROW((void)first.get(), Error) << "what failed has no picture";
        EXPECT_TRUE(same_bits(second.get(), expected));
        frames.faults().fail(Step::Read, number);
        EXPECT_THROW((void)frames.render_later(1).get(), Error);
        EXPECT_TRUE(same_bits(frames.render(2), expected));
    }
}

TEST_P(InFlight, AStopIsAskedForWhereWorkIsPutOnTheQueue) {
    Frames frames(device());
    const setka::Image expected = frames.render(1);
    PendingImage before = frames.render_later(1);
    auto indices = frames.queue().download_later(frames.scene().indices());
    std::stop_source stop;
    frames.queue().set_stop_token(stop.get_token());
    PendingImage stoppable;
    {
        const setka::Grid grid = frames.build();
        stoppable = frames.renderer().render_later(frames.queue(), frames.scene(), grid, camera);
        stop.request_stop();
        for (const auto& action : std::vector<std::function<void()>>{
                 [&] { (void)frames.renderer().render_later(frames.queue(), frames.scene(), grid, camera); },
                 [&] { (void)frames.queue().download_later(frames.scene().indices()); }}) {
            try {
                action();
                ADD_FAILURE() << "nothing was thrown";
            } catch (const Error& error) {
                EXPECT_EQ(error.category(), ErrorCategory::Cancelled);
            }
        }
    }
    // What is on its way arrives.
    EXPECT_TRUE(same_bits(before.get(), expected));
    EXPECT_TRUE(same_bits(stoppable.get(), expected));
    EXPECT_FALSE(indices.get().empty());
}

}  // namespace
