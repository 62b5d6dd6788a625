// SPDX-License-Identifier: MIT
/// What do all mesh readers have in common? Polygons as a file holds them, and the one way in which they
/// become a Mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "setka/scene.hpp"

namespace setka::io::detail {

/// Whether a file says which corners are one vertex.
enum class Sharing {
    ByIndex,     ///< it does: vertices stay as they are
    ByPosition,  ///< it does not (STL, unrolled OBJ): corners with the same bits become one vertex
};

/// Polygons with their vertices, as read. Faces with fewer than three corners are points and lines.
struct RawMesh {
    std::string name;
    std::vector<Float3> positions;
    std::vector<Float3> normals;           ///< one per position, or empty
    std::vector<Float3> colors;            ///< one per position, linear from 0 to 1, or empty
    std::vector<std::uint32_t> corners;    ///< the vertices of all faces
    std::vector<std::uint32_t> face_ends;  ///< where in `corners` each face ends
    Sharing sharing = Sharing::ByIndex;

    /// Ends the face whose corners were just added.
    void end_face() { face_ends.push_back(static_cast<std::uint32_t>(corners.size())); }
};

/// Triangulates, welds, drops vertices that no triangle uses and makes normals where the file has none that
/// can be used. Every polygon of n corners gives n - 2 triangles, degenerate ones included, with the winding
/// of the file. The result has no triangle if the file has only points and lines. Throws InvalidData, naming
/// `file`, mesh and vertex, for an index out of range or a non-finite vertex that is used.
[[nodiscard]] Mesh finish_mesh(const std::filesystem::path& file, RawMesh raw);

/// Whose normals a mesh has.
enum class NormalsFrom { File, Faces };

/// A mesh that can be moved later: what became of each vertex is known.
struct TracedMesh {
    Mesh mesh;
    std::vector<std::uint32_t> sources;  ///< of each vertex, the one of the RawMesh
    NormalsFrom normals_from = NormalsFrom::File;
};
/// The same mesh, traced.
[[nodiscard]] TracedMesh finish_traced_mesh(const std::filesystem::path& file, RawMesh raw);

/// Splits a polygon into corners.size() - 2 triangles: a fan where it is convex, by cutting ears where it is
/// not.
void triangulate(std::span<const Float3> positions, std::span<const std::uint32_t> corners,
                 std::vector<Triangle>& triangles);

/// Gives a mesh smooth normals, split where faces meet at more than 45 degrees: a split vertex is repeated at
/// the end of the positions. Triangles keep their order, their winding and the positions of their corners.
/// Returns the vertex that each of those at the end repeats.
std::vector<std::uint32_t> make_normals(Mesh& mesh);

/// Which faces make up each normal of a mesh whose normals were made: they stay so when it moves.
struct NormalRecipe {
    std::vector<std::uint32_t> starts, faces;  ///< of vertex v: faces[starts[v]] to faces[starts[v + 1]]
};
/// The recipe by which make_normals made them, from where the mesh stands; `sources` tells which vertices
/// were one.
[[nodiscard]] NormalRecipe normal_recipe(const Mesh& mesh, std::span<const std::uint32_t> sources);
/// The normals of the same triangles at other positions.
[[nodiscard]] std::vector<Float3> remake_normals(const NormalRecipe& recipe,
                                                 std::span<const Triangle> triangles,
                                                 std::span<const Float3> positions);

}  // namespace setka::io::detail
