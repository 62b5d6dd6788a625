// SPDX-License-Identifier: MIT
#include "view/fly_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace setka::view {

namespace {

struct Vector {
    double x, y, z;
};

Vector vector_of(const Float3& a) { return {a.x, a.y, a.z}; }
Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator*(const Vector& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Vector& a) { return std::sqrt(dot(a, a)); }
Vector unit(const Vector& a) { return a * (1 / length(a)); }
Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Float3 rounded(const Vector& a) { return {float(a.x), float(a.y), float(a.z)}; }

/// The target of an eye that looks this way: so far off that the two differ after rounding, however far the eye is.
Float3 target_of(const Float3& eye, const Vector& forward, double distance) {
    const Vector from = vector_of(eye);
    return rounded(from + forward * std::max(distance, 0x1p-12 * length(from)));
}

/// `v` turned around the unit vector `axis` (Rodrigues).
Vector turned(const Vector& v, const Vector& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

struct Axes {
    Vector forward, right, up;
    double distance;  ///< to the target
};

Axes axes_of(const Camera& camera) {
    const Vector gaze = vector_of(camera.target) + vector_of(camera.eye) * -1.0;
    const Vector forward = unit(gaze), up = unit(vector_of(camera.up));
    return {forward, unit(cross(forward, up)), up, length(gaze)};
}

}  // namespace

void FlyCamera::move(double forward, double right, double up) {
    const Axes axes = axes_of(now_);
    const Vector step = axes.forward * forward + axes.right * right + axes.up * up;
    now_.eye = rounded(vector_of(now_.eye) + step);
    now_.target = target_of(now_.eye, axes.forward, axes.distance);
}

void FlyCamera::turn(double right_degrees, double up_degrees) {
    constexpr double degree = std::numbers::pi / 180, least = 1 * degree;
    const Axes axes = axes_of(now_);
    const double height = std::acos(std::clamp(dot(axes.forward, axes.up), -1.0, 1.0));  // from the zenith
    const double lift = height - std::clamp(height - up_degrees * degree, least, std::numbers::pi - least);
    const Vector gaze = turned(turned(axes.forward, axes.right, lift), axes.up, -right_degrees * degree);
    now_.target = target_of(now_.eye, gaze, axes.distance);
}

}  // namespace setka::view
