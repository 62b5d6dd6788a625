// SPDX-License-Identifier: MIT
/// Are the built-in scenes what they say: the size, the same triangles everywhere, closed where they are
/// solids?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <utility>

#include "setka/error.hpp"
#include "setka/scenes.hpp"

namespace {

using namespace setka;
using ::testing::HasSubstr;

/// FNV-1a (Fowler, Noll & Vo) over the corners of all triangles as floats, in order.
std::uint64_t fingerprint(const Scene& scene) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&](float value) {
        std::array<unsigned char, 4> bytes;
        std::memcpy(bytes.data(), &value, 4);
        for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
    };
    for (const Mesh& mesh : scene.meshes)
        for (const Triangle& t : mesh.triangles)
            for (const std::uint32_t index : {t.a, t.b, t.c}) {
                const Float3& p = mesh.positions[index];
                add(p.x);
                add(p.y);
                add(p.z);
            }
    return hash;
}

class BuiltIn : public ::testing::TestWithParam<std::string> {
  protected:
    static const BuiltInScene& info() {
        for (const BuiltInScene& scene : built_in_scenes())
            if (scene.name == GetParam()) return scene;
        throw std::logic_error("no such scene");
    }
};

TEST_P(BuiltIn, IsValidAndAboutAsLargeAsStated) {
    const Scene scene = make_scene(GetParam());
    EXPECT_NO_THROW(scene.validate());
    const auto stated = static_cast<double>(info().default_triangles);
    const auto count = static_cast<double>(scene.triangle_count());
    if (info().sizable) EXPECT_NEAR(count, stated, 0.01 * stated);
    else EXPECT_EQ(count, stated);
}

TEST_P(BuiltIn, TakesASizeOrSaysThatItDoesNot) {
    if (info().sizable) {
        for (const std::uint64_t size : {1u, 10u, 1000u, 50000u}) {
            const Scene scene = make_scene(GetParam(), size);
            EXPECT_NO_THROW(scene.validate());
            if (size == 50000u) {
                EXPECT_NEAR(double(scene.triangle_count()), 50000, 2500);
            }
        }
        EXPECT_THROW((void)make_scene(GetParam(), (std::uint64_t{1} << 28) + 1), Error);
    } else {
        try {
            (void)make_scene(GetParam(), 100);
            FAIL() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument);
            EXPECT_THAT(error.what(), HasSubstr("fixed number of triangles"));
        }
    }
}

std::vector<std::string> names() {
    std::vector<std::string> list;
    for (const BuiltInScene& scene : built_in_scenes()) list.push_back(scene.name);
    return list;
}

INSTANTIATE_TEST_SUITE_P(All, BuiltIn, ::testing::ValuesIn(names()),
                         [](const auto& test) { return test.param; });

TEST(BuiltInScenes, UnknownNameListsTheKnownOnes) {
    try {
        (void)make_scene("teapot");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument);
        EXPECT_THAT(error.what(), HasSubstr("'teapot'"));
        for (const std::string& name : names()) EXPECT_THAT(error.what(), HasSubstr(name));
    }
}

/// The same bits on every machine: the numbers were made once and must not change.
TEST(BuiltInScenes, BenchmarkScenesNeverChange) {
    EXPECT_EQ(fingerprint(make_scene("terrain", 20000)), 0xf6a99150c1ae44b6u);
    EXPECT_EQ(fingerprint(make_scene("spheres", 20000)), 0xc8e3c31c37397c71u);
    EXPECT_EQ(fingerprint(make_scene("soup", 20000)), 0x6c399262b3e3931du);
    EXPECT_EQ(fingerprint(make_scene("sphere", 20000)), 0xe44fb9bd09e71b4du);
    EXPECT_EQ(fingerprint(make_scene("torus", 20000)), 0x4cbe4953e91dc99du);
}

/// Edges that are not used once in each direction, and the volume that the triangles enclose.
struct Solid {
    std::size_t open_edges = 0;
    double volume = 0;
};

Solid measure(const Mesh& mesh) {
    using Point = std::array<float, 3>;
    const auto point = [&](std::uint32_t index) {
        const Float3& p = mesh.positions[index];
        return Point{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // -0 is 0
    };
    std::map<std::pair<Point, Point>, int> edges;
    Solid solid;
    for (const Triangle& t : mesh.triangles) {
        const Point corners[3] = {point(t.a), point(t.b), point(t.c)};
        for (int i = 0; i < 3; ++i) {
            ++edges[{corners[i], corners[(i + 1) % 3]}];
            --edges[{corners[(i + 1) % 3], corners[i]}];
        }
        const auto& [a, b, c] = corners;
        solid.volume += (double(a[0]) * (double(b[1]) * c[2] - double(b[2]) * c[1]) +
                         double(a[1]) * (double(b[2]) * c[0] - double(b[0]) * c[2]) +
                         double(a[2]) * (double(b[0]) * c[1] - double(b[1]) * c[0])) /
                        6;
    }
    for (const auto& [edge, balance] : edges) solid.open_edges += balance != 0;
    return solid;
}

TEST(BuiltInScenes, SolidsAreClosedAndWindOutward) {
    const double pi = 3.14159265358979;
    const std::pair<const char*, double> solids[] = {
        {"cube", 8}, {"sphere", 4 * pi / 3}, {"torus", 2 * pi * pi * 0.4 * 0.4}};
    for (const auto& [name, volume] : solids) {
        const Solid solid = measure(make_scene(name).meshes.front());
        EXPECT_EQ(solid.open_edges, 0u) << name;
        EXPECT_NEAR(solid.volume, volume, 0.01 * volume) << name;
    }
}

TEST(Showcase, ShowsWhatItShould) {
    const Scene scene = make_scene("showcase");
    EXPECT_GE(scene.triangle_count(), 500'000u);
    EXPECT_TRUE(scene.camera);
    EXPECT_FALSE(scene.point_lights.empty() && scene.directional_lights.empty());
    bool has_mirror = false, has_glass = false;
    for (const Material& material : scene.materials) {
        has_mirror |= material.reflectivity > 0.8f;
        has_glass |= material.transparency > 0.8f;
    }
    EXPECT_TRUE(has_mirror);
    EXPECT_TRUE(has_glass);
    for (const Mesh& mesh : scene.meshes) {
        EXPECT_EQ(mesh.normals.size(), mesh.positions.size()) << mesh.name;
        const Solid solid = measure(mesh);
        EXPECT_EQ(solid.open_edges, 0u) << mesh.name;
        EXPECT_GT(solid.volume, 0) << mesh.name;
    }
}

}  // namespace
