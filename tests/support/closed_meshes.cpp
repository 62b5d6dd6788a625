// SPDX-License-Identifier: MIT
/// Which meshes have an inside, and which rays try to slip through? See the header.
#include "support/closed_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <utility>

namespace support {

namespace {

using setka::Float3;
using setka::Mesh;
using setka::Triangle;

/// SplitMix64 (Steele, Lea & Flood 2014), started afresh for each line.
class Lots {
  public:
    explicit Lots(std::uint64_t seed) : state_(seed) {}
    std::uint64_t draw() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>(((draw() >> 32) * count) >> 32);
    }
    float between(float low, float high) {
        return low + (high - low) * (static_cast<float>(draw() >> 40) * 0x1p-24f);
    }

  private:
    std::uint64_t state_;
};

/// Positions as numbers: 0 and -0 are one place.
using Place = std::array<std::uint32_t, 3>;
Place place_of(const Float3& p) {
    const float sum[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
    Place place;
    std::memcpy(place.data(), sum, sizeof(sum));
    return place;
}

struct Box {
    float lower[3], upper[3];
};

Box box_of(const Mesh& mesh) {
    Box box;
    std::fill_n(box.lower, 3, std::numeric_limits<float>::infinity());
    std::fill_n(box.upper, 3, -std::numeric_limits<float>::infinity());
    for (const Float3& p : mesh.positions) {
        const float values[3] = {p.x, p.y, p.z};
        for (int axis = 0; axis < 3; ++axis) {
            box.lower[axis] = std::min(box.lower[axis], values[axis]);
            box.upper[axis] = std::max(box.upper[axis], values[axis]);
        }
    }
    return box;
}

setka::Ray line_at(const Mesh& mesh, const Box& box, Lots lots) {
    const Triangle& triangle = mesh.triangles[lots.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const std::uint32_t corners[3] = {triangle.a, triangle.b, triangle.c};
    const std::uint32_t corner = lots.below(3);
    const auto at = [&](std::uint32_t k) {
        const Float3& p = mesh.positions[corners[(corner + k) % 3]];
        return std::array<float, 3>{p.x, p.y, p.z};
    };
    const auto a = at(0), b = at(1), c = at(2);
    // A vertex, the middle or any point of an edge, or of the face.
    const std::uint32_t aim = lots.below(4);
    const float along = aim == 0 ? 0.0f : aim == 1 ? 0.5f : lots.between(0, 1);
    const float across = aim == 3 ? lots.between(0, 1 - along) : 0.0f;
    setka::Ray ray;
    ray.tmin = -std::numeric_limits<float>::infinity();
    ray.tmax = std::numeric_limits<float>::infinity();
    // How many coordinates the line's origin shares with its aim.
    const std::uint32_t kind = lots.below(4), axis = lots.below(3);
    for (std::uint32_t k = 0; k < 3; ++k) {
        const float target = a[k] + (b[k] - a[k]) * along + (c[k] - a[k]) * across;
        const float reach = std::max(box.upper[k] - box.lower[k], 0x1p-10f * std::fabs(target));
        const bool is_shared = kind == 0 ? k != axis : kind == 1 && k == axis;
        ray.origin[k] = is_shared ? target : lots.between(box.lower[k] - reach, box.upper[k] + reach);
        ray.direction[k] = target - ray.origin[k];
    }
    return ray;
}

}  // namespace

Mesh icosphere(std::uint32_t levels, const Float3& centre, float radius) {
    using Point = std::array<double, 3>;
    const double g = (1 + std::sqrt(5.0)) / 2;
    std::vector<Point> points{{-1, g, 0}, {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<Triangle> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},  {3, 2, 6}, {3, 6, 8},
                                    {3, 8, 9},  {4, 9, 5},  {2, 4, 11},  {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (std::uint32_t level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t i, std::uint32_t j) {
            const auto [at, is_new] =
                middles.emplace(std::minmax(i, j), static_cast<std::uint32_t>(points.size()));
            if (is_new)
                points.push_back({points[i][0] + points[j][0], points[i][1] + points[j][1], points[i][2] + points[j][2]});
            return at->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle& t : triangles) {
            const std::uint32_t ab = middle(t.a, t.b), bc = middle(t.b, t.c), ca = middle(t.c, t.a);
            finer.insert(finer.end(), {{t.a, ab, ca}, {t.b, bc, ab}, {t.c, ca, bc}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
        for (Point& p : points) {
            const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
            for (double& value : p) value /= length;
        }
    }
    Mesh mesh;
    mesh.name = "icosphere";
    mesh.triangles = std::move(triangles);
    for (const Point& p : points) {
        const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        const auto coordinate = [&](float middle, double value) {
            return static_cast<float>(middle + radius * value / length);
        };
        mesh.positions.push_back({coordinate(centre.x, p[0]), coordinate(centre.y, p[1]), coordinate(centre.z, p[2])});
    }
    return mesh;
}

Mesh close(Mesh mesh) {
    mesh.normals.clear();
    std::map<Place, std::uint32_t> numbers;
    std::vector<std::uint32_t> number_of;
    for (const Float3& p : mesh.positions)
        number_of.push_back(
            numbers.emplace(place_of(p), static_cast<std::uint32_t>(number_of.size())).first->second);
    // Edges by place that were met an odd number of times.
    std::set<std::pair<std::uint32_t, std::uint32_t>> open;
    for (const Triangle& t : mesh.triangles)
        for (const auto& [i, j] : {std::pair{t.a, t.b}, std::pair{t.b, t.c}, std::pair{t.c, t.a}}) {
            const std::uint32_t a = number_of[i], b = number_of[j];
            const auto edge = std::minmax(a, b);
            if (a != b && !open.erase(edge)) open.insert(edge);
        }
    const auto apex = static_cast<std::uint32_t>(mesh.positions.size());
    const Box box = box_of(mesh);
    mesh.positions.push_back({0.5f * box.lower[0] + 0.5f * box.upper[0], 0.5f * box.lower[1] + 0.5f * box.upper[1],
                              0.5f * box.lower[2] + 0.5f * box.upper[2]});
    for (const auto& [a, b] : open) mesh.triangles.push_back({a, b, apex});
    return mesh;
}

Mesh in_world(const setka::Scene& scene) {
    Mesh world;
    world.name = "world";
    for (const setka::Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const auto first = static_cast<std::uint32_t>(world.positions.size());
        const auto& m = instance.transform.rows;
        for (const Float3& p : mesh.positions)
            world.positions.push_back({((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3],
                                       ((m[4] * p.x + m[5] * p.y) + m[6] * p.z) + m[7],
                                       ((m[8] * p.x + m[9] * p.y) + m[10] * p.z) + m[11]});
        for (const Triangle& t : mesh.triangles) world.triangles.push_back({first + t.a, first + t.b, first + t.c});
    }
    return world;
}

setka::Scene scene_of(Mesh mesh) {
    setka::Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.emplace_back();
    scene.materials.emplace_back();
    return scene;
}

std::vector<setka::Ray> lines_at(const Mesh& mesh, std::uint64_t seed, std::uint64_t first, std::size_t count) {
    const Box box = box_of(mesh);
    std::vector<setka::Ray> lines(count);
    const auto fill = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            lines[i] = line_at(mesh, box, Lots(seed + (first + i) * 0xd1342543de82ef95u));
    };
    const std::size_t workers = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < workers; ++k)
        threads.emplace_back(fill, count * k / workers, count * (k + 1) / workers);
    for (std::thread& thread : threads) thread.join();
    return lines;
}

}  // namespace support
