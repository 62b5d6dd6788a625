// SPDX-License-Identifier: MIT
/// What are the right tables and the right hits? A second, scalar implementation of the specification in
/// src/README.md, one loop after another and without a line of the library's code: only its plain structs are
/// shared.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "setka/grid.hpp"
#include "setka/layout.h"
#include "setka/scene.hpp"
#include "setka/tracer.hpp"

namespace oracle {

using setka::Bounds;
using setka::GridOptions;
using setka::GridResolution;
using setka::Hit;
using setka::Primitive;
using setka::Ray;
using setka::Scene;

struct Vec3 {
    float at[3];
    float& operator[](int axis) { return at[axis]; }
    float operator[](int axis) const { return at[axis]; }
};

/// A scene's triangle in world space with what a hit says of it.
struct WorldTriangle {
    Vec3 vertex[3];
    std::uint32_t primitive;  ///< within its mesh
    std::uint32_t instance;
    std::uint32_t mask;
};

struct World {
    std::vector<WorldTriangle> triangles;
    std::uint32_t instance_count = 0;
    Bounds bounds{};
    float extent = 0;  ///< the longest side of `bounds`
};

/// Section "World geometry".
[[nodiscard]] World make_world(const Scene& scene);

/// Section "Resolution".
[[nodiscard]] GridResolution resolution(const Bounds& bounds, std::uint32_t triangle_count,
                                        const GridOptions& options);

/// The header without `reference_count`.
[[nodiscard]] SetkaGridHeader make_header(const World& world, const GridOptions& options);

/// The three tables as SetkaGridHeader lays them down.
struct Tables {
    SetkaGridHeader header{};
    std::vector<std::int32_t> offsets;
    std::vector<std::uint32_t> counts;
    std::vector<std::uint32_t> references;
};

/// Section "Cell lists".
[[nodiscard]] Tables make_tables(const World& world, const GridOptions& options);

/// A cell in the upper half, a triangle in the lower: ordered as the references are.
using Pair = std::uint64_t;
[[nodiscard]] constexpr Pair make_pair(std::uint64_t cell, std::uint32_t triangle) {
    return cell << 32 | triangle;
}

/// Every pair that the tables list, in order.
[[nodiscard]] std::vector<Pair> listed_pairs(const Tables& tables);

/// Every pair of a closed triangle and a closed cell with a common point, in order, decided in double
/// precision. Cells are unit cubes in the coordinates (p - origin) * inverse_cell_size, `margin` wider on
/// every side; the last cell of an axis has no upper end, since points beyond it are counted to it.
[[nodiscard]] std::vector<Pair> overlapping_pairs(const World& world, const SetkaGridHeader& header,
                                                  double margin = 0);

/// Section "Rays and hits": the closest hit of each ray among the triangles whose mask shares a bit with
/// `mask`.
[[nodiscard]] std::vector<Hit> closest_hits(const World& world, std::span<const Ray> rays,
                                            std::uint32_t mask = ~SETKA_MASK_OPAQUE);

/// Section "All hits": those of each ray, without the triangle skip[i]; an empty `skip` leaves none out.
[[nodiscard]] std::vector<std::vector<Hit>> all_hits(const World& world, std::span<const Ray> rays,
                                                     std::span<const Primitive> skip = {},
                                                     std::uint32_t mask = ~SETKA_MASK_OPAQUE);

/// A hit calculated another way (Moeller & Trumbore 1997, in double precision), to judge by tolerance.
struct RoughHit {
    double t = 0, u = 0, v = 0;
    double conditioning =
        0;  ///< 0 to 1: |cosine| of ray and normal, times how far the triangle is from being a sliver
    double margin = 0;  ///< the smallest barycentric coordinate: how far inside the triangle the point is
};

/// The crossing of a ray with a triangle's plane; conditioning is 0 if there is none.
[[nodiscard]] RoughHit rough_hit(const WorldTriangle& triangle, const Ray& ray);

}  // namespace oracle
