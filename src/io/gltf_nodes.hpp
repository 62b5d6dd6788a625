// SPDX-License-Identifier: MIT
/// Where do the nodes of a glTF scene stand at a time, and what do its animations move?
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf_document.hpp"
#include "io/gltf_track.hpp"
#include "setka/scene.hpp"

namespace setka::io::detail {

/// An affine map in double: three rows of four.
using Rows = std::array<double, 12>;

[[nodiscard]] Rows operator*(const Rows& a, const Rows& b);
[[nodiscard]] Matrix34 to_matrix(const Rows& rows);

/// The properties that one animation moves.
struct GltfAnimation {
    enum class Path { Translation, Rotation, Scale, Weights };
    struct Channel {
        std::size_t node = 0;
        Path path = Path::Translation;
        Track track;
    };
    std::vector<Channel> channels;
    double duration_seconds = 0;  ///< the last key of all
};

/// The names of all animations; what has none is called by its number.
[[nodiscard]] std::vector<std::string> animation_names(const GltfDocument& document);
/// Throws InvalidData that names animation and channel for what contradicts itself.
[[nodiscard]] GltfAnimation read_animation(const GltfDocument& document, std::size_t index);

/// The nodes of a file's scene, as one animation moves them.
class GltfNodes {
  public:
    GltfNodes(const GltfDocument& document, GltfAnimation animation);

    [[nodiscard]] const GltfAnimation& animation() const { return animation_; }
    /// The world transform of each node; of those outside the scene, the identity. Throws InvalidData that
    /// names node and time where one is not finite.
    [[nodiscard]] std::vector<Rows> world(double seconds) const;
    /// The weights of the morph targets of a node's mesh, as many as there are.
    [[nodiscard]] std::vector<double> weights(std::size_t node, std::size_t count, double seconds) const;
    /// True if the node or one above it is moved.
    [[nodiscard]] bool is_moved(std::size_t node) const { return nodes_[node].is_moved; }
    [[nodiscard]] bool has_moving_weights(std::size_t node) const { return nodes_[node].has_moving_weights; }
    [[nodiscard]] bool is_in_scene(std::size_t node) const { return nodes_[node].is_in_scene; }
    /// "node 3 'wheel'".
    [[nodiscard]] std::string label(std::size_t node) const;
    [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  private:
    struct Node {
        Rows matrix;  ///< used if there is no more to it
        std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
        std::array<double, 4> rotation{0, 0, 0, 1};
        std::vector<double> weights;
        bool has_matrix = false, is_affine = true;
        bool is_moved = false, has_moving_weights = false, is_in_scene = false;
    };
    void order();
    [[nodiscard]] static Rows local(const Node& node);

    const GltfDocument& document_;
    GltfAnimation animation_;
    std::vector<Node> nodes_;
    std::vector<std::size_t> parents_;  ///< its own number: a root
    std::vector<std::size_t> order_;    ///< parents before children
};

}  // namespace setka::io::detail
