// SPDX-License-Identifier: MIT
/// Which shapes are built-in scenes made of? Patches of a parametric surface, and a few closed bodies made of
/// them.
#pragma once

#include <cstdint>

#include "setka/scene.hpp"

namespace setka::shapes {

/// Whether the last row or column of a patch continues with its first one.
enum class Seam { Open, Closed };

/// Adds a patch of rows x columns quads, two triangles each, over the points `point(i, j)` (a Float3 or a
/// position-normal pair is up to `add_vertex`), where i runs over rows and j over columns. Triangles of the
/// quad at (i, j), which wind counter-clockwise seen from the side of d/di x d/dj: (i,j) (i+1,j) (i+1,j+1)
/// and (i,j) (i+1,j+1) (i,j+1).
template <typename AddVertex>
void add_patch(Mesh& mesh, std::uint32_t rows, std::uint32_t columns, Seam row_seam, Seam column_seam,
               const AddVertex& add_vertex) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const std::uint32_t row_points = rows + (row_seam == Seam::Open);
    const std::uint32_t column_points = columns + (column_seam == Seam::Open);
    for (std::uint32_t i = 0; i < row_points; ++i)
        for (std::uint32_t j = 0; j < column_points; ++j) add_vertex(i, j);
    const auto index = [&](std::uint32_t i, std::uint32_t j) {
        return first + (i % row_points) * column_points + j % column_points;
    };
    mesh.triangles.reserve(mesh.triangles.size() + std::size_t{2} * rows * columns);
    for (std::uint32_t i = 0; i < rows; ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
}

/// The cube [-1, 1]^3: 12 triangles, flat.
[[nodiscard]] Mesh cube();

/// The unit sphere as an icosahedron with each edge in `frequency` parts: 20 * frequency^2 triangles, smooth.
/// Points on a shared edge are equal bit for bit, so the sphere is closed although faces do not share
/// vertices.
[[nodiscard]] Mesh sphere(std::uint32_t frequency);

/// A torus around the y axis, smooth: 2 * around * across triangles.
[[nodiscard]] Mesh torus(double radius, double tube_radius, std::uint32_t around, std::uint32_t across);

/// A tube along the (p, q) torus knot, which winds p times around the y axis and q times around the torus's
/// tube.
struct KnotShape {
    std::uint32_t p = 2, q = 3;
    double radius = 1, knot_radius = 0.4, tube_radius = 0.2;
    std::uint32_t along = 256, across = 32;
};
[[nodiscard]] Mesh torus_knot(const KnotShape& shape);

/// A box with rounded edges, half sizes `half` and edge radius `radius` in `segments` steps, smooth.
[[nodiscard]] Mesh rounded_box(const Float3& half, double radius, std::uint32_t segments);

}  // namespace setka::shapes
