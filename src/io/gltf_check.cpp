// SPDX-License-Identifier: MIT
/// Can assimp be trusted with this glTF file? assimp 5.2 follows node cycles without end, drops triangles
/// with an index out of range without a word, and assumes JSON types. So the JSON is copied through a schema
/// of what setka reads (unknown extensions stay behind; animations, morph targets and what the scene does not
/// use never reach assimp), and every reference and range in the copy is checked.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/file.hpp"
#include "io/gltf_container.hpp"
#include "io/gltf_schema.hpp"
#include "io/gltf_use.hpp"
#include "io/readers.hpp"

namespace setka::io::detail {

namespace {

using Json = nlohmann::json;

constexpr std::uint64_t max_accessor_count = std::uint64_t(1) << 28;
constexpr std::size_t max_node_depth = 256;
/// Of all primitives that a skin moves; assimp takes a kilobyte for each.
constexpr std::size_t max_joints = std::size_t(1) << 20;
/// Of all copies of meshes that further nodes need.
constexpr std::size_t max_copied_targets = std::size_t(1) << 20;

class GltfChecker {
  public:
    GltfChecker(const std::filesystem::path& file, Json json, const GltfContainer& container)
        : file_(file), json_(std::move(json)), container_(container) {}

    [[nodiscard]] CheckedGltf check(GltfFilePart part) {
        for (std::size_t i = 0; i < size("buffers"); ++i) check_buffer(json_["buffers"][i], i);
        for (std::size_t i = 0; i < size("bufferViews"); ++i) {
            const Json& view = json_["bufferViews"][i];
            const Json& buffer = target(view, "buffer", "buffers");
            check_range(view.value("byteOffset", std::uint64_t(0)), number(view, "byteLength"),
                        number(buffer, "byteLength"), "bufferView " + std::to_string(i));
        }
        for (std::size_t i = 0; i < size("accessors"); ++i) check_accessor(json_["accessors"][i], i);
        for (std::size_t i = 0; i < size("images"); ++i)
            if (json_["images"][i].contains("bufferView"))
                (void)target(json_["images"][i], "bufferView", "bufferViews");
        drop_dangling_textures(json_);
        check_nodes();
        if (part == GltfFilePart::Posed) leave_weighted_targets(json_, find_used(json_));
        separate_skinned_meshes();
        CheckedGltf checked;
        std::vector<std::uint64_t> triangles;  // of each mesh
        for (std::size_t i = 0; i < size("meshes"); ++i)
            triangles.push_back(check_mesh(json_["meshes"][i], i));
        use_ = find_used(json_);
        for (std::size_t i = 0; i < size("skins"); ++i) check_skin(json_["skins"][i], i);
        for (std::size_t i = 0; i < triangles.size(); ++i)
            if (use_.meshes[i]) checked.triangle_count += triangles[i];
        checked.has_weights = std::ranges::find(use_.weighted, true) != use_.weighted.end();
        checked.cameras = use_.cameras;
        if (part != GltfFilePart::Still)
            checked.document = std::make_shared<const GltfDocument>(file_, json_, container_.binary);
        leave_still_part(json_, use_);
        checked.bytes = close_container(json_.dump(), container_);
        return checked;
    }

  private:
    [[nodiscard]] std::size_t size(const char* key) const {
        return json_.contains(key) ? json_[key].size() : 0;
    }

    [[nodiscard]] std::uint64_t number(const Json& object, const char* key) const {
        if (!object.contains(key)) fail_read(file_, "malformed glTF: '" + std::string(key) + "' is missing");
        return object[key].get<std::uint64_t>();
    }

    [[nodiscard]] const Json& element(std::uint64_t index, const char* list) const {
        if (index >= size(list))
            fail_read(file_, "malformed glTF: index " + std::to_string(index) + " into '" + list +
                                 "', which has " + std::to_string(size(list)));
        return json_[list][index];
    }

    [[nodiscard]] const Json& target(const Json& object, const char* key, const char* list) const {
        return element(number(object, key), list);
    }

    void check_range(std::uint64_t offset, std::uint64_t length, std::uint64_t available,
                     const std::string& what) const {
        if (offset > available || length > available - offset)
            fail_read(file_, "malformed glTF: " + what + " reaches from byte " + std::to_string(offset) +
                                 " over " + std::to_string(length) + " bytes, but there are " +
                                 std::to_string(available));
    }

