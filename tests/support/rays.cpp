// SPDX-License-Identifier: MIT
/// How are the rays made? Each kind is one function of a random generator and the world's triangles.
#include "support/rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/random.hpp"

namespace support {

namespace {

using oracle::Ray;
using oracle::Vec3;
using oracle::World;

constexpr float infinity = std::numeric_limits<float>::infinity();

class RayMaker {
  public:
    RayMaker(const World& world, std::uint64_t seed) : world_(world), random_(seed) {
        size_ = world.extent > 0 ? world.extent : 1.0f;
    }

    Ray through_box() { return toward(around(1.5f), inside(), 0, infinity); }
    Ray from_inside() { return toward(inside(), inside(), 0, infinity); }

    /// Along an axis through a vertex or anywhere, the other components 0, -0 or denormal.
    Ray along_axis() {
        const Vec3 target = random_.below(2) ? vertex() : inside();
        const int axis = static_cast<int>(random_.below(3));
        constexpr float small[] = {0.0f, -0.0f, 1e-45f, -1e-45f, 1e-40f, 1e-38f, -1e-33f, 1e-29f};
        Ray ray{{}, 0, {}, infinity};
        for (int k = 0; k < 3; ++k) {
            ray.direction[k] = small[random_.below(std::size(small))];
            ray.origin[k] = target[k];
        }
        ray.direction[axis] = random_.below(2) ? 1.0f : -1.0f;
        ray.origin[axis] -= ray.direction[axis] * size_ * random_.between(-0.5f, 3);
        return ray;
    }

    /// Along an axis beside the box or on a face of it.
    Ray grazing() {
        Ray ray = along_axis();
        const int axis = static_cast<int>(random_.below(3));
        const float face = random_.below(2) ? world_.bounds.lower[axis] : world_.bounds.upper[axis];
        constexpr float off[] = {0, 0, 1e-7f, -1e-7f, 1.5e-5f, -1.5e-5f, 2e-5f, -2e-5f};
        ray.origin[axis] = face + off[random_.below(std::size(off))] * size_;
        return ray;
    }

    Ray at_vertex() { return toward(around(1.5f), vertex(), 0, infinity); }
    Ray from_vertex() { return toward(vertex(), vertex(), 0, infinity); }

    Ray at_edge() {
        const auto& t = triangle();
        const std::uint32_t k = random_.below(3);
        const float share = random_.below(2) ? 0.5f : random_.unit();
        return toward(around(1.5f), mix(t.vertex[k], t.vertex[(k + 1) % 3], share), 0, infinity);
    }

    /// In a triangle's own plane.
    Ray in_plane() {
        const auto& t = triangle();
        const Vec3 a = mix(t.vertex[0], t.vertex[1], random_.between(-3, 3));
        return toward(a, mix(t.vertex[1], t.vertex[2], random_.unit()), -infinity, infinity);
    }

    Ray from_afar() {
        constexpr float distances[] = {10, 1e3f, 1e6f, 1e9f};
        return toward(around(distances[random_.below(4)]), inside(), 0, infinity);
    }

    /// From far away with a component too small for its inverse times the distance to be finite.
    Ray from_afar_nearly_parallel() {
        Ray ray = along_axis();
        for (int k = 0; k < 3; ++k)
            if (std::fabs(ray.direction[k]) < 1) {
                ray.direction[k] = random_.below(2) ? 1e-30f : -8e-31f;
                if (random_.below(2)) ray.origin[k] += size_ * (random_.below(2) ? 1e9f : -3e8f);
            }
        return ray;
    }

    Ray scaled() {
        Ray ray = random_.below(2) ? through_box() : at_vertex();
        constexpr float scales[] = {1e-42f, 1e-38f, 1e-30f, 1e-20f, 1e-10f, 1e10f, 1e20f, 1e30f, 3e37f};
        const float scale = scales[random_.below(std::size(scales))];
        const float longest =
            std::max({std::fabs(ray.direction[0]), std::fabs(ray.direction[1]), std::fabs(ray.direction[2])});
        if (longest > 0)
            for (float& component : ray.direction) component = component / longest * scale;
        return ray;
    }

    /// Parameters around 1, where toward() puts its target.
    Ray window() {
        Ray ray = random_.below(2) ? at_vertex() : through_box();
        ray.tmin = random_.between(-2, 1.5f);
        ray.tmax = ray.tmin + random_.unit() * 2;
        if (random_.below(4) == 0) ray.tmin = -infinity;
        if (random_.below(4) == 0) ray.tmax = infinity;
        if (random_.below(8) == 0) ray.tmax = ray.tmin;
        return ray;
    }

    Ray backwards() {
        Ray ray = toward(around(3), inside(), -infinity, infinity);
        for (float& component : ray.direction) component = -component;
        if (random_.below(2)) ray.tmax = 0;
        return ray;
    }

    /// What must hit nothing, with an ordinary ray in between.
    Ray invalid() {
        Ray ray = through_box();
        const int axis = static_cast<int>(random_.below(3));
        constexpr float bad[] = {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity};
        const float value = bad[random_.below(3)];
        switch (random_.below(8)) {
            case 0:
                ray.origin[axis] = value;
                break;
            case 1:
                ray.direction[axis] = value;
                break;
            case 2:
                ray.tmin = bad[0];
                break;
            case 3:
                ray.tmax = bad[0];
                break;
            case 4:
                std::fill_n(ray.direction, 3, random_.below(2) ? 0.0f : -0.0f);
                break;
            case 5:
                std::swap(ray.tmin, ray.tmax);
                break;
            case 6:
                ray.tmin = infinity;
                break;
            default:
                break;
        }
        return ray;
    }

