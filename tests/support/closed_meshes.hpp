// SPDX-License-Identifier: MIT
/// Which meshes have an inside, and which rays try to slip through their edges?
#pragma once

#include <cstdint>
#include <vector>

#include "setka/scene.hpp"

namespace support {

/// A ball of 20 * 4^levels triangles whose vertices are rounded at `centre`: far away many of them coincide.
[[nodiscard]] setka::Mesh icosphere(std::uint32_t levels, const setka::Float3& centre, float radius);

/// `mesh` with triangles from each edge that an odd number of triangles have, by vertex position, to one point. Every edge then
/// has an even number, whatever the mesh was, so that every line passes an even number of triangles.
[[nodiscard]] setka::Mesh close(setka::Mesh mesh);

/// All instances of a scene as one mesh in world space, as the library places them.
[[nodiscard]] setka::Mesh in_world(const setka::Scene& scene);

/// One mesh, one instance.
[[nodiscard]] setka::Scene scene_of(setka::Mesh mesh);

/// Whole lines (tmin = -infinity) that meet vertices, edges and faces of `mesh`, half of them along an axis or in a plane of two axes, so
/// that edge functions are exactly 0. Line i is a function of mesh, seed and i; made with all cores.
[[nodiscard]] std::vector<setka::Ray> lines_at(const setka::Mesh& mesh, std::uint64_t seed, std::uint64_t first,
                                               std::size_t count);

}  // namespace support
