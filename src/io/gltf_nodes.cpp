// SPDX-License-Identifier: MIT
/// Where do the nodes of a glTF scene stand at a time? See the header.
#include "io/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/file.hpp"

namespace setka::io::detail {

namespace {

using Json = nlohmann::json;

template <std::size_t Count>
void take(const Json& from, const char* key, std::array<double, Count>& to) {
    if (const auto found = from.find(key); found != from.end())
        for (std::size_t i = 0; i < Count; ++i) to[i] = (*found)[i].get<double>();
}

std::size_t target_count(const GltfDocument& document, const Json& node) {
    if (!node.contains("mesh")) return 0;
    std::size_t count = 0;
    for (const Json& primitive : document.element("meshes", node["mesh"].get<std::uint64_t>())["primitives"])
        if (const auto targets = primitive.find("targets"); targets != primitive.end())
            count = std::max(count, targets->size());
    return count;
}

GltfAnimation::Path path_of(const GltfDocument& document, const std::string& word, const std::string& what) {
    using Path = GltfAnimation::Path;
    static constexpr std::pair<const char*, Path> known[] = {{"translation", Path::Translation},
                                                             {"rotation", Path::Rotation},
                                                             {"scale", Path::Scale},
                                                             {"weights", Path::Weights}};
    for (const auto& [name, path] : known)
        if (word == name) return path;
    fail_read(document.file(), what + " moves " + in_quotes(word, 40) +
                                   "; known are translation, rotation, scale and weights");
}

GltfAnimation::Channel read_channel(const GltfDocument& document, const Json& channel, const Json& samplers,
                                    const std::string& what) {
    GltfAnimation::Channel result;
    const Json& target = channel["target"];
    result.node = target["node"].get<std::size_t>();
    const Json& node = document.element("nodes", result.node);
    result.path = path_of(document, target.value("path", std::string()), what);
    const std::uint64_t sampler = channel.value("sampler", std::uint64_t(0xffffffff));
    if (sampler >= samplers.size())
        fail_read(document.file(), what + " has sampler " + std::to_string(sampler) + "; there are " +
                                       std::to_string(samplers.size()));
    if (result.path != GltfAnimation::Path::Weights && node.contains("matrix"))
        fail_read(document.file(), what + " moves node " + std::to_string(result.node) +
                                       ", which has a matrix; translation, rotation and scale are needed");
    const bool is_rotation = result.path == GltfAnimation::Path::Rotation;
    std::size_t width = is_rotation ? 4 : 3;
    Values kind = is_rotation ? Values::Quaternions : Values::Vectors;
    if (result.path == GltfAnimation::Path::Weights) {
        width = target_count(document, node);
        kind = Values::Weights;
        if (width == 0)
            fail_read(document.file(), what + " moves the weights of node " + std::to_string(result.node) +
                                           ", whose mesh has no morph targets");
    }
    result.track = read_track(document, samplers[sampler], width, kind, what);
    return result;
}

}  // namespace

Rows operator*(const Rows& a, const Rows& b) {
    Rows product;
    for (std::size_t row = 0; row < 12; row += 4)
        for (std::size_t column = 0; column < 4; ++column)
            product[row + column] =
                ((a[row] * b[column] + a[row + 1] * b[4 + column]) + a[row + 2] * b[8 + column]) +
                (column == 3 ? a[row + 3] : 0.0);
    return product;
}

Matrix34 to_matrix(const Rows& rows) {
    Matrix34 matrix;
    for (std::size_t i = 0; i < rows.size(); ++i) matrix.rows[i] = static_cast<float>(rows[i]);
    return matrix;
}

std::vector<std::string> animation_names(const GltfDocument& document) {
    std::vector<std::string> names;
    for (const Json& animation : document.list("animations")) {
        const std::string name = animation.value("name", std::string());
        names.push_back(name.empty() ? std::to_string(names.size()) : name);
    }
    return names;
}

GltfAnimation read_animation(const GltfDocument& document, std::size_t index) {
    const Json& json = document.element("animations", index);
    const Json none = Json::array();
    const Json& channels = json.contains("channels") ? json["channels"] : none;
    const Json& samplers = json.contains("samplers") ? json["samplers"] : none;
    const std::string name = in_quotes(animation_names(document)[index], 60);
    GltfAnimation animation;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        // A channel without a node is for an extension, and to be passed over.
        if (!channels[i].contains("target") || !channels[i]["target"].contains("node")) continue;
        animation.channels.push_back(read_channel(document, channels[i], samplers,
                                                  "channel " + std::to_string(i) + " of animation " + name));
        animation.duration_seconds =
            std::max(animation.duration_seconds, animation.channels.back().track.keys->values.back());
    }
    return animation;
}

