// SPDX-License-Identifier: MIT
/// Which rays does everybody trace? See the header.
#include "workload/standard_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/vector.hpp"
#include "setka/renderer.hpp"
#include "workload/random_rays.hpp"

namespace setka::workload {

namespace {

/// Where the ray meets the triangle, and the unit normal of its face on the ray's side.
struct SurfacePoint {
    glm::vec3 position, normal;
};

[[nodiscard]] SurfacePoint surface_point(const Ray& ray, const Hit& hit, const float* triangle, float lift) {
    const glm::vec3 a{triangle[0], triangle[1], triangle[2]};
    const glm::vec3 b{triangle[3], triangle[4], triangle[5]};
    const glm::vec3 c{triangle[6], triangle[7], triangle[8]};
    const glm::vec3 origin{ray.origin[0], ray.origin[1], ray.origin[2]};
    const glm::vec3 direction{ray.direction[0], ray.direction[1], ray.direction[2]};
    // In units of the longest edge, so that the square of a tiny triangle's area is not lost.
    const glm::vec3 u = b - a, v = c - a;
    const float longest = std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z), std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    const glm::vec3 p = u / longest, q = v / longest;
    glm::vec3 normal{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
    const float length = std::sqrt((normal.x * normal.x + normal.y * normal.y) + normal.z * normal.z);
    const float side = (normal.x * direction.x + normal.y * direction.y) + normal.z * direction.z;
    normal = length > 0 ? normal / (side > 0 ? -length : length) : -direction;
    return {origin + direction * hit.t + normal * lift, normal};
}

/// A point of the unit sphere.
[[nodiscard]] glm::vec3 point_on_sphere(std::uint64_t seed) {
    Random random(seed);
    for (;;) {
        const float x = 2 * random.unit() - 1, y = 2 * random.unit() - 1, z = 2 * random.unit() - 1;
        const float square = (x * x + y * y) + z * z;
        if (square <= 1 && square > 1e-4f) return glm::vec3{x, y, z} / std::sqrt(square);
    }
}

[[nodiscard]] Ray make_ray(const glm::vec3& origin, const glm::vec3& direction, float tmax) {
    return {{origin.x, origin.y, origin.z}, 0, {direction.x, direction.y, direction.z}, tmax};
}

}  // namespace

const char* to_string(Viewpoint viewpoint) noexcept { return viewpoint == Viewpoint::Outside ? "outside" : "inside"; }

StandardView standard_view(const Bounds& bounds, Viewpoint viewpoint) {
    const glm::dvec3 lower{bounds.lower[0], bounds.lower[1], bounds.lower[2]};
    const glm::dvec3 upper{bounds.upper[0], bounds.upper[1], bounds.upper[2]};
    const glm::dvec3 centre = (lower + upper) * 0.5;
    const bool is_inside = viewpoint == Viewpoint::Inside;
    const double diagonal = glm::length(upper - lower);
    const glm::dvec3 way = is_inside ? glm::dvec3{1, 0.05, 0.1} : glm::dvec3{0.6, 0.35, 1};
    const glm::dvec3 eye = centre + way * (diagonal * (is_inside ? 0.12 : 0.9) / glm::length(way));
    const glm::dvec3 to_light =
        is_inside ? glm::dvec3{0, 0.1 * (upper.y - lower.y), 0} : glm::dvec3{0.3, 0.45, 0.2} * diagonal;
    StandardView view;
    view.camera.eye = to_float3(eye);
    view.camera.target = to_float3(centre);
    view.light = to_float3(centre + to_light);
    view.lift = float(diagonal * 1e-4);
    return view;
}

std::vector<Ray> in_places(std::span<const Ray> rays, std::span<const std::uint32_t> pixels, std::size_t size) {
    constexpr Ray none{{0, 0, 0}, 1, {0, 0, 1}, 0};
    std::vector<Ray> all(size, none);
    for (std::size_t i = 0; i < rays.size(); ++i) all[pixels[i]] = rays[i];
    return all;
}

StandardRays standard_rays(Queue& queue, const Structure& structure, const StandardView& view, std::uint32_t size) {
    StandardRays rays;
    rays.primary = camera_rays(queue, view.camera, size, size);
    const auto device_hits = queue.make_buffer<Hit>(rays.primary.size(), "hits");
    Tracer().closest_hit(queue, structure, rays.primary, device_hits);
    const std::vector<Hit> hits = queue.download(device_hits);
    const std::vector<Ray> primary = queue.download(rays.primary);
    const std::vector<float> triangles = queue.download(structure.geometry().triangles);
    const std::vector<std::uint32_t> starts = queue.download(structure.geometry().instance_starts);

    const glm::vec3 light{view.light.x, view.light.y, view.light.z};
    std::vector<Ray> shadow, diffuse;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].primitive == SETKA_NO_HIT) continue;
        rays.pixels.push_back(static_cast<std::uint32_t>(i));
        const std::size_t triangle = std::size_t(starts[hits[i].instance]) + hits[i].primitive;
        const SurfacePoint point = surface_point(primary[i], hits[i], &triangles[9 * triangle], view.lift);
        shadow.push_back(make_ray(point.position, light - point.position, 1));
        // A normal plus a point of the sphere around its end is cosine-distributed; a little less never vanishes.
        diffuse.push_back(make_ray(point.position, point.normal + point_on_sphere(i) * 0.999f,
                                   std::numeric_limits<float>::infinity()));
    }
    rays.shadow = queue.upload(std::span<const Ray>(shadow), "shadow rays");
    rays.diffuse = queue.upload(std::span<const Ray>(diffuse), "diffuse rays");
    return rays;
}

}  // namespace setka::workload
