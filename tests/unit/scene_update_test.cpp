// SPDX-License-Identifier: MIT
/// Does a scene move as it is told, and not at all where it is told nonsense?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "setka/error.hpp"
#include "setka/scene.hpp"
#include "setka/scenes.hpp"

namespace setka {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Two instances of a triangle with normals.
Scene make_two() {
    Scene scene;
    scene.meshes.push_back(
        {"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, std::vector<Float3>(3, {0, 0, 1}), {}});
    scene.instances.resize(2);
    scene.materials.resize(1);
    return scene;
}

SceneUpdate make_update() {
    SceneUpdate update;
    update.placements.push_back({1, {{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7}}});
    update.vertices.push_back({0, {{0, 0, 1}, {1, 0, 1}, {0, 1, 2}}, std::vector<Float3>(3, {0, 1, 0})});
    update.camera = Camera{{9, 9, 9}};
    return update;
}

TEST(SceneUpdate, MovesPlacementsVerticesAndCamera) {
    Scene scene = make_two();
    const SceneUpdate update = make_update();
    apply(scene, update);
    EXPECT_EQ(scene.instances[0].transform, Matrix34{});
    EXPECT_EQ(scene.instances[1].transform, update.placements[0].transform);
    EXPECT_EQ(scene.meshes[0].positions, update.vertices[0].positions);
    EXPECT_EQ(scene.meshes[0].normals, update.vertices[0].normals);
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->eye, (Float3{9, 9, 9}));
    SceneUpdate without_normals;
    without_normals.vertices.push_back({0, scene.meshes[0].positions, {}});
    apply(scene, without_normals);
    EXPECT_EQ(scene.meshes[0].normals, update.vertices[0].normals) << "normals that are not given stay";
    apply(scene, {});
    EXPECT_TRUE(scene.camera) << "what is not in an update stays";
}

TEST(SceneUpdate, IsRefusedAsAWhole) {
    const auto refuses = [](const std::function<void(SceneUpdate&)>& spoil, const std::string& reason) {
        SCOPED_TRACE(reason);
        Scene scene = make_two();
        const Scene before = scene;
        SceneUpdate update = make_update();
        spoil(update);
        try {
            apply(scene, update);
            FAIL() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument);
            EXPECT_THAT(error.what(), testing::HasSubstr(reason));
        }
        EXPECT_EQ(scene.instances[1].transform, before.instances[1].transform) << "half applied";
        EXPECT_EQ(scene.meshes[0].positions, before.meshes[0].positions) << "half applied";
        EXPECT_FALSE(scene.camera) << "half applied";
    };
    refuses([](SceneUpdate& u) { u.placements[0].instance = 2; },
            "update.placements[0]: instance 2 does not exist; there are 2");
    refuses([](SceneUpdate& u) { u.placements[0].transform.rows[7] = nan; }, "update.placements[0]: instance 1: element 7 of its transform is nan");
    refuses([](SceneUpdate& u) { u.vertices[0].mesh = 1; },
            "update.vertices[0]: mesh 1 does not exist; there are 1");
    refuses([](SceneUpdate& u) { u.vertices[0].positions.pop_back(); },
            "2 positions for mesh 0, which has 3");
    refuses([](SceneUpdate& u) { u.vertices[0].normals.pop_back(); }, "2 normals for mesh 0, which has 3");
    refuses([](SceneUpdate& u) { u.vertices[0].positions[2].y = nan; }, "update.vertices[0]: mesh 0: position 2 is not finite: (0, nan, 2)");
    refuses([](SceneUpdate& u) { u.vertices[0].normals[1].x = nan; }, "normal 1 is not finite: (nan, 1, 0)");
    refuses([](SceneUpdate& u) { u.camera->target = u.camera->eye; }, "update.camera: eye and target");
}

}  // namespace
}  // namespace setka
