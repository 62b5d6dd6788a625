// SPDX-License-Identifier: MIT
/// Is a hit plausible? The crossing of ray and triangle by another formula (Moeller & Trumbore 1997) in
/// double precision.
#include <algorithm>
#include <cmath>

#include "oracle/oracle.hpp"

namespace oracle {

namespace {

struct Vec3d {
    double x, y, z;
};

Vec3d wide(const float* p) { return {p[0], p[1], p[2]}; }
Vec3d minus(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3d cross(const Vec3d& a, const Vec3d& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(const Vec3d& a) { return std::sqrt(dot(a, a)); }

}  // namespace

RoughHit rough_hit(const WorldTriangle& triangle, const Ray& ray) {
    const Vec3d v0 = wide(triangle.vertex[0].at);
    const Vec3d e1 = minus(wide(triangle.vertex[1].at), v0);
    const Vec3d e2 = minus(wide(triangle.vertex[2].at), v0);
    const Vec3d d = wide(ray.direction);
    const Vec3d p = cross(d, e2);
    const double det = dot(e1, p);
    if (det == 0) return {};
    const Vec3d s = minus(wide(ray.origin), v0);
    const Vec3d q = cross(s, e1);
    RoughHit hit;
    hit.u = dot(s, p) / det;
    hit.v = dot(d, q) / det;
    hit.t = dot(e2, q) / det;
    hit.margin = std::min({hit.u, hit.v, 1 - hit.u - hit.v});
    const Vec3d n = cross(e1, e2);
    const double longest = std::max({length(e1), length(e2), length(minus(e1, e2))});
    const double cosine = std::fabs(dot(n, d)) / (length(n) * length(d));
    hit.conditioning = cosine * (length(n) / (longest * longest));
    return hit;
}

}  // namespace oracle
