// SPDX-License-Identifier: MIT
/// Is a loaded grid the one that was saved? Files, tables, digests, hits and pictures, on every device and
/// between devices, byte for byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "save/file_maker.hpp"
#include "setka/setka.hpp"
#include "support/compare.hpp"
#include "support/configurations.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"

namespace {

using namespace save_test;
using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;
using ::testing::HasSubstr;

AssertionResult same_files(const Bytes& expected, const Bytes& actual) {
    const auto [a, b] = std::ranges::mismatch(expected, actual);
    if (a == expected.end() && b == actual.end()) return AssertionSuccess();
    const auto at = static_cast<std::size_t>(a - expected.begin());
    std::string place = "header or table of sections";
    for (std::size_t i = 0; i < header_of(expected).section_count; ++i)
        if (at >= section_of(expected, i).offset)
            place = "section " + std::to_string(i) + " at byte " +
                    std::to_string(at - section_of(expected, i).offset);
    return AssertionFailure() << "files of " << expected.size() << " and " << actual.size()
                              << " bytes differ first at byte " << at << ": " << place;
}

std::vector<std::uint32_t> occlusion(setka::Queue& queue, const setka::Structure& structure,
                                     std::span<const setka::Ray> rays) {
    return setka::Tracer().any_hit(queue, structure, rays);
}

/// Hits of both steps, seen through a mask too, and occlusion.
AssertionResult same_answers(setka::Queue& queue_a, const setka::Structure& a, setka::Queue& queue_b,
                             const setka::Grid& b, std::span<const setka::Ray> rays) {
    for (const auto step : {setka::GridStep::Dda, setka::GridStep::BranchFree})
        for (const std::uint32_t mask : {0x7fffffffu, 2u, SETKA_MASK_OPAQUE}) {
            const setka::Tracer tracer({.step = step, .mask = mask});
            if (const auto same = support::same_hits(rays, tracer.closest_hit(queue_a, a, rays),
                                                     tracer.closest_hit(queue_b, b, rays));
                !same)
                return AssertionFailure() << same.message() << "\n  mask " << mask;
        }
    if (occlusion(queue_a, a, rays) != occlusion(queue_b, b, rays))
        return AssertionFailure() << "occlusion differs";
    return AssertionSuccess();
}

class RoundTrip : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(RoundTrip, support::names(support::all_scenes()));

TEST_P(RoundTrip, GivesTheSameGrid) {
    setka::Queue queue = device().make_queue();
    const setka::Scene scene = support::find_scene(other()).make();
    const auto rays = support::adversarial_rays(oracle::make_world(scene), 1500, 11);
    const setka::DeviceScene device_scene(queue, scene);
    const setka::BruteForce brute_force = setka::BruteForce::build(queue, device_scene);
    for (const float density : {0.5f, 8.0f}) {
        SCOPED_TRACE("density " + std::to_string(density));
        const setka::GridOptions options{.density = density};
        const setka::Grid grid = setka::make_grid_builder(options)->build(queue, device_scene);
        EXPECT_THAT(setka::validate(queue, grid), ::testing::IsEmpty());
        const Bytes file = setka::serialize(queue, grid);
        ASSERT_TRUE(same_files(file_of(model_of(scene, options)), file));

        const setka::Grid loaded = setka::deserialize_grid(queue, file);
        EXPECT_TRUE(support::same_tables(support::download(queue, grid), support::download(queue, loaded)));
        EXPECT_EQ(loaded.digest(queue), grid.digest(queue));
        EXPECT_EQ(setka::inspect(file).digest, grid.digest(queue));
        EXPECT_EQ(loaded.geometry().common_mask, device_scene.common_mask());
        EXPECT_EQ(loaded.size_bytes(), grid.size_bytes());
        EXPECT_TRUE(same_files(file, setka::serialize(queue, loaded)));
        EXPECT_TRUE(same_answers(queue, grid, queue, loaded, rays));
        EXPECT_TRUE(same_answers(queue, brute_force, queue, loaded, rays));
    }
}

/// Every configuration loads what every other one saved; one device has two of them.
TEST(BetweenDevices, GridsAreTheSame) {
    const auto configurations = support::configurations();
    if (configurations.empty()) {
        const support::NoDevice why = support::no_device();
        if (why.is_failure) FAIL() << why.message;
        GTEST_SKIP() << why.message;
    }
    for (const char* name : {"placed", "built_in_spheres", "single_point"}) {
        const setka::Scene scene = support::find_scene(name).make();
        const auto rays = support::adversarial_rays(oracle::make_world(scene), 1000, 12);
        for (const auto& from : configurations) {
            setka::Queue saver = support::open_once(from.device_id, from.options).make_queue();
            const setka::Grid grid =
                setka::make_grid_builder()->build(saver, setka::DeviceScene(saver, scene));
            const Bytes file = setka::serialize(saver, grid);
            for (const auto& to : configurations) {
                SCOPED_TRACE(std::string(name) + " from " + from.name + " to " + to.name);
                setka::Queue loader = support::open_once(to.device_id, to.options).make_queue();
                const setka::Grid loaded = setka::deserialize_grid(loader, file);
                EXPECT_EQ(loaded.digest(loader), grid.digest(saver));
                EXPECT_TRUE(same_answers(saver, grid, loader, loaded, rays));
            }
        }
    }
}

class Loading : public support::DeviceTest {
  protected:
    [[nodiscard]] static setka::Grid build(setka::Queue& queue, const setka::Scene& scene) {
        return setka::make_grid_builder()->build(queue, setka::DeviceScene(queue, scene));
    }
    /// The message of an error of this category; "no error" else.
    template <typename Action>
    [[nodiscard]] static std::string error(setka::ErrorCategory category, const Action& action) {
        try {
            action();
        } catch (const setka::Error& e) {
            EXPECT_EQ(e.category(), category) << e.what();
            return e.what();
        }
        return "no error";
    }
};
SETKA_ON_EVERY_DEVICE(Loading);

TEST_P(Loading, TakesBytesAtAnyAddress) {
    setka::Queue queue = device().make_queue();
    const Bytes file = file_of(model_of(small_scene()));
    for (std::size_t shift = 0; shift < 4; ++shift) {
        Bytes room(shift);
        room.insert(room.end(), file.begin(), file.end());
        const auto shifted = std::span<const std::byte>(room).subspan(shift);
        EXPECT_TRUE(same_files(file, setka::serialize(queue, setka::deserialize_grid(queue, shifted))));
        EXPECT_TRUE(setka::inspect(shifted).violations.empty());
    }
}

TEST_P(Loading, RefusesBeforeAnythingIsAllocated) {
    setka::Queue queue = device().make_queue();
    Model model = model_of(small_scene());
    model.references.back() = 4;
    model.instances[1].first_triangle = 1;
    queue.finish();
    const std::uint64_t held = device().memory_in_use_bytes();
    device().reset_peak_memory();
    const std::string why = error(setka::ErrorCategory::InvalidData,
                                  [&] { (void)setka::deserialize_grid(queue, file_of(model)); });
    EXPECT_THAT(
        why,
        HasSubstr("cannot load these bytes: instance 1: first_triangle is 1; its start is 2 (and 1 more)"));
    EXPECT_EQ(device().peak_memory_bytes(), held);

    Bytes newer = file_of(model_of(small_scene()));
    newer[8] = std::byte{2};
    EXPECT_THAT(
        error(setka::ErrorCategory::Unsupported, [&] { (void)setka::deserialize_grid(queue, newer); }),
        HasSubstr("version 2 of the file format"));
}

TEST_P(Loading, RefusesWhatTheBudgetDoesNotHold) {
    const Bytes file = file_of(model_of(support::find_scene("built_in_soup").make()));
    const setka::Device small = support::open_once(GetParam(), {.memory_budget_bytes = 100000});
    setka::Queue queue = small.make_queue();
    const std::uint64_t held = small.memory_in_use_bytes();
    EXPECT_THAT(error(setka::ErrorCategory::OutOfMemory, [&] { (void)setka::deserialize_grid(queue, file); }),
                HasSubstr("memory budget of 100000"));
    EXPECT_EQ(small.memory_in_use_bytes(), held);
}

TEST_P(Loading, RendersWithItsSceneAndNoOther) {
    setka::Queue queue = device().make_queue();
    const setka::Scene scene = support::framed(support::find_scene("placed").make());
    const setka::DeviceScene device_scene(queue, scene);
    const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
    const setka::Grid loaded = setka::deserialize_grid(queue, setka::serialize(queue, grid));
    setka::RenderOptions options;
    options.width = 64;
    options.height = 48;
    const auto picture = [&](const setka::DeviceScene& shown, const setka::Grid& structure) {
        return setka::Renderer(options).render(queue, shown, structure, *scene.camera);
    };
    EXPECT_TRUE(support::same_image(picture(device_scene, grid), picture(device_scene, loaded)));

    // As many triangles and instances, but two of different meshes exchanged.
    setka::Scene other = scene;
    std::swap(other.instances[1].mesh, other.instances[2].mesh);
    ASSERT_NE(scene.instances[1].mesh, scene.instances[2].mesh);
    ASSERT_EQ(other.triangle_count(), scene.triangle_count());
    const setka::DeviceScene other_scene(queue, other);
    EXPECT_THAT(error(setka::ErrorCategory::InvalidArgument, [&] { (void)picture(other_scene, loaded); }),
                HasSubstr("structure and scene part at instance 2,"));
}

/// A grid put together by hand from tables that do not fit each other is not written.
TEST_P(Loading, WhatWouldNotLoadIsNotSaved) {
    setka::Queue queue = device().make_queue();
    const setka::Grid sound = build(queue, small_scene());
    const auto remade = [&](setka::WorldGeometry geometry, SetkaGridHeader header) {
        return setka::Grid(queue, std::move(geometry), header, sound.tables(queue));
    };
    SetkaGridHeader header = sound.header();
    header.reference_count -= 1;
    const setka::Grid other_header = remade(sound.geometry(), header);
    EXPECT_THAT(setka::validate(queue, other_header), ::testing::ElementsAre(HasSubstr("references has")));
    EXPECT_THAT(
        error(setka::ErrorCategory::InvalidArgument, [&] { (void)setka::serialize(queue, other_header); }),
        HasSubstr("this grid would not load: references has"));
    setka::WorldGeometry geometry = sound.geometry();
    geometry.common_mask = 1;
    EXPECT_THAT(setka::validate(queue, remade(geometry, sound.header())),
                ::testing::ElementsAre(HasSubstr("common_mask is 1")));
    EXPECT_TRUE(setka::validate(queue, remade(sound.geometry(), sound.header())).empty());
}

}  // namespace
