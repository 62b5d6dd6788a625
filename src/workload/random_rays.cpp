// SPDX-License-Identifier: MIT
/// Which rays find mistakes? See the header. Only + - * / on floats, so that every machine traces the same
/// rays.
#include "workload/random_rays.hpp"

#include <algorithm>
#include <limits>

#include "scene/transform.hpp"

namespace setka::workload {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

[[nodiscard]] Ray make_ray(const Float3& origin, const Float3& direction, float tmin = 0,
                           float tmax = infinity) {
    return {{origin.x, origin.y, origin.z}, tmin, {direction.x, direction.y, direction.z}, tmax};
}

[[nodiscard]] Float3 difference(const Float3& a, const Float3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Uniform over directions: points of a cube that lie in the unit ball, and not too near its middle.
[[nodiscard]] Float3 random_direction(Random& random) {
    for (;;) {
        const float x = 2 * random.unit() - 1;
        const float y = 2 * random.unit() - 1;
        const float z = 2 * random.unit() - 1;
        const float square = x * x + y * y + z * z;
        if (square <= 1 && square > 1e-4f) return {x, y, z};
    }
}

}  // namespace

std::uint64_t Random::operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

float Random::unit() { return static_cast<float>((*this)() >> 40) * 0x1p-24f; }

std::uint32_t Random::below(std::uint32_t count) {
    return static_cast<std::uint32_t>((((*this)() >> 32) * count) >> 32);
}

const char* to_string(RayKind kind) noexcept {
    switch (kind) {
        case RayKind::Random:
            return "random";
        case RayKind::AxisAligned:
            return "axis-aligned";
        case RayKind::EdgeAimed:
            return "edge-aimed";
    }
    return "?";
}

RandomRays::RandomRays(const Scene& scene, const SetkaGridHeader& header, std::uint64_t seed)
    : scene_(scene), header_(header), seed_(Random(seed)()), bounds_(scene.bounds()) {
    std::uint64_t count = 0;
    for (const Instance& instance : scene.instances) {
        starts_.push_back(count);
        count += scene.meshes[instance.mesh].triangles.size();
    }
    starts_.push_back(count);
}

Ray RandomRays::operator()(std::uint64_t index) const {
    Random random(seed_ + index * 0xd1342543de82ef95u);
    switch (kind(index)) {
        case RayKind::Random:
            return random_ray(random);
        case RayKind::AxisAligned:
            return axis_ray(random);
        case RayKind::EdgeAimed:
            return edge_ray(random);
    }
    return {};
}

Ray RandomRays::random_ray(Random& random) const {
    const Float3 origin = point_in_box(random, 2);
    const Float3 direction = random_direction(random);
    if (random.below(8) != 0) return make_ray(origin, direction);
    // A bounded ray: between two distances of the order of the scene.
    const float a = random.unit() * header_.extent;
    const float b = random.unit() * header_.extent;
    return make_ray(origin, direction, std::min(a, b), std::max(a, b));
}

Ray RandomRays::axis_ray(Random& random) const {
    float origin[3];
    const Float3 vertex = random_triangle(random).vertices[random.below(3)];
    const float vertex_values[3] = {vertex.x, vertex.y, vertex.z};
    for (int axis = 0; axis < 3; ++axis) {
        const float lower = bounds_.lower[axis];
        const float size = bounds_.upper[axis] - lower;
        switch (random.below(4)) {
            case 0:
                origin[axis] = vertex_values[axis];
                break;
            case 1:  // a plane between cells
                origin[axis] = header_.origin[axis] +
                               static_cast<float>(random.below(header_.dims[axis] + 1)) * header_.cell_size;
                break;
            case 2:
                origin[axis] = random.below(2) != 0 ? bounds_.upper[axis] : lower;
                break;
            default:  // a lattice over the box and a quarter around it
                origin[axis] = lower + size * ((static_cast<float>(random.below(25)) - 4) / 16.0f);
        }
    }
    float direction[3];
    for (float& component : direction) component = random.below(2) != 0 ? 0.0f : -0.0f;
    const std::uint32_t along = random.below(3);
    direction[along] = random.below(2) != 0 ? 1.0f : -1.0f;
    // Most rays start off the box, so that they cross all of it.
    if (random.below(4) != 0)
        origin[along] = direction[along] > 0 ? bounds_.lower[along] - header_.extent
                                             : bounds_.upper[along] + header_.extent;
    return make_ray({origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]});
}

Ray RandomRays::edge_ray(Random& random) const {
    const WorldTriangle triangle = random_triangle(random);
    const std::uint32_t corner = random.below(3);
    const Float3& a = triangle.vertices[corner];
    const Float3& b = triangle.vertices[(corner + 1) % 3];
    float along = 0;  // the vertex itself
    switch (random.below(4)) {
        case 0:
            break;
        case 1:
            along = 0.5f;
            break;
        default:
            along = random.unit();
    }
    const Float3 point{a.x + along * (b.x - a.x), a.y + along * (b.y - a.y), a.z + along * (b.z - a.z)};
    switch (random.below(8)) {
        case 0:
            return make_ray(point, random_direction(random));  // starts on the edge
        case 1: {                                              // ends on it
            const Float3 origin = point_in_box(random, 1);
            return make_ray(origin, difference(point, origin), 0, 1);
        }
        case 2:
            return make_ray(a, difference(b, a));  // runs along it
        default: {
            const Float3 origin = point_in_box(random, random.below(2) != 0 ? 1.0f : 3.0f);
            return make_ray(origin, difference(point, origin));
        }
    }
}

Float3 RandomRays::point_in_box(Random& random, float scale) const {
    float point[3];
    for (int axis = 0; axis < 3; ++axis) {
        const float middle = 0.5f * bounds_.lower[axis] + 0.5f * bounds_.upper[axis];
        // A flat box has no inside; rays must still be able to leave its plane.
        const float size = std::max(bounds_.upper[axis] - bounds_.lower[axis], 0.125f * header_.extent);
        point[axis] = middle + (random.unit() - 0.5f) * scale * size;
    }
    return {point[0], point[1], point[2]};
}

RandomRays::WorldTriangle RandomRays::random_triangle(Random& random) const {
    const std::uint64_t number = random.below(static_cast<std::uint32_t>(starts_.back()));
    // The last instance that starts at or before the number: ones without triangles start where the next one
    // does.
    const auto at = std::ranges::upper_bound(starts_, number) - starts_.begin() - 1;
    const Instance& instance = scene_.instances[static_cast<std::size_t>(at)];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const Triangle& triangle = mesh.triangles[number - starts_[static_cast<std::size_t>(at)]];
    const auto vertex = [&](std::uint32_t index) {
        return transform_point(instance.transform, mesh.positions[index]);
    };
    return {{vertex(triangle.a), vertex(triangle.b), vertex(triangle.c)}};
}

}  // namespace setka::workload