    /// Finite numbers at the ends of the range.
    Ray enormous() {
        Ray ray = random_.below(2) ? along_axis() : through_box();
        for (float& component : ray.origin)
            if (random_.below(2)) component = random_.below(2) ? 3e38f : -3e38f;
        if (random_.below(2)) ray.direction[random_.below(3)] = 3e38f;
        return ray;
    }

    /// A ray next to `ray`, `spread` times the extent from it where it starts, or where it would be at t = 1.
    Ray neighbour(const Ray& ray, float spread, bool origin_moves, bool target_moves) {
        Ray next = ray;
        const float longest =
            std::max({std::fabs(ray.direction[0]), std::fabs(ray.direction[1]), std::fabs(ray.direction[2])});
        for (int k = 0; k < 3; ++k) {
            const float by = spread * random_.between(-1, 1);
            if (origin_moves) next.origin[k] += by * size_;
            if (origin_moves && !target_moves) next.direction[k] -= by * size_;
            if (target_moves && (!origin_moves || random_.below(2))) next.direction[k] += spread * longest * random_.between(-1, 1);
        }
        return next;
    }

    /// Any bits at all.
    Ray noise() {
        const auto any = [&] {
            const auto bits = static_cast<std::uint32_t>(random_.bits());
            float value = 0;
            static_assert(sizeof value == sizeof bits);
            std::copy_n(reinterpret_cast<const char*>(&bits), sizeof bits, reinterpret_cast<char*>(&value));
            return value;
        };
        Ray ray{{}, any(), {}, any()};
        for (float& component : ray.origin) component = any();
        for (float& component : ray.direction) component = any();
        return ray;
    }

  private:
    const oracle::WorldTriangle& triangle() {
        return world_.triangles[random_.below(world_.triangles.size())];
    }
    Vec3 vertex() { return triangle().vertex[random_.below(3)]; }
    static Vec3 mix(const Vec3& a, const Vec3& b, float share) {
        Vec3 result{};
        for (int k = 0; k < 3; ++k) result[k] = a[k] + (b[k] - a[k]) * share;
        return result;
    }
    Vec3 inside() {
        Vec3 result{};
        for (int k = 0; k < 3; ++k)
            result[k] = random_.between(world_.bounds.lower[k], world_.bounds.upper[k]);
        return result;
    }
    /// A point of the cube around the middle, `times` the extent from it on each side.
    Vec3 around(float times) {
        Vec3 result{};
        for (int k = 0; k < 3; ++k)
            result[k] = 0.5f * (world_.bounds.lower[k] + world_.bounds.upper[k]) +
                        times * size_ * random_.between(-1, 1);
        return result;
    }
    static Ray toward(const Vec3& from, const Vec3& to, float tmin, float tmax) {
        return {{from[0], from[1], from[2]}, tmin, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, tmax};
    }

    const World& world_;
    Random random_;
    float size_;
};

struct Kind {
    const char* name;
    Ray (RayMaker::*make)();
};

constexpr Kind kinds[] = {
    {"through the box", &RayMaker::through_box},
    {"from inside", &RayMaker::from_inside},
    {"along an axis", &RayMaker::along_axis},
    {"grazing a face", &RayMaker::grazing},
    {"at a vertex", &RayMaker::at_vertex},
    {"from vertex to vertex", &RayMaker::from_vertex},
    {"at an edge", &RayMaker::at_edge},
    {"in a triangle's plane", &RayMaker::in_plane},
    {"from afar", &RayMaker::from_afar},
    {"from afar, nearly parallel to an axis", &RayMaker::from_afar_nearly_parallel},
    {"with a scaled direction", &RayMaker::scaled},
    {"with a window of t", &RayMaker::window},
    {"backwards", &RayMaker::backwards},
    {"invalid", &RayMaker::invalid},
    {"enormous", &RayMaker::enormous},
    {"noise", &RayMaker::noise},
};

}  // namespace

const std::vector<std::string>& ray_kinds() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> result;
        for (const Kind& kind : kinds) result.emplace_back(kind.name);
        return result;
    }();
    return all;
}

std::vector<Ray> bundled_rays(const World& world, std::size_t count, std::uint64_t seed) {
    RayMaker maker(world, seed);
    Random random(seed + 1);
    std::vector<Ray> rays;
    rays.reserve(count);
    constexpr float spreads[] = {0, 1e-7f, 1e-4f, 1e-2f, 0.03f, 0.2f};
    constexpr std::size_t bundle = 128;
    Ray leader{};
    float spread = 0;
    std::uint32_t moves = 0;
    bool strangers = false;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % bundle == 0) {
            leader = (maker.*kinds[i / bundle % std::size(kinds)].make)();
            spread = spreads[random.below(std::size(spreads))];
            moves = random.below(3) + 1;
            strangers = random.below(2) == 0;
        }
        if (strangers && random.below(16) == 0) rays.push_back((maker.*kinds[random.below(std::size(kinds))].make)());
        else rays.push_back(maker.neighbour(leader, spread, (moves & 1) != 0, (moves & 2) != 0));
    }
    return rays;
}

std::vector<Ray> adversarial_rays(const World& world, std::size_t count, std::uint64_t seed) {
    RayMaker maker(world, seed);
    std::vector<Ray> rays;
    rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) rays.push_back((maker.*kinds[i % std::size(kinds)].make)());
    return rays;
}

}  // namespace support
