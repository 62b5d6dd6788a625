// SPDX-License-Identifier: MIT
/// How are the bodies of built-in scenes tessellated? In doubles, with roots and angles that are equal on
/// every machine.
#include "scene/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/exact_math.hpp"
#include "scene/vector.hpp"

namespace setka::shapes {

namespace {

void add_vertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal) {
    mesh.positions.push_back(to_float3(position));
    mesh.normals.push_back(to_float3(normal));
}

[[nodiscard]] exact::SinCos turn(std::uint32_t step, std::uint32_t steps) {
    return exact::sin_cos(2 * exact::pi * step / steps);
}

}  // namespace

Mesh cube() {
    Mesh mesh;
    mesh.name = "cube";
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back({corner & 1 ? 1.f : -1.f, corner & 2 ? 1.f : -1.f, corner & 4 ? 1.f : -1.f});
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

Mesh sphere(std::uint32_t frequency) {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    const std::array<glm::dvec3, 12> corners{{{-1, golden, 0},
                                              {1, golden, 0},
                                              {-1, -golden, 0},
                                              {1, -golden, 0},
                                              {0, -1, golden},
                                              {0, 1, golden},
                                              {0, -1, -golden},
                                              {0, 1, -golden},
                                              {golden, 0, -1},
                                              {golden, 0, 1},
                                              {-golden, 0, -1},
                                              {-golden, 0, 1}}};
    constexpr std::uint8_t faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                           {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                           {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                           {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    Mesh mesh;
    mesh.name = "sphere";
    const std::uint32_t n = frequency;
    for (const auto& face : faces) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t row = 0; row <= n; ++row)
            for (std::uint32_t k = 0; k <= row; ++k) {
                // Weights that add up to n; on an edge one is 0, and the sum of the other two does not depend
                // on order.
                const glm::dvec3 p = corners[face[0]] * double(n - row) + corners[face[1]] * double(row - k) +
                                     corners[face[2]] * double(k);
                const glm::dvec3 unit = p / std::sqrt(glm::dot(p, p));
                add_vertex(mesh, unit, unit);
            }
        const auto index = [&](std::uint32_t row, std::uint32_t k) {
            return first + row * (row + 1) / 2 + k;
        };
        for (std::uint32_t row = 0; row < n; ++row)
            for (std::uint32_t k = 0; k <= row; ++k) {
                mesh.triangles.push_back({index(row, k), index(row + 1, k), index(row + 1, k + 1)});
                if (k < row)
                    mesh.triangles.push_back({index(row, k), index(row + 1, k + 1), index(row, k + 1)});
            }
    }
    return mesh;
}

Mesh torus(double radius, double tube_radius, std::uint32_t around, std::uint32_t across) {
    Mesh mesh;
    mesh.name = "torus";
    add_patch(mesh, around, across, Seam::Closed, Seam::Closed, [&](std::uint32_t i, std::uint32_t j) {
        const auto [sin_around, cos_around] = turn(i, around);
        const auto [sin_across, cos_across] = turn(j, across);
        const glm::dvec3 normal{cos_across * cos_around, -sin_across, cos_across * sin_around};
        const glm::dvec3 centre{radius * cos_around, 0, radius * sin_around};
        add_vertex(mesh, centre + normal * tube_radius, normal);
    });
    return mesh;
}

Mesh torus_knot(const KnotShape& shape) {
    // The curve and its derivative by the angle; the frame around it leans on the torus's own normal, which
    // never is parallel to the curve, so the tube closes without a twist.
    struct Frame {
        glm::dvec3 centre, normal, binormal;
    };
    const auto frame_at = [&](std::uint32_t step) {
        const auto [sin_p, cos_p] = turn(shape.p * step % shape.along, shape.along);
        const auto [sin_q, cos_q] = turn(shape.q * step % shape.along, shape.along);
        const double reach = shape.radius + shape.knot_radius * cos_q;
        const glm::dvec3 centre{reach * cos_p, shape.knot_radius * sin_q, reach * sin_p};
        const double p = shape.p, q = shape.q, r = shape.knot_radius;
        const glm::dvec3 tangent{-p * reach * sin_p - q * r * sin_q * cos_p, q * r * cos_q,
                                 p * reach * cos_p - q * r * sin_q * sin_p};
        const glm::dvec3 outward{cos_q * cos_p, sin_q, cos_q * sin_p};
        const glm::dvec3 binormal = glm::normalize(glm::cross(tangent, outward));
        return Frame{centre, glm::normalize(glm::cross(binormal, tangent)), binormal};
    };
    Mesh mesh;
    mesh.name = "torus knot";
    Frame frame{};
    add_patch(mesh, shape.along, shape.across, Seam::Closed, Seam::Closed,
              [&](std::uint32_t i, std::uint32_t j) {
                  if (j == 0) frame = frame_at(i);
                  const auto [sin, cos] = turn(j, shape.across);
                  const glm::dvec3 normal = frame.normal * cos - frame.binormal * sin;
                  add_vertex(mesh, frame.centre + normal * shape.tube_radius, normal);
              });
    return mesh;
}

Mesh rounded_box(const Float3& half, double radius, std::uint32_t segments) {
    // Each of the six sides is a patch of (2 * segments + 1)^2 quads over the unit sphere's cube map, whose
    // two halves are pulled apart by the inner box.
    const glm::dvec3 inner = to_glm(half) - glm::dvec3(radius);
    const std::uint32_t quads = 2 * segments + 1;
    Mesh mesh;
    mesh.name = "rounded box";
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2;
        const double sign = side % 2 == 0 ? 1 : -1;
        add_patch(mesh, quads, quads, Seam::Open, Seam::Open, [&](std::uint32_t i, std::uint32_t j) {
            // Steps 0 … segments belong to the lower half, the others to the upper half; both meet in the
            // middle (0).
            const auto slope = [&](std::uint32_t step) {
                const double s = step <= segments ? double(step) : double(step) - 1;
                return exact::tan((s / segments - 1) * exact::pi / 4);
            };
            const auto half_of = [&](std::uint32_t step) { return step <= segments ? -1.0 : 1.0; };
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            glm::dvec3 direction, anchor;
            direction[axis] = sign;
            direction[u] = slope(i) * sign;
            direction[v] = slope(j);
            anchor[axis] = sign * inner[axis];
            anchor[u] = half_of(i) * sign * inner[u];
            anchor[v] = half_of(j) * inner[v];
            const glm::dvec3 normal = direction / std::sqrt(glm::dot(direction, direction));
            add_vertex(mesh, anchor + normal * radius, normal);
        });
    }
    return mesh;
}

}  // namespace setka::shapes
