// SPDX-License-Identifier: MIT
/// What is left of a scene on a device when a step of an edit fails? The scene as it was, or an edit that can be committed again.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "faults/faulty_queue.hpp"
#include "faults/work.hpp"
#include "setka/error.hpp"
#include "support/devices.hpp"

namespace {

using faults::Step;
using setka::DeviceScene;
using setka::Queue;

setka::Mesh some_mesh(float height) {
    setka::Mesh mesh;
    mesh.positions = {{0, height, 0}, {1, height, 0}, {0, height, 1}, {1, height, 1}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    mesh.normals.assign(4, {0, 1, 0});
    mesh.colors.assign(4, {1, 0, 0});
    return mesh;
}

struct Edit {
    const char* name;
    std::function<void(Queue&, DeviceScene&)> make;
};

const Edit edits[] = {
    {"add", [](Queue& queue, DeviceScene& scene) {
         const std::uint32_t mesh = scene.add_mesh(queue, some_mesh(2));
         (void)scene.add_instance({.mesh = mesh, .transform = {}});
     }},
    {"replace", [](Queue& queue, DeviceScene& scene) { scene.replace_mesh(queue, 0, some_mesh(3)); }},
    {"move", [](Queue&, DeviceScene& scene) { scene.set_transform(0, {{2, 0, 0, 1, 0, 2, 0, 0, 0, 0, 2, 0}}); }},
    {"remove", [](Queue&, DeviceScene& scene) { scene.remove_instance(0); }},
};

class FailingEdits : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(FailingEdits);

TEST_P(FailingEdits, LeaveTheSceneOrCanBeCommittedAgain) {
    faults::FaultyPair pair = faults::make_faulty_queue(device());
    Queue& queue = pair.queue;
    const setka::Scene start = faults::World(queue).scene;
    const auto builder = setka::make_grid_builder({.density = 2});
    const auto digest = [&](DeviceScene& scene) { return builder->build(queue, scene).digest(queue); };
    for (const Edit& edit : edits) {
        DeviceScene changed(queue, start);
        const setka::Digest before = digest(changed);
        edit.make(queue, changed);
        changed.commit(queue);
        const setka::Digest after = digest(changed);
        ASSERT_NE(before, after) << edit.name;
        std::uint32_t failures = 0;
        for (const Step step : faults::all_steps)
            for (std::uint32_t number = 1; number < 100; ++number) {
                SCOPED_TRACE(std::string(edit.name) + ", " + std::to_string(number) + "th " + to_string(step));
                DeviceScene scene(queue, start);
                std::optional<setka::Grid> shares_the_table;
                if (number % 2 == 0) shares_the_table = builder->build(queue, scene);
                bool is_made = false, is_committed = false;
                pair.faults->fail(step, number);
                try {
                    edit.make(queue, scene);
                    is_made = true;
                    scene.commit(queue);
                    is_committed = true;
                } catch (const setka::Error&) {
                }
                pair.faults->heal();
                if (!is_made) {
                    EXPECT_TRUE(scene.is_committed());
                    EXPECT_EQ(digest(scene), before);
                    edit.make(queue, scene);
                }
                EXPECT_EQ(scene.is_committed(), is_committed);
                scene.commit(queue);
                EXPECT_EQ(digest(scene), after);
                if (!pair.faults->has_failed()) break;
                ++failures;
            }
        EXPECT_GT(failures, 0u) << edit.name;
    }
}

/// Many instances of one mesh, side by side.
setka::Scene row(std::uint32_t count) {
    setka::Scene scene;
    scene.meshes.push_back(some_mesh(0));
    scene.materials.emplace_back();
    for (std::uint32_t i = 0; i < count; ++i) {
        setka::Instance instance;
        instance.transform.rows[3] = 2 * float(i);
        scene.instances.push_back(instance);
    }
    return scene;
}

setka::Matrix34 raised(setka::Matrix34 matrix) {
    matrix.rows[7] += 1;
    return matrix;
}

/// What a failed commit has written already is written again, even if the edit was taken back meanwhile.
TEST_P(FailingEdits, TakenBackAreWrittenAgain) {
    faults::FaultyPair pair = faults::make_faulty_queue(device());
    Queue& queue = pair.queue;
    setka::Scene host = row(100);
    DeviceScene scene(queue, host);
    for (const std::uint32_t i : {0u, 99u}) scene.set_transform(i, raised(host.instances[i].transform));
    pair.faults->fail(Step::Write, 2);
    EXPECT_THROW(scene.commit(queue), setka::Error);
    pair.faults->heal();
    scene.set_transform(0, host.instances[0].transform);
    scene.commit(queue);
    host.instances[99].transform = raised(host.instances[99].transform);
    const auto records = queue.download(scene.instances());
    for (std::size_t i = 0; i < records.size(); ++i)
        EXPECT_TRUE(std::ranges::equal(records[i].matrix, host.instances[i].transform.rows)) << i;
}

/// A vertex table grows by half where it can, and by what is needed where memory is short.
TEST_P(FailingEdits, GrowTablesByLessWhereMemoryIsShort) {
    faults::FaultyPair pair = faults::make_faulty_queue(device());
    Queue& queue = pair.queue;
    setka::Scene host = row(1);
    for (int i = 0; i < 10; ++i) host.meshes.push_back(some_mesh(1));
    DeviceScene roomy(queue, host), tight(queue, host);
    const std::uint64_t before = roomy.size_bytes();
    (void)roomy.add_mesh(queue, some_mesh(2));
    EXPECT_GT(roomy.size_bytes(), before * 5 / 4);
    pair.faults->fail(Step::Allocate, 1);
    (void)tight.add_mesh(queue, some_mesh(2));
    EXPECT_TRUE(pair.faults->has_failed());
    pair.faults->heal();
    EXPECT_LT(tight.size_bytes(), roomy.size_bytes());
    EXPECT_GT(tight.size_bytes(), before);
}

TEST_P(FailingEdits, SendOnlyWhatChanged) {
    faults::FaultyPair pair = faults::make_faulty_queue(device());
    Queue& queue = pair.queue;
    const setka::Scene host = row(1000);
    DeviceScene scene(queue, host);
    const auto sent = [&](const std::function<void()>& edit) {
        const std::uint64_t before = pair.faults->written_bytes();
        edit();
        scene.commit(queue);
        return pair.faults->written_bytes() - before;
    };
    const std::uint64_t record = sizeof(::SetkaInstance);
    const auto move = [&](std::uint32_t i) { scene.set_transform(i, raised(host.instances[i].transform)); };
    EXPECT_EQ(sent([&] { move(500); }), record);
    EXPECT_EQ(sent([&] { move(500); }), 0u) << "it is there already";
    EXPECT_EQ(sent([&] { move(10), move(12); }), 3 * record) << "what lies close together is one transfer";
    EXPECT_EQ(sent([&] { move(20), move(700); }), 2 * record);
    EXPECT_EQ(sent([&] { scene.set_vertices(queue, 0, host.meshes[0].positions); }), 48u);
    const auto grid = setka::make_grid_builder()->build(queue, scene);
    EXPECT_EQ(sent([&] { move(30); }), record) << "the table that the grid has is copied on the device";
    EXPECT_EQ(sent([&] { (void)scene.add_instance(host.instances[0]); }), record + 1002 * sizeof(std::uint32_t));
    EXPECT_EQ(sent([&] {}), 0u);
}

}  // namespace
