// SPDX-License-Identifier: MIT
/// Which scenes break builders? Zero areas, repeated and coplanar triangles, slivers, giants, far offsets,
/// extreme sizes.
#include <cmath>

#include "support/random.hpp"
#include "support/scenes.hpp"

namespace support {

namespace {

using setka::Float3;
using setka::Scene;

Float3 point(Random& random, float lower, float upper) {
    const float x = random.between(lower, upper), y = random.between(lower, upper);
    return {x, y, random.between(lower, upper)};
}

/// Small triangles all over the box [-half, half]^3 around `centre`.
std::vector<Corners> clutter(std::uint64_t seed, int count, float half, float size, Float3 centre = {}) {
    Random random(seed);
    std::vector<Corners> triangles;
    for (int k = 0; k < count; ++k) {
        const Float3 at = point(random, -half, half);
        Corners corners;
        for (Float3& corner : corners) {
            const Float3 by = point(random, -size, size);
            corner = {centre.x + at.x + by.x, centre.y + at.y + by.y, centre.z + at.z + by.z};
        }
        triangles.push_back(corners);
    }
    return triangles;
}

/// A sheet of 2 n^2 triangles, (u, v) in [0, 1]^2 taken through `map`.
template <typename Map>
std::vector<Corners> sheet(int n, Map&& map) {
    std::vector<Corners> triangles;
    const auto at = [&](int i, int j) {
        return map(static_cast<float>(i) / static_cast<float>(n),
                   static_cast<float>(j) / static_cast<float>(n));
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return triangles;
}

Scene zero_areas() {
    auto triangles = clutter(1, 40, 1, 0.2f);
    Random random(2);
    for (int k = 0; k < 40; ++k) {
        const Float3 a = point(random, -1, 1), b = point(random, -1, 1);
        const Float3 middle{0.5f * (a.x + b.x), 0.5f * (a.y + b.y), 0.5f * (a.z + b.z)};
        triangles.push_back({a, a, a});
        triangles.push_back({a, b, b});
        triangles.push_back({a, b, a});
        triangles.push_back({a, b, middle});
    }
    return from_triangles(triangles);
}

Scene repeated() {
    const auto some = clutter(3, 20, 1, 0.3f);
    std::vector<Corners> triangles;
    for (int round = 0; round < 10; ++round) triangles.insert(triangles.end(), some.begin(), some.end());
    for (const Corners& t : some) triangles.push_back({t[1], t[2], t[0]});
    return from_triangles(triangles);
}

/// Squares of side 1 on integer planes in the box [0, 8]^3: 128 triangles, so that cells have side 1 at
/// density 4 and side 2 at density 0.5.
Scene on_cell_planes() {
    std::vector<Corners> triangles;
    for (int k = 0; k < 64; ++k) {
        const int axis = k % 3;
        const auto place = [&](float plane, float u, float v) {
            return axis == 0 ? Float3{plane, u, v} : axis == 1 ? Float3{v, plane, u} : Float3{u, v, plane};
        };
        const auto plane = static_cast<float>((k * 5) % 9), u = static_cast<float>((k * 3) % 8);
        const auto v = static_cast<float>((k * 7 + k / 8) % 8);
        triangles.push_back({place(plane, u, v), place(plane, u + 1, v), place(plane, u + 1, v + 1)});
        triangles.push_back({place(plane, u, v), place(plane, u + 1, v + 1), place(plane, u, v + 1)});
    }
    triangles[0] = {Float3{0, 0, 0}, Float3{1, 0, 0}, Float3{1, 1, 0}};
    triangles[1] = {Float3{8, 8, 8}, Float3{7, 8, 8}, Float3{7, 7, 8}};
    return from_triangles(triangles);
}

Scene giant() {
    auto triangles = clutter(5, 1500, 10, 0.1f);
    triangles.push_back({Float3{-10, -10, -10}, Float3{10, -9, 10}, Float3{-9, 10, 9}});
    triangles.push_back({Float3{-10, 0, -10}, Float3{10, 0, -10}, Float3{10, 0, 10}});
    return from_triangles(triangles);
}

Scene slivers() {
    std::vector<Corners> triangles = clutter(6, 50, 1, 0.05f);
    Random random(7);
    for (int k = 0; k < 300; ++k) {
        const Float3 a = point(random, -1, 1), b = point(random, -1, 1);
        const float share = random.unit(), width = k % 3 == 0 ? 1e-3f : k % 3 == 1 ? 1e-6f : 1e-8f;
        triangles.push_back({a, b,
                             Float3{a.x + (b.x - a.x) * share + width, a.y + (b.y - a.y) * share,
                                    a.z + (b.z - a.z) * share}});
    }
    return from_triangles(triangles);
}

Scene collinear() {
    std::vector<Corners> triangles;
    for (int k = 0; k < 30; ++k) {
        const auto x = static_cast<float>(k);
        triangles.push_back(
            {Float3{x, x, x}, Float3{x + 1, x + 1, x + 1}, Float3{x + 0.5f, x + 0.5f, x + 0.5f}});
    }
    return from_triangles(triangles);
}

/// One mesh in several places: turned, mirrored, stretched, flattened to a plane, hidden from some masks.
Scene placed() {
    Scene scene = ball(300);
    scene.instances.clear();
    const auto place = [&](std::array<float, 12> rows, std::uint32_t mask = ~0u, std::uint32_t mesh = 0) {
        setka::Instance instance;
        instance.mesh = mesh;
        instance.transform.rows = rows;
        instance.mask = mask;
        scene.instances.push_back(instance);
    };
    scene.meshes.push_back(ball(100, {0, 0, 0}, 0.7f).meshes[0]);
    place({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 1);
    place({0.6f, -0.8f, 0, 2, 0.8f, 0.6f, 0, 0.1f, 0, 0, 1, -0.3f}, 2);
    place({-1, 0, 0, -2, 0, 1, 0, 0.5f, 0, 0, 1, 0.2f}, 3, 1);
    place({3, 0, 0, 0.3f, 0, 0.1f, 0, 1.5f, 0, 0, 0.7f, 0}, 4);
    place({1, 0.5f, 0, 0, 0, 0, 0, -1.5f, 0, 0.25f, 1, 0}, 6, 1);
    place({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 0);
    place({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 8);
    scene.materials.emplace_back().transparency = 1;
    scene.instances[1].material = 1;
    return scene;
}

/// Mirrored so that the lowest world x is a sum of negative zeros only.
Scene negative_zero() {
    Scene scene = from_triangles({{Float3{0, -1, -1}, Float3{-1, -2, -1}, Float3{-1, -1, -2}},
                                  {Float3{0, -2, -2}, Float3{0, -1, -2}, Float3{-1, -2, -2}}});
    scene.instances[0].transform.rows = {-1, 0, 0, -0.0f, 0, 1, 0, 0, 0, 0, 1, 0};
    return scene;
}

}  // namespace

std::vector<SceneCase> degenerate_scenes() {
    const auto made = [](const char* name, std::function<Scene()> make, std::string edges = {}) {
        return SceneCase{name, std::move(make), std::move(edges)};
    };
    const auto flat = [](auto&& map) { return [=] { return from_triangles(sheet(20, map)); }; };
    const auto moved = [](float offset) {
        return [=] { return ball(1500, {offset, -offset, 0.5f * offset}, 10); };
    };
    const std::string regular = "a regular sheet has a common period with the cells";
    return {
        made("single_triangle",
             [] {
                 return from_triangles({{Float3{0, 0, 0}, Float3{1, 0.2f, 0.1f}, Float3{0.3f, 1, 0.7f}}});
             }),
        made("single_point",
             [] {
                 return from_triangles({{Float3{1, 2, 3}, Float3{1, 2, 3}, Float3{1, 2, 3}}});
             }),
        made("two_far_apart",
             [] {
                 auto triangles = clutter(9, 1, 1, 1);
                 const auto other = clutter(10, 1, 1, 1, {1000, 900, 800});
                 triangles.insert(triangles.end(), other.begin(), other.end());
                 return from_triangles(triangles);
             }),
        made("negative_zero", negative_zero),
        made("zero_areas", zero_areas),
        made("repeated", repeated),
        made("plane_xy", flat([](float u, float v) {
                 return Float3{u, 2 * v, 3};
             }),
             regular),
        made("plane_yz", flat([](float u, float v) {
                 return Float3{-1, u, 2 * v};
             }),
             regular),
        made("plane_slanted", flat([](float u, float v) {
                 return Float3{u, v, u + 0.5f * v};
             }),
             regular),
        made("thin", flat([](float u, float v) {
                 return Float3{u, 1e-4f * u * v, v};
             }),
             regular),
        made("on_cell_planes", on_cell_planes),
        made("giant", giant),
        made("slivers", slivers),
        made("collinear", collinear),
        made("placed", placed),
        made("offset_1e5", moved(1e5f)),
        made("offset_1e6", moved(1e6f)),
        made("offset_1e7", moved(1e7f)),
        made("tiny_1e_6", [] { return ball(1500, {}, 1e-6f); }),
        made("tiny_1e_30", [] { return ball(500, {}, 1e-30f); }),
        made("huge_1e18", [] { return ball(500, {}, 1e18f); }),
    };
}

}  // namespace support
