// SPDX-License-Identifier: MIT
/// Does an automatic camera see the whole box, from whatever box and for whatever picture?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "setka/error.hpp"
#include "setka/scene.hpp"
#include "setka/scenes.hpp"

namespace {

using namespace setka;

struct Vector {
    double x, y, z;
};
Vector minus(const Float3& a, const Float3& b) {
    return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
}
Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector unit(const Vector& a) {
    const double length = std::sqrt(dot(a, a));
    return {a.x / length, a.y / length, a.z / length};
}

/// How far out in the picture the farthest corner of the box is: 1 is the edge; infinite if one is behind the
/// camera.
double farthest_corner(const Camera& camera, const Bounds& box, double aspect) {
    const Vector forward = unit(minus(camera.target, camera.eye));
    const Vector right = unit(cross(forward, minus(camera.up, {})));
    const Vector up = cross(right, forward);
    const double tangent = std::tan(camera.vertical_fov_degrees * 3.14159265358979 / 360);
    double farthest = 0;
    for (int i = 0; i < 8; ++i) {
        const Float3 corner{i & 1 ? box.upper[0] : box.lower[0], i & 2 ? box.upper[1] : box.lower[1],
                            i & 4 ? box.upper[2] : box.lower[2]};
        const Vector p = minus(corner, camera.eye);
        const double depth = dot(p, forward);
        if (!(depth > 0)) return HUGE_VAL;
        farthest = std::max({farthest, std::abs(dot(p, up)) / (depth * tangent),
                             std::abs(dot(p, right)) / (depth * tangent * aspect)});
    }
    return farthest;
}

TEST(Frame, SeesEveryCornerWithASmallMargin) {
    const Bounds boxes[] = {{{-1, -1, -1}, {1, 1, 1}},
                            {{0, 0, 0}, {100, 1, 1}},
                            {{0, 0, 0}, {1, 100, 1}},
                            {{0, 0, 0}, {1, 1, 100}},
                            {{-5, 2, 3}, {5, 2, 3}},
                            {{0, 0, 0}, {1, 1, 0}},
                            {{1e-6f, 0, 0}, {2e-6f, 1e-6f, 1e-6f}},
                            {{-1e8f, 0, 0}, {1e8f, 1e8f, 1e8f}}};
    for (const Bounds& box : boxes)
        for (const float aspect : {0.25f, 1.0f, 16.0f / 9, 5.0f})
            for (const float fov : {10.0f, 50.0f, 120.0f}) {
                const Camera camera = frame(box, aspect, fov);
                const double farthest = farthest_corner(camera, box, aspect);
                EXPECT_LT(farthest, 0.96);
                EXPECT_GT(farthest, 0.94);
                EXPECT_EQ(camera.vertical_fov_degrees, fov);
            }
}

TEST(Frame, LooksFromTheRightFront) {
    const Camera camera = frame({{-1, -1, -1}, {1, 1, 1}}, 1);
    EXPECT_EQ(camera.target, (Float3{0, 0, 0}));
    EXPECT_NEAR(camera.eye.x / camera.eye.z, 0.6, 1e-6);
    EXPECT_NEAR(camera.eye.y / camera.eye.z, 0.35, 1e-6);
    EXPECT_GT(camera.eye.z, 0);
}

TEST(Frame, SinglePointIsNotDegenerate) {
    for (const float at : {0.0f, 1.0f, -1e6f}) {
        Scene scene = make_scene("cube");
        scene.camera = frame({{at, at, at}, {at, at, at}}, 1);
        EXPECT_NO_THROW(scene.validate());
    }
}

TEST(Frame, RejectsWhatCannotBeFramed) {
    const Bounds box{{0, 0, 0}, {1, 1, 1}};
    EXPECT_THROW((void)frame(box, 0), Error);
    EXPECT_THROW((void)frame(box, 1, 180), Error);
    EXPECT_THROW((void)frame(Scene{}.bounds(), 1), Error);
    EXPECT_THROW((void)frame_inside(box, 0), Error);
}

TEST(FrameInside, StandsInTheLowerHalfAndLooksAlongTheLongSide) {
    const Camera along_x = frame_inside({{0, 0, 0}, {10, 4, 6}});
    EXPECT_GT(along_x.target.x, along_x.eye.x);
    EXPECT_EQ(along_x.target.z, along_x.eye.z);
    const Camera along_z = frame_inside({{0, 0, 0}, {6, 4, 10}});
    EXPECT_GT(along_z.target.z, along_z.eye.z);
    for (const Camera& camera : {along_x, along_z}) {
        EXPECT_GT(camera.eye.y, 0);
        EXPECT_LT(camera.eye.y, 2);
        EXPECT_GT(std::min(camera.eye.x, camera.eye.z), 0);
    }
}

TEST(DefaultLights, StayInTheRoom) {
    Scene scene = make_scene("cube");  // from -1 to 1
    const Camera camera = frame_inside(scene.bounds());
    add_default_lights(scene, camera);
    ASSERT_EQ(scene.point_lights.size(), 2u);
    for (const PointLight& light : scene.point_lights)
        for (const float value : {light.position.x, light.position.y, light.position.z})
            EXPECT_LT(std::abs(value), 1);
    EXPECT_EQ(scene.point_lights[1].position, camera.eye);
    EXPECT_NO_THROW(scene.validate());
}

}  // namespace
