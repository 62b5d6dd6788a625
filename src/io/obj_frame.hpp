// SPDX-License-Identifier: MIT
/// What of an OBJ file can differ from frame to frame, and what becomes of its corners in the scene?
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/raw_mesh.hpp"
#include "setka/scene.hpp"

namespace setka::io::detail {

/// Vertices and faces as they are written: OBJ knows which corners are one vertex, and assimp forgets it.
struct ObjFrame {
    static constexpr std::uint32_t no_normal = 0xffffffffu;
    std::vector<Float3> positions, normals;
    std::vector<std::uint32_t> corners;         ///< of all faces: numbers of positions
    std::vector<std::uint32_t> corner_normals;  ///< as many numbers of normals, or no_normal
    std::vector<std::uint32_t> face_ends;
};
/// Reads what filter_obj returned.
[[nodiscard]] ObjFrame parse_obj_frame(std::string_view filtered);

/// The same text with a vertex of its own for each corner, whose position tells the corner's number.
[[nodiscard]] std::string corner_numbers(std::string_view filtered);
[[nodiscard]] std::uint32_t corner_of(float x, float y, float z);

/// A scene whose vertices are known by the corner of the file that they were.
struct TracedObj {
    struct Part {
        std::uint32_t mesh = 0;
        std::vector<std::uint32_t> corners;  ///< of each vertex
        NormalsFrom normals_from = NormalsFrom::File;
    };
    Scene scene;
    std::vector<Part> parts;
};
/// `frame` is what parse_obj_frame makes of the same text.
[[nodiscard]] TracedObj read_traced_obj(const std::filesystem::path& file, const std::string& filtered,
                                        const ObjFrame& frame);

}  // namespace setka::io::detail
