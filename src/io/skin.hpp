// SPDX-License-Identifier: MIT
/// Where do the vertices of a skinned mesh stand? In world space, with the joints as the file's nodes are.
#pragma once

#include <assimp/matrix4x4.h>

#include <filesystem>
#include <map>
#include <string>

#include "io/raw_mesh.hpp"

struct aiBone;
struct aiMesh;
struct aiNode;
struct aiScene;

namespace setka::io::detail {

/// Linear blend skinning, once, at rest: a vertex is moved by the mean of its joints' matrices, weighted.
/// See glTF 2.0, section 3.7.3.
class Skinner {
  public:
    Skinner(const std::filesystem::path& file, const aiScene& source);

    /// The vertices of a mesh with bones in world space, where no node moves them further. One without any
    /// weight moves with the mesh's node. Throws InvalidData for a joint that is not in the scene.
    [[nodiscard]] RawMesh pose(RawMesh mesh, const aiMesh& source) const;

  private:
    struct Placed {
        const aiNode* node;
        aiMatrix4x4 world;
    };
    struct Blend;
    [[nodiscard]] std::vector<Blend> blend(const aiMesh& source, const std::string& mesh) const;
    [[nodiscard]] Matrix34 world(const Placed& placed) const;

    const std::filesystem::path& file_;
    std::map<std::string, Placed> joints_;        ///< by the name of the node
    std::map<const aiMesh*, Placed> mesh_nodes_;  ///< of meshes with bones
};

}  // namespace setka::io::detail
