// SPDX-License-Identifier: MIT
/// Does a scene know what it holds, and say what is wrong with it?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "setka/error.hpp"
#include "setka/scene.hpp"

namespace {

using namespace setka;
using ::testing::HasSubstr;

/// One triangle, placed twice.
Scene two_triangles() {
    Scene scene;
    Mesh mesh;
    mesh.name = "wing";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    scene.meshes.push_back(mesh);
    scene.materials.emplace_back();
    scene.instances.resize(2);
    scene.instances[1].transform.rows[3] = 10;
    return scene;
}

TEST(Scene, CountsInstances) {
    EXPECT_EQ(two_triangles().triangle_count(), 2u);
    EXPECT_EQ(Scene{}.triangle_count(), 0u);
}

TEST(Scene, BoundsFollowInstancesAndIgnoreStrayVertices) {
    Scene scene = two_triangles();
    scene.meshes[0].positions.push_back({-100, -100, -100});
    const Bounds box = scene.bounds();
    EXPECT_EQ(box.lower[0], 0);
    EXPECT_EQ(box.upper[0], 11);
    EXPECT_EQ(box.lower[1], 0);
    EXPECT_EQ(box.upper[1], 1);
    EXPECT_EQ(box.lower[2], 0);
    EXPECT_EQ(box.upper[2], 0);
}

TEST(Scene, BoundsOfNothingAreEmpty) {
    const Bounds box = Scene{}.bounds();
    for (int axis = 0; axis < 3; ++axis) EXPECT_GT(box.lower[axis], box.upper[axis]);
}

TEST(Scene, AppendMovesIndices) {
    Scene target = two_triangles();
    target.camera = Camera{{1, 2, 3}};
    Scene source = two_triangles();
    source.materials.emplace_back();
    source.instances[0].material = 1;
    source.point_lights.emplace_back();
    source.directional_lights.emplace_back();
    source.camera = Camera{{7, 8, 9}};
    append(target, source);
    EXPECT_NO_THROW(target.validate());
    ASSERT_EQ(target.instances.size(), 4u);
    EXPECT_EQ(target.instances[2].mesh, 1u);
    EXPECT_EQ(target.instances[2].material, 2u);
    EXPECT_EQ(target.instances[3].material, 1u);
    EXPECT_EQ(target.point_lights.size(), 1u);
    EXPECT_EQ(target.directional_lights.size(), 1u);
    EXPECT_EQ(target.camera->eye, (Float3{1, 2, 3}));
    EXPECT_EQ(target.triangle_count(), 4u);

    Scene without_camera;
    append(without_camera, source);
    EXPECT_EQ(without_camera.camera->eye, (Float3{7, 8, 9}));
}

struct Defect {
    const char* name;
    std::function<void(Scene&)> make;
    const char* message;
};
void PrintTo(const Defect& defect, std::ostream* out) { *out << defect.name; }

class SceneDefect : public ::testing::TestWithParam<Defect> {};

TEST_P(SceneDefect, IsNamed) {
    Scene scene = two_triangles();
    ASSERT_NO_THROW(scene.validate());
    GetParam().make(scene);
    try {
        scene.validate();
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::InvalidData);
        EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
    }
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

INSTANTIATE_TEST_SUITE_P(
    All, SceneDefect,
    ::testing::Values(
        Defect{"position", [](Scene& s) { s.meshes[0].positions[1].y = nan; }, "mesh 0 'wing': position 1"},
        Defect{"index", [](Scene& s) { s.meshes[0].triangles[0].c = 3; }, "triangle 0 uses vertex 3 of 3"},
        Defect{"normal_count", [](Scene& s) { s.meshes[0].normals.resize(2); }, "2 normals for 3 positions"},
        Defect{"normal",
               [](Scene& s) {
                   s.meshes[0].normals.resize(3, {0, infinity, 0});
               },
               "normal 0 is not finite"},
        Defect{"mesh", [](Scene& s) { s.instances[1].mesh = 4; }, "instance 1: mesh 4 does not exist"},
        Defect{"material", [](Scene& s) { s.instances[1].material = 1; },
               "instance 1: material 1 does not exist"},
        Defect{"no_material", [](Scene& s) { s.materials.clear(); }, "there are 0"},
        Defect{"transform", [](Scene& s) { s.instances[0].transform.rows[5] = nan; },
               "instance 0: its transform"},
        Defect{"colour", [](Scene& s) { s.materials[0].diffuse.x = nan; }, "material 0: a colour"},
        Defect{"shininess", [](Scene& s) { s.materials[0].shininess = 0; }, "shininess = 0"},
        Defect{"reflectivity", [](Scene& s) { s.materials[0].reflectivity = 2; }, "reflectivity = 2"},
        Defect{"transparency", [](Scene& s) { s.materials[0].transparency = nan; }, "transparency = nan"},
        Defect{"refraction", [](Scene& s) { s.materials[0].refractive_index = 0; }, "refractive_index = 0"},
        Defect{"point_light",
               [](Scene& s) {
                   s.point_lights.push_back({{nan, 0, 0}});
               },
               "point light 0"},
        Defect{"fall_off",
               [](Scene& s) {
                   s.point_lights.push_back({{}, {}, -1});
               },
               "reference_distance = -1"},
        Defect{"direction",
               [](Scene& s) {
                   s.directional_lights.push_back({{0, 0, 0}});
               },
               "direction is zero"},
        Defect{"camera",
               [](Scene& s) {
                   s.camera = Camera{{0, 0, 0}};
               },
               "eye and target are the same"},
        Defect{"camera_up",
               [](Scene& s) {
                   s.camera = Camera{{0, 5, 0}};
               },
               "up is zero or points along the view"},
        Defect{"camera_fov", [](Scene& s) { s.camera = Camera{.vertical_fov_degrees = 180}; }, "= 180"},
        Defect{"background", [](Scene& s) { s.background.zenith.z = nan; }, "background"},
        Defect{"no_instance", [](Scene& s) { s.instances.clear(); }, "no triangle"},
        Defect{"no_triangle", [](Scene& s) { s.meshes[0].triangles.clear(); }, "no triangle"}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
