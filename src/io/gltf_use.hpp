// SPDX-License-Identifier: MIT
/// What of a glTF file does the scene use that is read, and what of that does assimp get?
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

namespace setka::io::detail {

/// A camera where a node places it.
struct GltfCamera {
    std::size_t node = 0;
    double vertical_fov = 0;  ///< radians; 0 for one without perspective
};

/// What nodes of the file's scene reach. Files may hold more: other scenes, nodes in none, meshes for no
/// node.
struct GltfUse {
    std::vector<bool> nodes, meshes, skins;
    std::vector<GltfCamera> cameras;  ///< in the order of the file's cameras, then of its nodes
    std::vector<bool> weighted;       ///< of each mesh: a morph target stands at another weight than 0
};
/// Nodes must be trees, and references must have been checked.
[[nodiscard]] GltfUse find_used(const nlohmann::json& json);

/// Takes away what assimp is not trusted with, and what it would read although the scene does not use it.
void leave_still_part(nlohmann::json& json, const GltfUse& use);

/// Takes away the morph targets of meshes that no weight moves where the scene stands still.
void leave_weighted_targets(nlohmann::json& json, const GltfUse& use);

/// A texture is only a colour here, so a reference to nothing is no error.
void drop_dangling_textures(nlohmann::json& json);

}  // namespace setka::io::detail
