// SPDX-License-Identifier: MIT
/// Which normals does a mesh get whose file has none? Around each vertex, a corner's normal is the
/// area-weighted sum over the faces that lie within 45 degrees of the corner's own face.
#include <cmath>

#include "io/raw_mesh.hpp"

namespace setka::io::detail {

namespace {

/// cos 45 degrees: edges sharper than this stay sharp.
constexpr double crease_cosine = 0.70710678118654752;
/// A vertex with more faces keeps one normal a face: smoothing takes quadratic time in their number.
constexpr std::uint32_t max_smooth_faces = 64;

struct Vector {
    double x = 0, y = 0, z = 0;
};

double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector subtract(const Float3& a, const Float3& b) {
    return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
}

Vector unit(const Vector& v) {
    const double length = std::sqrt(dot(v, v));
    return length > 0 && std::isfinite(length) ? Vector{v.x / length, v.y / length, v.z / length} : Vector{};
}

Float3 to_float(const Vector& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Twice a triangle's area along its normal. In double, so that no finite triangle overflows.
Vector area_vector(const Mesh& mesh, const Triangle& t) {
    const Vector e1 = subtract(mesh.positions[t.b], mesh.positions[t.a]);
    const Vector e2 = subtract(mesh.positions[t.c], mesh.positions[t.a]);
    return {e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
}

std::uint32_t& corner(Triangle& t, std::uint32_t i) { return i == 0 ? t.a : i == 1 ? t.b : t.c; }

/// For each vertex the corners (3 * triangle + 0..2) that meet there, as one list with starts.
struct Corners {
    std::vector<std::uint32_t> starts, list;
};

Corners corners_by_vertex(Mesh& mesh) {
    Corners corners;
    corners.starts.assign(mesh.positions.size() + 1, 0);
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : {t.a, t.b, t.c}) ++corners.starts[v + 1];
    for (std::size_t i = 1; i < corners.starts.size(); ++i) corners.starts[i] += corners.starts[i - 1];
    corners.list.resize(mesh.triangles.size() * 3);
    std::vector<std::uint32_t> next(corners.starts.begin(), corners.starts.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint32_t i = 0; i < 3; ++i) corners.list[next[corner(mesh.triangles[t], i)]++] = 3 * t + i;
    return corners;
}

}  // namespace

void make_normals(Mesh& mesh) {
    std::vector<Vector> areas(mesh.triangles.size()), directions(mesh.triangles.size());
    for (std::size_t t = 0; t < areas.size(); ++t) {
        areas[t] = area_vector(mesh, mesh.triangles[t]);
        directions[t] = unit(areas[t]);
    }
    const Corners corners = corners_by_vertex(mesh);
    const auto vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.normals.assign(vertex_count, Float3{});
    std::vector<std::pair<Float3, std::uint32_t>>
        made;  // the normals of one vertex so far, with their vertices
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const auto around =
            std::span(corners.list).subspan(corners.starts[v], corners.starts[v + 1] - corners.starts[v]);
        made.clear();
        for (const std::uint32_t own : around) {
            const Vector& direction = directions[own / 3];
            Vector sum = areas[own / 3];
            if (around.size() <= max_smooth_faces) {
                sum = {};
                for (const std::uint32_t other : around) {
                    if (other != own && !(dot(direction, directions[other / 3]) >= crease_cosine)) continue;
                    const Vector& area = areas[other / 3];
                    sum = {sum.x + area.x, sum.y + area.y, sum.z + area.z};
                }
            }
            Float3 normal = to_float(unit(sum));
            if (normal == Float3{})
                normal = {0, 0, 1};  // a triangle without area has no normal; it is never hit
            std::size_t i = 0;
            // Only the last few: a vertex of thousands of faces must not cost quadratic time here either.
            for (i = made.size() > max_smooth_faces ? made.size() - max_smooth_faces : 0; i < made.size();
                 ++i)
                if (made[i].first == normal) break;
            if (i == made.size()) {
                std::uint32_t vertex = v;
                if (made.empty()) {
                    mesh.normals[v] = normal;
                } else {
                    vertex = static_cast<std::uint32_t>(mesh.positions.size());
                    mesh.positions.push_back(Float3(mesh.positions[v]));
                    mesh.normals.push_back(normal);
                }
                made.emplace_back(normal, vertex);
            }
            corner(mesh.triangles[own / 3], own % 3) = made[i].second;
        }
    }
}

}  // namespace setka::io::detail
