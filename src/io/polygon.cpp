// SPDX-License-Identifier: MIT
/// How is a polygon split into triangles? By a fan if it is convex, else by cutting ears in its dominant
/// plane.
#include <array>
#include <cmath>

#include "io/raw_mesh.hpp"

namespace setka::io::detail {

namespace {

/// Above this many corners a concave polygon becomes a fan: cutting ears takes quadratic to cubic time.
constexpr std::size_t max_ear_corners = 256;

struct Point2 {
    double x, y;
};

/// Twice the signed area of a triangle.
double turn(const Point2& a, const Point2& b, const Point2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners on the axis plane where the polygon's area is largest, turning left as a whole.
std::vector<Point2> project(std::span<const Float3> positions, std::span<const std::uint32_t> corners) {
    const Float3& origin = positions[corners[0]];
    std::array<double, 3> normal{};
    const auto relative = [&](std::size_t i) {
        const Float3& p = positions[corners[i]];
        return std::array<double, 3>{double(p.x) - origin.x, double(p.y) - origin.y, double(p.z) - origin.z};
    };
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {  // Newell's area vector
        const auto a = relative(i), b = relative(i + 1);
        normal[0] += a[1] * b[2] - a[2] * b[1];
        normal[1] += a[2] * b[0] - a[0] * b[2];
        normal[2] += a[0] * b[1] - a[1] * b[0];
    }
    std::size_t axis = 2;
    if (std::abs(normal[0]) > std::abs(normal[axis])) axis = 0;
    if (std::abs(normal[1]) > std::abs(normal[axis])) axis = 1;
    std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    std::vector<Point2> points;
    points.reserve(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto p = relative(i);
        points.push_back({p[u], p[v]});
    }
    return points;
}

/// Convex as seen from the first corner: then a fan from there covers it without overlap.
bool is_convex(const std::vector<Point2>& points) {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i)
        if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0) return false;
    for (std::size_t i = 1; i + 1 < n; ++i)  // a star that winds more than once turns left everywhere as well
        if (turn(points[0], points[i], points[i + 1]) < 0) return false;
    return true;
}

bool is_ear(const std::vector<Point2>& points, const std::vector<std::uint32_t>& ring, std::size_t at) {
    const std::size_t n = ring.size();
    const Point2 &a = points[ring[(at + n - 1) % n]], &b = points[ring[at]], &c = points[ring[(at + 1) % n]];
    if (!(turn(a, b, c) > 0)) return false;
    const auto same = [](const Point2& p, const Point2& q) { return p.x == q.x && p.y == q.y; };
    for (std::size_t i = 2; i + 1 < n; ++i) {
        const Point2& p = points[ring[(at + i) % n]];
        // A repeated corner (the bridge to a hole) touches the ear without lying in it.
        if (same(p, a) || same(p, b) || same(p, c)) continue;
        if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
}

/// The corner to cut next: an ear, else a corner without area, else whatever comes (the polygon crosses
/// itself).
std::size_t next_ear(const std::vector<Point2>& points, const std::vector<std::uint32_t>& ring,
                     std::size_t from) {
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i < n; ++i)
        if (is_ear(points, ring, (from + i) % n)) return (from + i) % n;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t at = (from + i) % n;
        if (turn(points[ring[(at + n - 1) % n]], points[ring[at]], points[ring[(at + 1) % n]]) == 0)
            return at;
    }
    return from % n;
}

}  // namespace

void triangulate(std::span<const Float3> positions, std::span<const std::uint32_t> corners,
                 std::vector<Triangle>& triangles) {
    const std::size_t n = corners.size();
    if (n < 3) return;
    if (n == 3) {
        triangles.push_back({corners[0], corners[1], corners[2]});
        return;
    }
    const std::vector<Point2> points = project(positions, corners);
    if (n > max_ear_corners || is_convex(points)) {
        for (std::size_t i = 1; i + 1 < n; ++i) triangles.push_back({corners[0], corners[i], corners[i + 1]});
        return;
    }
    std::vector<std::uint32_t> ring(n);
    for (std::uint32_t i = 0; i < n; ++i) ring[i] = i;
    std::size_t at = 1;
    while (ring.size() > 3) {
        at = next_ear(points, ring, at);
        const std::size_t m = ring.size();
        triangles.push_back(
            {corners[ring[(at + m - 1) % m]], corners[ring[at]], corners[ring[(at + 1) % m]]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
        if (at == ring.size()) at = 0;
    }
    triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
}

}  // namespace setka::io::detail
