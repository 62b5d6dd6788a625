// SPDX-License-Identifier: MIT
/// Which normals does a mesh get whose file has none? Around each vertex, a corner's normal is the
/// area-weighted sum over the faces that lie within 45 degrees of the corner's own face.
#include <algorithm>
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
Vector area_vector(std::span<const Float3> positions, const Triangle& t) {
    const Vector e1 = subtract(positions[t.b], positions[t.a]);
    const Vector e2 = subtract(positions[t.c], positions[t.a]);
    return {e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x};
}

/// A triangle without area has no normal; it is never hit.
Float3 normal_of(const Vector& area) {
    const Float3 normal = to_float(unit(area));
    return normal == Float3{} ? Float3{0, 0, 1} : normal;
}

std::uint32_t& corner(Triangle& t, std::uint32_t i) { return i == 0 ? t.a : i == 1 ? t.b : t.c; }

/// For each vertex the corners (3 * triangle + 0..2) that meet there, as one list with starts.
struct Corners {
    std::vector<std::uint32_t> starts, list;
};

Corners corners_by_vertex(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
    Corners corners;
    corners.starts.assign(vertex_count + 1, 0);
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : {t.a, t.b, t.c}) ++corners.starts[v + 1];
    for (std::size_t i = 1; i < corners.starts.size(); ++i) corners.starts[i] += corners.starts[i - 1];
    corners.list.resize(triangles.size() * 3);
    std::vector<std::uint32_t> next(corners.starts.begin(), corners.starts.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const std::uint32_t vertices[] = {triangles[t].a, triangles[t].b, triangles[t].c};
        for (std::uint32_t i = 0; i < 3; ++i) corners.list[next[vertices[i]]++] = 3 * t + i;
    }
    return corners;
}

}  // namespace

std::vector<std::uint32_t> make_normals(Mesh& mesh) {
    std::vector<Vector> areas(mesh.triangles.size()), directions(mesh.triangles.size());
    for (std::size_t t = 0; t < areas.size(); ++t) {
        areas[t] = area_vector(mesh.positions, mesh.triangles[t]);
        directions[t] = unit(areas[t]);
    }
    const Corners corners = corners_by_vertex(mesh.triangles, mesh.positions.size());
    const auto vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.normals.assign(vertex_count, Float3{});
    std::vector<std::uint32_t> repeated;
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
            const Float3 normal = normal_of(sum);
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
                    repeated.push_back(v);
                }
                made.emplace_back(normal, vertex);
            }
            corner(mesh.triangles[own / 3], own % 3) = made[i].second;
        }
    }
    return repeated;
}

NormalRecipe normal_recipe(const Mesh& mesh, std::span<const std::uint32_t> sources) {
    std::vector<Vector> directions(mesh.triangles.size());
    for (std::size_t t = 0; t < directions.size(); ++t)
        directions[t] = unit(area_vector(mesh.positions, mesh.triangles[t]));
    // As they were before vertices were repeated, around each source.
    std::uint32_t source_count = 0;
    for (const std::uint32_t source : sources) source_count = std::max(source_count, source + 1);
    std::vector<Triangle> joined = mesh.triangles;
    for (Triangle& t : joined) t = {sources[t.a], sources[t.b], sources[t.c]};
    const Corners corners = corners_by_vertex(joined, source_count);
    std::vector<std::uint32_t> first_face(sources.size(), 0);
    for (auto t = static_cast<std::uint32_t>(mesh.triangles.size()); t-- > 0;)
        for (const std::uint32_t v : {mesh.triangles[t].a, mesh.triangles[t].b, mesh.triangles[t].c})
            first_face[v] = t;

    NormalRecipe recipe;
    recipe.starts.push_back(0);
    for (std::size_t v = 0; v < sources.size(); ++v) {
        const std::uint32_t own = first_face[v], source = sources[v];
        const auto around =
            std::span(corners.list)
                .subspan(corners.starts[source], corners.starts[source + 1] - corners.starts[source]);
        if (around.size() > max_smooth_faces) recipe.faces.push_back(own);
        else
            for (const std::uint32_t other : around)
                if (other / 3 == own || dot(directions[own], directions[other / 3]) >= crease_cosine)
                    recipe.faces.push_back(other / 3);
        recipe.starts.push_back(static_cast<std::uint32_t>(recipe.faces.size()));
    }
    return recipe;
}

std::vector<Float3> remake_normals(const NormalRecipe& recipe, std::span<const Triangle> triangles,
                                   std::span<const Float3> positions) {
    std::vector<Vector> areas(triangles.size());
    for (std::size_t t = 0; t < areas.size(); ++t) areas[t] = area_vector(positions, triangles[t]);
    std::vector<Float3> normals(recipe.starts.size() - 1);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        Vector sum;
        for (std::uint32_t i = recipe.starts[v]; i < recipe.starts[v + 1]; ++i) {
            const Vector& area = areas[recipe.faces[i]];
            sum = {sum.x + area.x, sum.y + area.y, sum.z + area.z};
        }
        normals[v] = normal_of(sum);
    }
    return normals;
}

}  // namespace setka::io::detail
