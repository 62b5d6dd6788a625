// SPDX-License-Identifier: MIT
/// How does a camera become rays? A basis from square roots alone, scaled by the exact tangent of half the
/// field of view.
#include "trace/pinhole.hpp"

#include <cmath>
#include <string>

#include "core/exact_math.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"
#include "setka/renderer.hpp"

namespace setka {

namespace {

struct Vector {
    double x, y, z;
};

double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vector scaled(const Vector& a, double factor) { return {a.x * factor, a.y * factor, a.z * factor}; }
Vector unit(const Vector& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }

bool is_finite(const Float3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

std::string text(const Float3& a) {
    return "(" + std::to_string(a.x) + ", " + std::to_string(a.y) + ", " + std::to_string(a.z) + ")";
}

void store(float (&target)[3], const Vector& value) {
    target[0] = static_cast<float>(value.x);
    target[1] = static_cast<float>(value.y);
    target[2] = static_cast<float>(value.z);
}

void check_camera(const Camera& camera) {
    if (!is_finite(camera.eye) || !is_finite(camera.target) || !is_finite(camera.up))
        throw Error(ErrorCategory::InvalidData, "camera eye " + text(camera.eye) + ", target " +
                                                    text(camera.target) + ", up " + text(camera.up) +
                                                    " must be finite");
    if (!(camera.vertical_fov_degrees > 0 && camera.vertical_fov_degrees < 180))
        throw Error(ErrorCategory::InvalidData, "camera vertical_fov_degrees is " +
                                                    std::to_string(camera.vertical_fov_degrees) +
                                                    "; it must be above 0 and below 180");
    if (camera.eye == camera.target)
        throw Error(ErrorCategory::InvalidData,
                    "camera eye and target are both " + text(camera.eye) + "; they must differ");
}

}  // namespace

void check_range(std::string_view name, std::uint32_t value, std::uint32_t low, std::uint32_t high) {
    if (value < low || value > high)
        throw Error(ErrorCategory::InvalidArgument, std::string(name) + " is " + std::to_string(value) +
                                                        "; it must be from " + std::to_string(low) + " to " +
                                                        std::to_string(high));
}

void check_picture(std::uint32_t width, std::uint32_t height, std::uint32_t samples_per_axis) {
    check_range("width", width, 1, 16384);
    check_range("height", height, 1, 16384);
    check_range("samples_per_axis", samples_per_axis, 1, 16);
}

SkCamera make_pinhole(const Camera& camera, std::uint32_t width, std::uint32_t height,
                      std::uint32_t samples_per_axis) {
    check_camera(camera);
    const Vector forward =
        unit({double(camera.target.x) - camera.eye.x, double(camera.target.y) - camera.eye.y,
              double(camera.target.z) - camera.eye.z});
    const Vector up{camera.up.x, camera.up.y, camera.up.z};
    const Vector side = cross(forward, up);
    // The sine of the angle between the two: below a millionth the picture's upright would be noise.
    if (!(dot(side, side) > 1e-12 * dot(up, up)))
        throw Error(ErrorCategory::InvalidData,
                    "camera up " + text(camera.up) +
                        " must not be zero or parallel to the direction from eye to target");
    const Vector right = unit(side);
    const double half_height = exact::tan(camera.vertical_fov_degrees * exact::pi / 360);
    const double half_width = half_height * width / height;

    SkCamera result{};
    store(result.eye, {camera.eye.x, camera.eye.y, camera.eye.z});
    store(result.forward, forward);
    store(result.right, scaled(right, half_width));
    store(result.up, scaled(cross(right, forward), half_height));
    result.step_x = static_cast<float>(2.0 / (double(width) * samples_per_axis));
    result.step_y = static_cast<float>(2.0 / (double(height) * samples_per_axis));
    result.width = width;
    result.samples_per_axis = samples_per_axis;
    return result;
}

Buffer<Ray> camera_rays(Queue& queue, const Camera& camera, std::uint32_t width, std::uint32_t height,
                        std::uint32_t samples_per_axis) {
    check_picture(width, height, samples_per_axis);
    const std::uint64_t count = std::uint64_t(width) * height * samples_per_axis * samples_per_axis;
    if (count > 0x7fffffffu)
        throw Error(ErrorCategory::InvalidArgument,
                    "width * height * samples_per_axis^2 is " + std::to_string(count) +
                        " rays; one buffer of them must have at most " + std::to_string(0x7fffffffu));
    const SkCamera pinhole = make_pinhole(camera, width, height, samples_per_axis);
    Buffer<Ray> rays = queue.make_buffer<Ray>(count, "camera rays");
    queue.impl().begin_stage("camera rays");
    launch_items(queue, Kernel::shade_camera_rays, static_cast<std::uint32_t>(count), pinhole,
                 std::uint32_t(0), std::uint32_t(0), samples_per_axis * samples_per_axis, rays);
    return rays;
}

}  // namespace setka
