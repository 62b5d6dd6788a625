// SPDX-License-Identifier: MIT
/// Where does one stand to see a scene that brings no camera, and what lights it? Framing and default lights.
#include <algorithm>
#include <cmath>

#include "core/exact_math.hpp"
#include "scene/vector.hpp"
#include "setka/error.hpp"
#include "setka/scene.hpp"

namespace setka {

namespace {

/// The axes of a view: orthonormal, right-handed with the view along -forward.
struct ViewAxes {
    glm::dvec3 right, up, forward;
};

[[nodiscard]] ViewAxes view_axes(const glm::dvec3& view, const glm::dvec3& up) {
    const glm::dvec3 forward = glm::normalize(view);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    return {right, glm::cross(right, forward), forward};
}

[[nodiscard]] double half_angle_tangent(float vertical_fov_degrees) {
    if (!(vertical_fov_degrees > 0 && vertical_fov_degrees < 180))
        throw Error(ErrorCategory::InvalidArgument,
                    "vertical_fov_degrees = " + std::to_string(vertical_fov_degrees) +
                        "; accepted is above 0 and below 180");
    return exact::tan(vertical_fov_degrees * exact::pi / 360);
}

struct Box {
    glm::dvec3 lower, upper;
    [[nodiscard]] glm::dvec3 centre() const { return (lower + upper) * 0.5; }
    [[nodiscard]] glm::dvec3 size() const { return upper - lower; }
    [[nodiscard]] bool contains(const glm::dvec3& p) const {
        return p.x > lower.x && p.y > lower.y && p.z > lower.z && p.x < upper.x && p.y < upper.y &&
               p.z < upper.z;
    }
};

[[nodiscard]] Box to_box(const Bounds& bounds) {
    const Box box{{bounds.lower[0], bounds.lower[1], bounds.lower[2]},
                  {bounds.upper[0], bounds.upper[1], bounds.upper[2]}};
    const glm::dvec3 size = box.size();
    if (!(size.x >= 0 && size.y >= 0 && size.z >= 0 && std::isfinite(size.x + size.y + size.z)))
        throw Error(ErrorCategory::InvalidArgument,
                    "bounds are empty or not finite; a scene with triangles is needed");
    return box;
}

/// The shortest distance at which floats near `box` still tell eye and target apart.
[[nodiscard]] double smallest_distance(const Box& box) {
    const glm::dvec3 a = glm::abs(box.lower), b = glm::abs(box.upper);
    const double magnitude = std::max({a.x, a.y, a.z, b.x, b.y, b.z});
    return magnitude > 0 ? magnitude * 1e-4 : 1;
}

}  // namespace

Camera frame(const Bounds& bounds, float aspect, float vertical_fov_degrees) {
    if (!(aspect > 0) || !std::isfinite(aspect))
        throw Error(ErrorCategory::InvalidArgument,
                    "aspect = " + std::to_string(aspect) + "; accepted is a positive number");
    constexpr double visible_share = 0.95;  // a margin around the box
    const Box box = to_box(bounds);
    const ViewAxes axes = view_axes({-0.6, -0.35, -1}, {0, 1, 0});
    const double tangent_y = half_angle_tangent(vertical_fov_degrees) * visible_share;
    const double tangent_x = tangent_y * aspect;

    // A corner at (x, y, z) along the axes is in view if |x| and |y| are within its depth times the tangents.
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side{corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5};
        const glm::dvec3 p = side * box.size();
        const double depth_needed = std::max(std::abs(glm::dot(p, axes.right)) / tangent_x,
                                             std::abs(glm::dot(p, axes.up)) / tangent_y);
        distance = std::max(distance, depth_needed - glm::dot(p, axes.forward));
    }
    distance = std::max(distance, smallest_distance(box));

    Camera camera;
    camera.eye = to_float3(box.centre() - axes.forward * distance);
    camera.target = to_float3(box.centre());
    camera.vertical_fov_degrees = vertical_fov_degrees;
    return camera;
}

Camera frame_inside(const Bounds& bounds, float vertical_fov_degrees) {
    (void)half_angle_tangent(vertical_fov_degrees);  // for its check
    const Box box = to_box(bounds);
    const glm::dvec3 size = box.size();
    const glm::dvec3 along = size.x >= size.z ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 0, 1};
    const double length = std::max(std::max(size.x, size.z), smallest_distance(box));
    const glm::dvec3 height{0, size.y, 0};

    Camera camera;
    camera.eye = to_float3(box.centre() - along * (0.3 * length) - height * 0.2);
    camera.target = to_float3(box.centre() + along * (0.2 * length) - height * 0.15);
    camera.vertical_fov_degrees = vertical_fov_degrees;
    return camera;
}

void add_default_lights(Scene& scene, const Camera& camera) {
    const Box box = to_box(scene.bounds());
    const glm::dvec3 eye = to_glm(camera.eye);
    const glm::dvec3 view = to_glm(camera.target) - eye;
    const ViewAxes axes = view_axes(view, to_glm(camera.up));
    // Outside, the light stands as far off as the eye; inside it must stay in the room, and off its side walls.
    const bool is_inside = box.contains(eye);
    const glm::dvec3 size = box.size();
    const double reach = is_inside ? 0.25 * std::min({size.x, size.y, size.z}) : glm::length(view);
    const double aside = is_inside ? 0.3 : 0.7;
    const glm::dvec3 shoulder = eye + (axes.up * 0.7 - axes.right * aside) * reach;
    scene.point_lights.push_back({to_float3(shoulder), {0.6f, 0.58f, 0.55f}, 0});
    scene.point_lights.push_back({camera.eye, {0.08f, 0.085f, 0.095f}, 0});
}

}  // namespace setka
