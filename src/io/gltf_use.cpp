// SPDX-License-Identifier: MIT
/// What of a glTF file does the scene use that is read, and what of that does assimp get? See the header.
#include "io/gltf_use.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace setka::io::detail {

namespace {

using Json = nlohmann::json;

/// A list of the file or of a node; empty if it is missing.
const Json& list(const Json& object, const char* key) {
    static const Json none = Json::array();
    const auto found = object.find(key);
    return found == object.end() ? none : *found;
}

std::vector<GltfCamera> find_cameras(const Json& json, const std::vector<bool>& used) {
    std::vector<std::pair<std::size_t, std::size_t>> numbers;  // of the camera, then of the node
    for (std::size_t node = 0; node < used.size(); ++node)
        if (used[node] && json["nodes"][node].contains("camera"))
            numbers.emplace_back(json["nodes"][node]["camera"].get<std::size_t>(), node);
    std::ranges::sort(numbers);
    std::vector<GltfCamera> cameras;
    for (const auto& [camera, node] : numbers) {
        // Absent or orthographic: 0, which is no angle.
        const Json perspective = json["cameras"][camera].value("perspective", Json::object());
        cameras.push_back({node, perspective.value("yfov", 0.0)});
    }
    return cameras;
}

bool has_weight(const Json& object) {
    return std::ranges::any_of(list(object, "weights"), [](const Json& weight) { return weight != 0; });
}

void drop_dangling_textures(const Json& root, Json& value) {
    if (value.is_object() || value.is_array())
        for (Json& inner : value) drop_dangling_textures(root, inner);
    if (!value.is_object()) return;
    for (const char* key : {"baseColorTexture", "diffuseTexture"}) {
        if (!value.contains(key)) continue;
        const std::uint64_t index = value[key].value("index", std::uint64_t(0xffffffff));
        const Json& textures = list(root, "textures");
        const bool known = index < textures.size() && textures[index].contains("source") &&
                           textures[index]["source"].get<std::uint64_t>() < list(root, "images").size();
        if (!known) value.erase(key);
    }
}

}  // namespace

GltfUse find_used(const Json& json) {
    GltfUse use;
    use.nodes.resize(list(json, "nodes").size());
    use.meshes.resize(list(json, "meshes").size());
    use.weighted.resize(use.meshes.size());
    use.skins.resize(list(json, "skins").size());
    std::vector<std::size_t> open;
    for (const Json& root : list(json["scenes"][json.value("scene", std::size_t(0))], "nodes"))
        open.push_back(root.get<std::size_t>());
    while (!open.empty()) {
        const std::size_t number = open.back();
        open.pop_back();
        use.nodes[number] = true;
        const Json& node = json["nodes"][number];
        if (node.contains("mesh")) {
            const auto mesh = node["mesh"].get<std::size_t>();
            use.meshes[mesh] = true;
            // The node's own weights count, where it has some.
            if (has_weight(node.contains("weights") ? node : json["meshes"][mesh])) use.weighted[mesh] = true;
        }
        if (node.contains("skin")) use.skins[node["skin"].get<std::size_t>()] = true;
        for (const Json& child : list(node, "children")) open.push_back(child.get<std::size_t>());
    }
    use.cameras = find_cameras(json, use.nodes);
    return use;
}

void leave_still_part(Json& json, const GltfUse& use) {
    json.erase("animations");  // assimp drops steps and tangents without a word
    for (std::size_t i = 0; i < use.nodes.size(); ++i) {
        Json& node = json["nodes"][i];
        node.erase("weights");
        if (use.nodes[i]) continue;
        // assimp reads the joints of every skin, with all that is below them, into the scene.
        for (const char* key : {"mesh", "skin", "camera", "children", "extensions"}) node.erase(key);
    }
    for (std::size_t i = 0; i < use.meshes.size(); ++i) {
        json["meshes"][i].erase("weights");
        for (Json& primitive : json["meshes"][i]["primitives"]) primitive.erase("targets");
    }
}

void leave_weighted_targets(Json& json, const GltfUse& use) {
    for (std::size_t i = 0; i < use.meshes.size(); ++i) {
        if (use.weighted[i]) continue;
        Json& mesh = json["meshes"][i];
        if (!mesh.contains("primitives")) continue;
        for (Json& primitive : mesh["primitives"]) primitive.erase("targets");
    }
}

void drop_dangling_textures(Json& json) { drop_dangling_textures(json, json); }

}  // namespace setka::io::detail
