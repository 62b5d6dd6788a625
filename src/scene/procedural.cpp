// SPDX-License-Identifier: MIT
/// Which triangles do the built-in scenes consist of? Fixed recipes over a fixed random sequence. terrain,
/// spheres and soup are benchmark scenes: a kind and a count name the same triangles in the same order
/// everywhere.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/exact_math.hpp"
#include "scene/shapes.hpp"
#include "scene/showcase.hpp"
#include "scene/vector.hpp"
#include "setka/error.hpp"
#include "setka/scenes.hpp"

namespace setka {

namespace {

using shapes::Seam;

constexpr std::uint64_t max_triangles = std::uint64_t{1} << 28;

/// Uniform floats in [0, 1). The generator's sequence is in the C++ standard; how a library turns it into
/// floats is not, so that is written out: round to float, scale by 2^-32, and take the float below 1 where
/// rounding reached 1.
class UnitRandom {
  public:
    explicit UnitRandom(std::uint32_t seed) : generator_(seed) {}
    [[nodiscard]] float operator()() {
        const float value = static_cast<float>(static_cast<std::uint32_t>(generator_())) * 0x1p-32f;
        return value < 1 ? value : 0x1.fffffep-1f;
    }

  private:
    std::mt19937 generator_;
};

[[nodiscard]] Scene one_object(Mesh mesh, const Float3& colour) {
    Scene scene;
    Material material;
    material.name = mesh.name;
    material.diffuse = colour;
    scene.materials.push_back(std::move(material));
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({});
    return scene;
}

/// How many parts give `triangles` triangles at `per_square` for each square of the parts; at least
/// `smallest`.
[[nodiscard]] std::uint32_t parts(std::uint64_t triangles, double per_square, std::uint32_t smallest) {
    const auto count = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / per_square));
    return std::max(count, smallest);
}

[[nodiscard]] float lattice_noise(std::uint32_t x, std::uint32_t y, std::uint32_t octave) {
    std::uint32_t hash = x * 374761393u + y * 668265263u + octave * 2147483647u;
    hash = (hash ^ (hash >> 13)) * 1274126177u;
    return static_cast<float>((hash ^ (hash >> 16)) & 0xffffffu) / 16777215.0f;
}

/// Six octaves of bilinear value noise.
[[nodiscard]] float fractal_noise(float x, float y) {
    float sum = 0;
    float amplitude = 0.5f;
    for (std::uint32_t octave = 0; octave < 6; ++octave) {
        const auto ix = static_cast<std::uint32_t>(x);  // x and y are not negative
        const auto iy = static_cast<std::uint32_t>(y);
        const float fx = x - static_cast<float>(ix);
        const float fy = y - static_cast<float>(iy);
        const auto row = [&](std::uint32_t j) {
            return lattice_noise(ix, j, octave) * (1 - fx) + lattice_noise(ix + 1, j, octave) * fx;
        };
        sum += amplitude * (row(iy) * (1 - fy) + row(iy + 1) * fy);
        amplitude *= 0.5f;
        x *= 2;
        y *= 2;
    }
    return sum;
}

[[nodiscard]] Scene terrain(std::uint64_t triangles) {
    const std::uint32_t n = parts(triangles, 2, 1);
    const auto side = static_cast<float>(n);
    Mesh mesh;
    mesh.name = "terrain";
    shapes::add_patch(mesh, n, n, Seam::Open, Seam::Open, [&](std::uint32_t i, std::uint32_t j) {
        const auto x = static_cast<float>(i);
        const auto z = static_cast<float>(j);
        const float height = 20 * fractal_noise(x * 16.0f / side, z * 16.0f / side);
        mesh.positions.push_back({100.0f * x / side, height, 100.0f * z / side});
    });
    return one_object(std::move(mesh), {0.45f, 0.5f, 0.32f});
}

[[nodiscard]] Scene spheres(std::uint64_t triangles) {
    constexpr std::uint32_t rings = 32;
    constexpr std::uint64_t triangles_each = rings * rings * 4;
    const std::uint64_t count = std::max<std::uint64_t>(triangles / triangles_each, 1);
    struct Angle {
        float sin, cos;
    };
    std::vector<Angle> angles;
    for (std::uint32_t k = 0; k <= 2 * rings; ++k) {
        const exact::SinCos sc = exact::sin_cos(3.14159265f * static_cast<float>(k) / rings);
        angles.push_back({static_cast<float>(sc.sin), static_cast<float>(sc.cos)});
    }
    UnitRandom random(3);
    Mesh mesh;
    mesh.name = "spheres";
    mesh.positions.reserve(count * (rings + 1) * (2 * rings + 1));
    mesh.triangles.reserve(count * triangles_each);
    for (std::uint64_t s = 0; s < count; ++s) {
        const float x = 100 * random();
        const float y = 100 * random();
        const float z = 100 * random();
        const float radius = static_cast<float>(exact::power(random(), 3)) * 6 + 0.3f;
        shapes::add_patch(
            mesh, rings, 2 * rings, Seam::Open, Seam::Open, [&](std::uint32_t i, std::uint32_t j) {
                const Angle theta = angles[i];
                const Angle phi = angles[j];
                mesh.positions.push_back({x + radius * theta.sin * phi.cos, y + radius * theta.cos,
                                          z + radius * theta.sin * phi.sin});
            });
    }
    return one_object(std::move(mesh), {0.7f, 0.45f, 0.3f});
}

