// SPDX-License-Identifier: MIT
/// Where do the vertices of a mesh stand that joints or morph targets move?
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/gltf_document.hpp"
#include "io/gltf_nodes.hpp"
#include "io/raw_mesh.hpp"
#include "setka/scene.hpp"

namespace setka::io::detail {

/// A primitive of a glTF mesh, as it became a mesh of the scene.
struct GltfPart {
    static constexpr std::uint32_t no_mesh = 0xffffffffu;
    std::uint32_t mesh = no_mesh;
    std::shared_ptr<const std::vector<std::uint32_t>> sources;  ///< of each vertex, the one of the accessors
    NormalsFrom normals_from = NormalsFrom::File;
    std::size_t node = 0;       ///< that places it
    std::size_t gltf_mesh = 0;  ///< where it is in the file
    std::size_t primitive = 0;
};

/// Morph targets first, then the skin: the mean of the joints' matrices by weight (glTF 2.0, 3.7.2
/// and 3.7.3).
class GltfDeformer {
  public:
    /// `mesh` is the part's in the scene, at rest. Throws InvalidData for joints and targets that contradict
    /// themselves.
    GltfDeformer(const GltfDocument& document, const GltfPart& part, const Mesh& mesh);

    /// True for a part that nothing but its node moves.
    [[nodiscard]] bool is_rigid() const { return targets_.empty() && joints_.empty(); }
    /// True for vertices in the world, which no node places.
    [[nodiscard]] bool is_skinned() const { return !joints_.empty(); }
    [[nodiscard]] bool is_moved(const GltfNodes& nodes) const;
    /// The vertices: of a skinned mesh in the world, of others in the space of their node. Several threads
    /// work on large ones. Throws InvalidData for one that is not finite.
    [[nodiscard]] SceneUpdate::Vertices at(const GltfNodes& nodes, std::span<const Rows> worlds,
                                           double seconds) const;

  private:
    struct Target {
        std::vector<Float3> positions, normals;  ///< what is added; each may be empty
    };
    struct Influence {
        std::array<std::uint16_t, 4> joints{};
        std::array<double, 4> weights{};
    };
    void read_targets(const nlohmann::json& primitive, std::size_t raw_count);
    void read_skin(const nlohmann::json& primitive, std::size_t raw_count);
    [[nodiscard]] std::vector<Float3> vectors(std::uint64_t accessor, std::size_t raw_count) const;
    [[noreturn]] void fail(const std::string& reason) const;

    const GltfDocument* document_;
    std::string what_;
    std::uint32_t mesh_;
    std::size_t node_;
    std::shared_ptr<const std::vector<std::uint32_t>> sources_;
    std::vector<Triangle> triangles_;
    std::vector<Float3> positions_, normals_;  ///< as the file has them; normals are empty if they are made
    NormalRecipe recipe_;
    std::vector<Target> targets_;
    std::vector<std::size_t> joints_;  ///< nodes
    std::vector<Rows> inverse_binds_;
    std::vector<Influence> influences_;  ///< of each vertex, if there are joints
};

}  // namespace setka::io::detail