    void check_buffer(Json& buffer, std::size_t index) const {
        const std::string what = "buffer " + std::to_string(index);
        const std::uint64_t length = number(buffer, "byteLength");
        std::uint64_t available = 0;
        if (!buffer.contains("uri")) {
            if (index != 0 || !container_.binary)
                fail_read(file_, "malformed glTF: " + what + " has no data");
            available = container_.binary->size();
        } else if (const std::string uri = buffer["uri"].get<std::string>(); uri.starts_with("data:")) {
            const std::size_t comma = uri.find(',');
            if (comma == uri.npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
                fail_read(file_, "malformed glTF: " + what + " is a data URI that is not base64");
            const std::size_t digits = std::min(uri.find('=', comma), uri.size()) - comma - 1;
            available = digits * 3 / 4;
        } else {
            const std::filesystem::path path = file_.parent_path() / decode_uri(uri);
            std::error_code error;
            available =
                std::filesystem::is_regular_file(path, error) ? std::filesystem::file_size(path, error) : 0;
            if (error || !std::filesystem::is_regular_file(path, error))
                fail_read(file_,
                          "its " + what + " is in " + in_quotes(path.string()) + ", which cannot be read");
        }
        check_range(0, length, available, what);
    }

    void check_accessor(const Json& accessor, std::size_t index) const {
        const std::string what = "accessor " + std::to_string(index);
        const std::uint64_t count = number(accessor, "count");
        const std::uint64_t item = component_bytes(accessor, what) * component_count(accessor, what);
        if (count > max_accessor_count)
            fail_read(file_, what + " has " + std::to_string(count) + " elements, above 2^28");
        if (accessor.contains("bufferView"))
            check_view(target(accessor, "bufferView", "bufferViews"), accessor, count, item, what);
        else if (!accessor.contains("sparse"))
            fail_read(file_, "malformed glTF: " + what + " has no bufferView");
        if (!accessor.contains("sparse")) return;
        const Json& sparse = accessor["sparse"];
        const std::uint64_t changed = number(sparse, "count");
        if (changed > count || !sparse.contains("indices") || !sparse.contains("values"))
            fail_read(file_, "malformed glTF: the sparse part of " + what);
        // Zeros without a buffer take no space in the file: only what is written is believed.
        if (!accessor.contains("bufferView") && count > (std::uint64_t(1) << 22))
            fail_read(file_, what + " has " + std::to_string(count) + " elements without a bufferView");
        check_view(target(sparse["indices"], "bufferView", "bufferViews"), sparse["indices"], changed,
                   component_bytes(sparse["indices"], what), what);
        check_view(target(sparse["values"], "bufferView", "bufferViews"), sparse["values"], changed, item,
                   what);
    }

    void check_view(const Json& view, const Json& user, std::uint64_t count, std::uint64_t item,
                    const std::string& what) const {
        const std::uint64_t stride = view.value("byteStride", item);
        if (stride > 65536 || (stride && stride < item))
            fail_read(file_, "malformed glTF: the byteStride of " + what);
        if (count)
            check_range(user.value("byteOffset", std::uint64_t(0)),
                        (count - 1) * (stride ? stride : item) + item, number(view, "byteLength"), what);
    }

    [[nodiscard]] std::uint64_t component_bytes(const Json& accessor, const std::string& what) const {
        switch (number(accessor, "componentType")) {
            case 5120:
            case 5121:
                return 1;
            case 5122:
            case 5123:
                return 2;
            case 5125:
            case 5126:
                return 4;
            default:
                fail_read(file_, "malformed glTF: the componentType of " + what);
        }
    }

    [[nodiscard]] std::uint64_t component_count(const Json& accessor, const std::string& what) const {
        static constexpr std::pair<std::string_view, std::uint64_t> counts[] = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
        const std::string type = accessor.value("type", std::string());
        for (const auto& [name, count] : counts)
            if (type == name) return count;
        fail_read(file_, "malformed glTF: the type of " + what);
    }

    /// Primitives without triangles (points, lines, nothing) are dropped: assimp refuses files with some of
    /// them. Returns the number of triangles.
    [[nodiscard]] std::uint64_t check_mesh(Json& mesh, std::size_t index) const {
        Json kept = Json::array();
        std::uint64_t sum = 0;
        for (const Json& primitive : mesh.value("primitives", Json::array())) {
            const std::uint64_t triangles = check_primitive(primitive, index);
            if (triangles == 0) continue;
            sum += triangles;
            kept.push_back(primitive);
        }
        mesh["primitives"] = kept;
        return sum;
    }

    /// Checks what a primitive refers to; the triangles that it holds.
    [[nodiscard]] std::uint64_t check_primitive(const Json& primitive, std::size_t mesh) const {
        const std::string what = "a primitive of mesh " + std::to_string(mesh);
        if (primitive.contains("material")) (void)target(primitive, "material", "materials");
        const Json attributes = primitive.value("attributes", Json::object());
        if (!attributes.contains("POSITION")) return 0;
        const std::uint64_t vertices = number(target(attributes, "POSITION", "accessors"), "count");
        for (const auto& [name, value] : attributes.items()) {
            const Json& accessor = target(attributes, name.c_str(), "accessors");
            check_attribute(name, accessor, what);
            if (number(accessor, "count") != vertices)
                fail_read(file_, name + " of " + what + " has another count than POSITION");
        }
        std::uint64_t corners = vertices;
        if (primitive.contains("indices")) {
            const Json& indices = target(primitive, "indices", "accessors");
            const std::uint64_t type = number(indices, "componentType");
            if (indices["type"] != "SCALAR" || (type != 5121 && type != 5123 && type != 5125))
                fail_read(file_, "the indices of " + what + " are not unsigned integers");
            corners = number(indices, "count");
        }
        const std::uint64_t mode = primitive.value("mode", std::uint64_t(4));
        if (mode > 6) fail_read(file_, "malformed glTF: mode " + std::to_string(mode) + " of " + what);
        return mode == 4 ? corners / 3 : mode >= 5 && corners > 2 ? corners - 2 : 0;
    }

    void check_attribute(const std::string& name, const Json& accessor, const std::string& what) const {
        const std::uint64_t component = number(accessor, "componentType");
        const auto demand = [&](bool holds, const char* kind) {
            if (!holds) fail_read(file_, name + " of " + what + " is not made of " + kind);
        };
        if (name == "JOINTS_0")
            demand((component == 5121 || component == 5123) && accessor["type"] == "VEC4",
                   "four unsigned integers of 8 or 16 bits, as it must be");
        else if (name == "WEIGHTS_0")  // assimp takes the bytes of others for floats
            demand(component == 5126 && accessor["type"] == "VEC4", "four floats; others are not read");
        else if (name == "COLOR_0")
            demand((component == 5121 || component == 5123 || component == 5126) &&
                       (accessor["type"] == "VEC3" || accessor["type"] == "VEC4"),
                   "three or four floats or unsigned integers of 8 or 16 bits, as it must be");
        else demand(component == 5126 && accessor["type"] == "VEC3", "three floats, as it must be");
    }

    /// A skinned mesh is a mesh of its own for each of its nodes: assimp keeps one skin a mesh. So is one
    /// with morph targets, whose weights are a node's.
    void separate_skinned_meshes() {
        std::vector<bool> taken(size("meshes"));
        std::vector<std::size_t> targets;  // of each mesh
        for (std::size_t i = 0; i < size("meshes"); ++i) targets.push_back(target_count(json_["meshes"][i]));
        std::size_t joints = 0, copied_targets = 0;
        for (const bool skinned : {false, true})
            for (std::size_t i = 0; i < size("nodes"); ++i) {
                Json& node = json_["nodes"][i];
                if (!node.contains("mesh") || node.contains("skin") != skinned) continue;
                const Json& mesh = target(node, "mesh", "meshes");
                const auto index = node["mesh"].get<std::size_t>();
                if (skinned) joints += joint_count(node, mesh);
                if (joints > max_joints)
                    fail_read(file_, "its skins have more than 2^20 joints, counted for each primitive");
                if ((skinned || targets[index] > 0) && taken[index]) {
                    copied_targets += targets[index];
                    if (copied_targets > max_copied_targets)
                        fail_read(file_,
                                  "its nodes share meshes with more than 2^20 morph targets, counted for "
                                  "each node after the first");
                    node["mesh"] = size("meshes");
                    json_["meshes"].push_back(Json(mesh));
                }
                taken[index] = true;
            }
    }

    /// How many elements a list has; none if it is missing.
    [[nodiscard]] static std::size_t length(const Json& object, const char* key) {
        const auto found = object.find(key);
        return found == object.end() ? 0 : found->size();
    }

    /// The morph targets of all primitives.
    [[nodiscard]] static std::size_t target_count(const Json& mesh) {
        std::size_t count = 0;
        if (const auto primitives = mesh.find("primitives"); primitives != mesh.end())
            for (const Json& primitive : *primitives) count += length(primitive, "targets");
        return count;
    }

    [[nodiscard]] std::size_t joint_count(const Json& node, const Json& mesh) const {
        return length(mesh, "primitives") * length(target(node, "skin", "skins"), "joints");
    }

    void check_skin(Json& skin, std::size_t index) {
        const std::string what = "skin " + std::to_string(index);
        const Json joints = skin.value("joints", Json::array());
        // assimp never frees an array of none.
        if (joints.empty())
            fail_read(file_, "malformed glTF: " + what + " has no joints; at least one is needed");
        for (const Json& joint : joints) {
            const auto node = joint.get<std::size_t>();
            (void)element(node, "nodes");
            // A skin that the scene does not use may be bound to nodes that are nowhere.
            if (use_.skins[index] && !in_scene_[node])
                fail_read(file_, "malformed glTF: joint " + joint.dump() + " of " + what + " is in no scene");
            json_["nodes"][node]["name"] = "node " + joint.dump();
        }
        if (!skin.contains("inverseBindMatrices"))
            skin["inverseBindMatrices"] = add_identities(joints.size());
        const Json& matrices = target(skin, "inverseBindMatrices", "accessors");
        if (number(matrices, "componentType") != 5126 || matrices["type"] != "MAT4" ||
            number(matrices, "count") < joints.size())
            fail_read(file_, "malformed glTF: the inverseBindMatrices of " + what);
    }

    /// An accessor of identity matrices: assimp follows a null pointer where a skin has no matrices. Base64
    /// takes three bytes at a time, so each matrix ends with two bytes of nothing.
    [[nodiscard]] std::size_t add_identities(std::size_t count) {
        constexpr std::size_t stride = 66;
        std::string uri = "data:application/octet-stream;base64,";
        for (std::size_t i = 0; i < count; ++i)
            uri += "AACAPwAAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAACAPwAA";
        json_["buffers"].push_back({{"uri", uri}, {"byteLength", count * stride}});
        json_["bufferViews"].push_back(
            {{"buffer", size("buffers") - 1}, {"byteLength", count * stride}, {"byteStride", stride}});
        json_["accessors"].push_back({{"bufferView", size("bufferViews") - 1},
                                      {"componentType", 5126},
                                      {"count", count},
                                      {"type", "MAT4"}});
        return size("accessors") - 1;
    }

    /// Nodes are trees: each has one parent at most, and from the roots every path ends.
    void check_nodes() {
        std::vector<std::size_t> parents(size("nodes"), 0);
        in_scene_.resize(parents.size());
        for (std::size_t i = 0; i < parents.size(); ++i) {
            Json& node = json_["nodes"][i];
            // assimp ties cameras, lights and joints to nodes by name.
            if (node.contains("camera") || node.contains("extensions") ||
                node.value("name", std::string()).starts_with("node "))
                node["name"] = "node " + std::to_string(i);
            if (node.contains("mesh")) (void)target(node, "mesh", "meshes");
            if (node.contains("skin")) (void)target(node, "skin", "skins");
            if (node.contains("camera")) (void)target(node, "camera", "cameras");
            for (const Json& child : node.value("children", Json::array())) {
                (void)element(child.get<std::uint64_t>(), "nodes");
                if (++parents[child.get<std::size_t>()] > 1)
                    fail_read(file_, "malformed glTF: node " + child.dump() + " has more than one parent");
            }
        }
        if (!json_.contains("scenes") || json_["scenes"].empty()) {
            Json roots = Json::array();
            for (std::size_t i = 0; i < parents.size(); ++i)
                if (!parents[i]) roots.push_back(i);
            json_["scenes"] = Json::array({Json{{"nodes", roots}}});
            json_["scene"] = 0;
        }
        (void)element(json_.value("scene", std::uint64_t(0)), "scenes");
        for (const Json& scene : json_["scenes"])
            for (const Json& root : scene.value("nodes", Json::array())) {
                (void)element(root.get<std::uint64_t>(), "nodes");
                // With one parent a node, a cycle has no way in: only a root inside one can reach it.
                if (parents[root.get<std::size_t>()])
                    fail_read(file_, "malformed glTF: node " + root.dump() + " of a scene is not a root");
                check_depth(root.get<std::size_t>());
            }
    }

    void check_depth(std::size_t root) {
        std::vector<std::pair<std::size_t, std::size_t>> open{{root, 1}};
        while (!open.empty()) {
            const auto [node, depth] = open.back();
            open.pop_back();
            if (depth > max_node_depth)
                fail_read(file_,
                          "its nodes are nested more than " + std::to_string(max_node_depth) + " deep");
            in_scene_[node] = true;
            for (const Json& child : json_["nodes"][node].value("children", Json::array()))
                open.emplace_back(child.get<std::size_t>(), depth + 1);
        }
    }

    const std::filesystem::path& file_;
    Json json_;
    const GltfContainer& container_;
    std::vector<bool> in_scene_;  ///< of each node: some scene reaches it
    GltfUse use_;
};

}  // namespace

CheckedGltf check_gltf(const std::filesystem::path& file, const std::string& bytes, GltfFilePart part) {
    const GltfContainer container = open_container(file, bytes);
    try {
        return GltfChecker(file, copy_gltf(file, container.json, part), container).check(part);
    } catch (const Json::exception& error) {
        fail_read(file, std::string("malformed glTF: ") + error.what());
    }
}

}  // namespace setka::io::detail
