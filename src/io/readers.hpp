// SPDX-License-Identifier: MIT
/// Who reads which format? PLY, STL and OFF have readers here; OBJ and glTF go through assimp, glTF after a
/// check.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf_document.hpp"
#include "io/gltf_use.hpp"
#include "io/raw_mesh.hpp"
#include "setka/scene.hpp"

namespace setka::io::detail {

/// Polygon File Format, ASCII and both binary orders; elements vertex, face and tristrips.
[[nodiscard]] std::vector<RawMesh> read_ply(const std::filesystem::path& file, std::string_view bytes);
/// Stereolithography, ASCII (a mesh per solid) and binary. Its facet normals are ignored: they say nothing
/// that the corners do not, and are often zero.
[[nodiscard]] std::vector<RawMesh> read_stl(const std::filesystem::path& file, std::string_view bytes);
/// Object File Format, ASCII, with or without normals and colours.
[[nodiscard]] std::vector<RawMesh> read_off(const std::filesystem::path& file, std::string_view bytes);

/// OBJ through assimp, in UTF-8 or UTF-16.
[[nodiscard]] Scene read_obj(const std::filesystem::path& file, std::string bytes);
/// glTF and GLB through assimp, after check_gltf; morph targets at the weights of the file.
[[nodiscard]] Scene read_gltf(const std::filesystem::path& file, std::string bytes);

/// The statements of an OBJ text that setka reads, indices checked and made absolute.
/// Throws InvalidData, naming the line, for a face that is malformed or whose vertex does not exist.
[[nodiscard]] std::string filter_obj(const std::filesystem::path& file, std::string text);

/// The statements of an MTL text that setka reads; what is malformed is left out, as a missing file would be.
[[nodiscard]] std::string filter_mtl(std::string_view text);

/// A glTF file that was checked: bytes that assimp can be trusted with, and what it must make of them.
struct CheckedGltf {
    std::string bytes;                              ///< the file again, reduced to what stands
    std::uint64_t triangle_count = 0;               ///< of all meshes that its scene uses, each once
    bool has_weights = false;                       ///< morph targets count where it stands still, too
    std::vector<GltfCamera> cameras;                ///< that its scene uses; their nodes are named "node 7" and so on
    std::shared_ptr<const GltfDocument> document;  ///< of GltfFilePart::Posed and Moving: the rest, too
};
/// Throws InvalidData for wrong types, references, ranges and unsupported extensions.
[[nodiscard]] CheckedGltf check_gltf(const std::filesystem::path& file, const std::string& bytes,
                                     GltfFilePart part);

}  // namespace setka::io::detail