GltfNodes::GltfNodes(const GltfDocument& document, GltfAnimation animation)
    : document_(document), animation_(std::move(animation)) {
    for (const Json& json : document.list("nodes")) {
        Node node;
        node.matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
        if (json.contains("matrix")) {
            std::array<double, 16> columns;
            take(json, "matrix", columns);
            node.is_affine = columns[3] == 0 && columns[7] == 0 && columns[11] == 0 && columns[15] == 1;
            for (std::size_t i = 0; i < 12; ++i) node.matrix[i] = columns[i % 4 * 4 + i / 4];
            node.has_matrix = true;
        }
        take(json, "translation", node.translation);
        take(json, "rotation", node.rotation);
        take(json, "scale", node.scale);
        const Json* weights = json.contains("weights") ? &json["weights"] : nullptr;
        if (!weights && json.contains("mesh")) {
            const Json& mesh = document.element("meshes", json["mesh"].get<std::uint64_t>());
            if (mesh.contains("weights")) weights = &mesh["weights"];
        }
        if (weights)
            for (const Json& weight : *weights) node.weights.push_back(weight.get<double>());
        nodes_.push_back(std::move(node));
    }
    order();
    for (const GltfAnimation::Channel& channel : animation_.channels) {
        Node& node = nodes_[channel.node];
        (channel.path == GltfAnimation::Path::Weights ? node.has_moving_weights : node.is_moved) = true;
    }
    for (const std::size_t node : order_)
        if (nodes_[parents_[node]].is_moved) nodes_[node].is_moved = true;
}

/// The nodes of the scene are trees without cycles: that was checked.
void GltfNodes::order() {
    parents_.resize(nodes_.size());
    for (std::size_t i = 0; i < parents_.size(); ++i) parents_[i] = i;
    const Json& json = document_.json();
    const Json& scene = document_.element("scenes", json.value("scene", std::uint64_t(0)));
    std::vector<std::size_t> open;
    for (const Json& root : scene.value("nodes", Json::array())) open.push_back(root.get<std::size_t>());
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        order_.push_back(node);
        nodes_[node].is_in_scene = true;
        if (!nodes_[node].is_affine)
            fail_read(document_.file(), "the transform of node " + std::to_string(node) +
                                            " is not affine: its last row must be 0 0 0 1");
        for (const Json& child : document_.element("nodes", node).value("children", Json::array())) {
            parents_[child.get<std::size_t>()] = node;
            open.push_back(child.get<std::size_t>());
        }
    }
}

std::string GltfNodes::label(std::size_t node) const {
    const std::string name = document_.element("nodes", node).value("name", std::string());
    const std::string text = "node " + std::to_string(node);
    return name.empty() || name == text ? text : text + " " + in_quotes(name, 60);
}

Rows GltfNodes::local(const Node& node) {
    if (node.has_matrix) return node.matrix;
    const auto& [qx, qy, qz, qw] = node.rotation;
    const double length = std::sqrt(((qx * qx + qy * qy) + qz * qz) + qw * qw);
    const bool turns = length > 0;
    const double x = turns ? qx / length : 0, y = turns ? qy / length : 0, z = turns ? qz / length : 0;
    const double w = turns ? qw / length : 1;
    const auto& [sx, sy, sz] = node.scale;
    const auto& [tx, ty, tz] = node.translation;
    return {
        (1 - 2 * (y * y + z * z)) * sx, 2 * (x * y - z * w) * sy,       2 * (x * z + y * w) * sz,       tx,
        2 * (x * y + z * w) * sx,       (1 - 2 * (x * x + z * z)) * sy, 2 * (y * z - x * w) * sz,       ty,
        2 * (x * z - y * w) * sx,       2 * (y * z + x * w) * sy,       (1 - 2 * (x * x + y * y)) * sz, tz};
}

std::vector<Rows> GltfNodes::world(double seconds) const {
    std::vector<Node> moved = nodes_;
    for (const GltfAnimation::Channel& channel : animation_.channels) {
        const std::vector<double> value = channel.track.at(seconds);
        Node& node = moved[channel.node];
        if (channel.path == GltfAnimation::Path::Translation)
            std::copy_n(value.begin(), 3, node.translation.begin());
        if (channel.path == GltfAnimation::Path::Scale) std::copy_n(value.begin(), 3, node.scale.begin());
        if (channel.path == GltfAnimation::Path::Rotation)
            std::copy_n(value.begin(), 4, node.rotation.begin());
    }
    std::vector<Rows> worlds(nodes_.size(), Rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    for (const std::size_t node : order_) {
        const Rows own = local(moved[node]);
        worlds[node] = parents_[node] == node ? own : worlds[parents_[node]] * own;
        // As floats, which is what an instance has.
        if (!std::ranges::all_of(worlds[node], [](double v) { return std::isfinite(static_cast<float>(v)); }))
            fail_read(document_.file(), "the transform of " + label(node) + " is not finite at " +
                                            std::to_string(seconds) + " s");
    }
    return worlds;
}

std::vector<double> GltfNodes::weights(std::size_t node, std::size_t count, double seconds) const {
    std::vector<double> weights = nodes_[node].weights;
    for (const GltfAnimation::Channel& channel : animation_.channels)
        if (channel.node == node && channel.path == GltfAnimation::Path::Weights)
            weights = channel.track.at(seconds);
    weights.resize(count, 0.0);
    return weights;
}

}  // namespace setka::io::detail