[[nodiscard]] Scene soup(std::uint64_t triangles) {
    UnitRandom random(3);
    Mesh mesh;
    mesh.name = "soup";
    mesh.positions.reserve(3 * triangles);
    mesh.triangles.reserve(triangles);
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const float x = 100 * random();
        const float y = 100 * random();
        const float z = 100 * random();
        for (int corner = 0; corner < 3; ++corner) {
            const float dx = random() - 0.5f;
            const float dy = random() - 0.5f;
            const float dz = random() - 0.5f;
            mesh.positions.push_back({x + dx, y + dy, z + dz});
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return one_object(std::move(mesh), {0.35f, 0.5f, 0.65f});
}

[[nodiscard]] Scene plane(std::uint64_t triangles) {
    const std::uint32_t n = parts(triangles, 2, 1);
    Mesh mesh;
    mesh.name = "plane";
    shapes::add_patch(mesh, n, n, Seam::Open, Seam::Open, [&](std::uint32_t i, std::uint32_t j) {
        const auto at = [n](std::uint32_t k) { return static_cast<float>(2.0 * k / n - 1); };
        mesh.positions.push_back({at(j), 0, at(i)});
    });
    return one_object(std::move(mesh), {0.6f, 0.6f, 0.6f});
}

struct Recipe {
    BuiltInScene info;
    std::function<Scene(std::uint64_t)> make;
};

[[nodiscard]] const std::vector<Recipe>& recipes() {
    static const std::vector<Recipe> list{
        {{"showcase", "a field of columns with a mirror, glass and metal; has its camera and lights",
          showcase_triangles, false},
         [](std::uint64_t) { return make_showcase(); }},
        {{"terrain", "one fractal height field", 200'000, true}, terrain},
        {{"spheres", "tessellated spheres of mixed size in a cube, 4096 triangles each", 102'400, true},
         spheres},
        {{"soup", "small loose triangles in a cube", 100'000, true}, soup},
        {{"cube", "the cube from -1 to 1", 12, false},
         [](std::uint64_t) {
             return one_object(shapes::cube(), {0.7f, 0.35f, 0.3f});
         }},
        {{"sphere", "the unit sphere, closed, with smooth normals", 20'480, true},
         [](std::uint64_t n) {
             return one_object(shapes::sphere(parts(n, 20, 1)), {0.35f, 0.55f, 0.7f});
         }},
        {{"torus", "a ring of radius 1 around the y axis, closed, with smooth normals", 16'384, true},
         [](std::uint64_t n) {
             const std::uint32_t across = parts(n, 4, 3);
             return one_object(shapes::torus(1, 0.4, 2 * across, across), {0.75f, 0.6f, 0.3f});
         }},
        {{"plane", "a flat square grid of triangles at y = 0", 2, true}, plane},
    };
    return list;
}

}  // namespace

const std::vector<BuiltInScene>& built_in_scenes() {
    static const std::vector<BuiltInScene> list = [] {
        std::vector<BuiltInScene> infos;
        for (const Recipe& recipe : recipes()) infos.push_back(recipe.info);
        return infos;
    }();
    return list;
}

Scene make_scene(std::string_view name, std::uint64_t triangles) {
    std::string known;
    for (const Recipe& recipe : recipes()) {
        const BuiltInScene& info = recipe.info;
        if (info.name == name) {
            if (triangles != 0 && !info.sizable)
                throw Error(ErrorCategory::InvalidArgument, "triangles = " + std::to_string(triangles) +
                                                                ": the scene '" + info.name +
                                                                "' has a fixed number of triangles, " +
                                                                std::to_string(info.default_triangles));
            if (triangles > max_triangles)
                throw Error(ErrorCategory::InvalidArgument,
                            "triangles = " + std::to_string(triangles) + "; accepted is up to 2^28");
            return recipe.make(triangles != 0 ? triangles : info.default_triangles);
        }
        known += (known.empty() ? "" : ", ") + info.name;
    }
    throw Error(ErrorCategory::InvalidArgument,
                "'" + std::string(name) + "' is not a built-in scene; there are " + known);
}

}  // namespace setka
