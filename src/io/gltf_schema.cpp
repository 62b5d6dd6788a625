// SPDX-License-Identifier: MIT
/// Which part of a glTF file does setka read? One table: for each kind of object its keys, and for each key
/// its type.
#include "io/gltf_schema.hpp"

#include <cmath>
#include <optional>
#include <span>

#include "io/file.hpp"

namespace setka::io::detail {

namespace {

using Json = nlohmann::json;

constexpr int max_json_depth = 64;

enum class Type {
    Index,
    Indices,
    Number,
    Numbers,
    NumberList,
    Text,
    Flag,
    IndexMap,
    IndexMaps,
    Object,
    Objects
};

struct Key;
using Keys = std::span<const Key>;

struct Key {
    const char* name;
    Type type;
    Keys keys = {};                           ///< of Object and Objects
    std::size_t count = 0;                    ///< of Numbers
    GltfFilePart part = GltfFilePart::Still;  ///< the least that it belongs to
};

constexpr Key texture[] = {{"index", Type::Index}, {"texCoord", Type::Index}};
constexpr Key pbr[] = {{"baseColorFactor", Type::Numbers, {}, 4},
                       {"baseColorTexture", Type::Object, texture},
                       {"metallicFactor", Type::Number},
                       {"roughnessFactor", Type::Number}};
constexpr Key specular_glossiness[] = {{"diffuseFactor", Type::Numbers, {}, 4},
                                       {"diffuseTexture", Type::Object, texture},
                                       {"specularFactor", Type::Numbers, {}, 3},
                                       {"glossinessFactor", Type::Number}};
constexpr Key transmission[] = {{"transmissionFactor", Type::Number}};
constexpr Key material_extensions[] = {
    {"KHR_materials_transmission", Type::Object, transmission},
    {"KHR_materials_pbrSpecularGlossiness", Type::Object, specular_glossiness}};
constexpr Key material[] = {{"name", Type::Text},
                            {"pbrMetallicRoughness", Type::Object, pbr},
                            {"emissiveFactor", Type::Numbers, {}, 3},
                            {"alphaMode", Type::Text},
                            {"alphaCutoff", Type::Number},
                            {"extensions", Type::Object, material_extensions}};
constexpr Key sparse_indices[] = {
    {"bufferView", Type::Index}, {"byteOffset", Type::Index}, {"componentType", Type::Index}};
constexpr Key sparse_values[] = {{"bufferView", Type::Index}, {"byteOffset", Type::Index}};
constexpr Key sparse[] = {{"count", Type::Index},
                          {"indices", Type::Object, sparse_indices},
                          {"values", Type::Object, sparse_values}};
constexpr Key accessor[] = {
    {"bufferView", Type::Index},     {"byteOffset", Type::Index}, {"componentType", Type::Index},
    {"count", Type::Index},          {"type", Type::Text},        {"normalized", Type::Flag},
    {"sparse", Type::Object, sparse}};
constexpr Key view[] = {{"buffer", Type::Index},
                        {"byteOffset", Type::Index},
                        {"byteLength", Type::Index},
                        {"byteStride", Type::Index}};
constexpr Key buffer[] = {{"uri", Type::Text}, {"byteLength", Type::Index}};
constexpr Key image[] = {{"uri", Type::Text}, {"bufferView", Type::Index}, {"mimeType", Type::Text}};
constexpr Key texture_source[] = {{"source", Type::Index}};
constexpr Key primitive[] = {{"attributes", Type::IndexMap},
                             {"indices", Type::Index},
                             {"material", Type::Index},
                             {"mode", Type::Index},
                             {"targets", Type::IndexMaps, {}, 0, GltfFilePart::Posed}};
constexpr Key mesh[] = {
    {"name", Type::Text}, {"primitives", Type::Objects, primitive}, {"weights", Type::NumberList}};
constexpr Key perspective[] = {
    {"aspectRatio", Type::Number}, {"yfov", Type::Number}, {"zfar", Type::Number}, {"znear", Type::Number}};
constexpr Key orthographic[] = {
    {"xmag", Type::Number}, {"ymag", Type::Number}, {"zfar", Type::Number}, {"znear", Type::Number}};
constexpr Key camera[] = {{"name", Type::Text},
                          {"type", Type::Text},
                          {"perspective", Type::Object, perspective},
                          {"orthographic", Type::Object, orthographic}};
constexpr Key spot[] = {{"innerConeAngle", Type::Number}, {"outerConeAngle", Type::Number}};
constexpr Key light[] = {
    {"name", Type::Text},        {"type", Type::Text},    {"color", Type::Numbers, {}, 3},
    {"intensity", Type::Number}, {"range", Type::Number}, {"spot", Type::Object, spot}};
constexpr Key lights[] = {{"lights", Type::Objects, light}};
constexpr Key root_extensions[] = {{"KHR_lights_punctual", Type::Object, lights}};
constexpr Key light_of_node[] = {{"light", Type::Index}};
constexpr Key node_extensions[] = {{"KHR_lights_punctual", Type::Object, light_of_node}};
constexpr Key node[] = {{"name", Type::Text},
                        {"children", Type::Indices},
                        {"mesh", Type::Index},
                        {"skin", Type::Index},
                        {"camera", Type::Index},
                        {"matrix", Type::Numbers, {}, 16},
                        {"translation", Type::Numbers, {}, 3},
                        {"rotation", Type::Numbers, {}, 4},
                        {"scale", Type::Numbers, {}, 3},
                        {"weights", Type::NumberList},
                        {"extensions", Type::Object, node_extensions}};
constexpr Key skin[] = {{"inverseBindMatrices", Type::Index}, {"joints", Type::Indices}};
constexpr Key animation_target[] = {{"node", Type::Index}, {"path", Type::Text}};
constexpr Key animation_channel[] = {{"sampler", Type::Index}, {"target", Type::Object, animation_target}};
constexpr Key animation_sampler[] = {
    {"input", Type::Index}, {"output", Type::Index}, {"interpolation", Type::Text}};
constexpr Key animation[] = {{"name", Type::Text},
                             {"channels", Type::Objects, animation_channel},
                             {"samplers", Type::Objects, animation_sampler}};
constexpr Key scene[] = {{"nodes", Type::Indices}};
constexpr Key asset[] = {{"version", Type::Text}};
constexpr Key root[] = {{"asset", Type::Object, asset},
                        {"scene", Type::Index},
                        {"scenes", Type::Objects, scene},
                        {"nodes", Type::Objects, node},
                        {"meshes", Type::Objects, mesh},
                        {"skins", Type::Objects, skin},
                        {"accessors", Type::Objects, accessor},
                        {"bufferViews", Type::Objects, view},
                        {"buffers", Type::Objects, buffer},
                        {"materials", Type::Objects, material},
                        {"textures", Type::Objects, texture_source},
                        {"images", Type::Objects, image},
                        {"cameras", Type::Objects, camera},
                        {"animations", Type::Objects, animation, 0, GltfFilePart::Moving},
                        {"extensions", Type::Object, root_extensions}};

constexpr const char* attributes_read[] = {"POSITION", "NORMAL", "COLOR_0", "JOINTS_0", "WEIGHTS_0"};
constexpr const char* extensions_read[] = {"KHR_lights_punctual", "KHR_materials_transmission",
                                           "KHR_materials_pbrSpecularGlossiness"};

class Copier {
  public:
    Copier(const std::filesystem::path& file, GltfFilePart part) : file_(file), part_(part) {}

    [[nodiscard]] Json object(const Json& from, Keys keys, const char* name) const {
        if (!from.is_object()) wrong(name, "an object");
        Json copy = Json::object();
        for (const Key& key : keys) {
            if (key.part > part_) continue;
            if (const auto found = from.find(key.name); found != from.end())
                copy[key.name] = value(*found, key);
        }
        return copy;
    }

  private:
    [[noreturn]] void wrong(const char* name, const char* wanted) const {
        fail_read(file_, "malformed glTF: '" + std::string(name) + "' must be " + wanted);
    }

    static bool is_index(const Json& value) {
        return value.is_number_unsigned() && value.get<std::uint64_t>() <= 0xffffffffu;
    }
    static bool is_number(const Json& value) {
        return value.is_number() && std::isfinite(value.get<float>());
    }

    [[nodiscard]] Json value(const Json& from, const Key& key) const {
        switch (key.type) {
            case Type::Index:
                // "4.0" is an integer to JSON.
                if (from.is_number_float() && from == std::floor(from.get<double>()) && from >= 0 &&
                    from <= 4294967295.0)
                    return static_cast<std::uint64_t>(from.get<double>());
                if (!is_index(from)) wrong(key.name, "an integer of 0 or more");
                return from;
            case Type::Number:
                if (!is_number(from)) wrong(key.name, "a number");
                return from;
            case Type::Text:
                if (!from.is_string()) wrong(key.name, "a string");
                // A zero byte would cut the string short in C.
                if (from.get_ref<const std::string&>().find('\0') != std::string::npos)
                    wrong(key.name, "a string of text");
                return from;
            case Type::Flag:
                if (!from.is_boolean()) wrong(key.name, "true or false");
                return from;
            case Type::Numbers:
                if (!from.is_array() || from.size() != key.count)
                    wrong(key.name, "numbers, as many as glTF says");
                return numbers(from, key.name);
            case Type::NumberList:
                if (!from.is_array()) wrong(key.name, "an array of numbers");
                return numbers(from, key.name);
            case Type::Indices:
                if (!from.is_array()) wrong(key.name, "an array of integers");
                for (const Json& item : from)
                    if (!is_index(item)) wrong(key.name, "an array of integers of 0 or more");
                return from;
            case Type::IndexMap:
                return attributes(from, key.name);
            case Type::IndexMaps: {
                if (!from.is_array()) wrong(key.name, "an array");
                Json copies = Json::array();
                for (const Json& item : from) copies.push_back(attributes(item, key.name));
                return copies;
            }
            case Type::Object:
                return object(from, key.keys, key.name);
            case Type::Objects: {
                if (!from.is_array()) wrong(key.name, "an array");
                Json copies = Json::array();
                for (const Json& item : from) copies.push_back(object(item, key.keys, key.name));
                return copies;
            }
        }
        return {};
    }

    [[nodiscard]] const Json& numbers(const Json& from, const char* name) const {
        for (const Json& item : from)
            if (!is_number(item)) wrong(name, "numbers");
        return from;
    }

    [[nodiscard]] Json attributes(const Json& from, const char* name) const {
        if (!from.is_object()) wrong(name, "an object");
        Json copy = Json::object();
        for (const char* attribute : attributes_read) {
            const auto found = from.find(attribute);
            if (found == from.end()) continue;
            if (!is_index(*found)) wrong(attribute, "an integer of 0 or more");
            copy[attribute] = *found;
        }
        return copy;
    }

    const std::filesystem::path& file_;
    GltfFilePart part_;
};

Json parse(const std::filesystem::path& file, const std::string& text) {
    const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > max_json_depth) fail_read(file, "malformed glTF: its JSON is nested more than 64 deep");
        return true;
    };
    try {
        return Json::parse(text, limit_depth);
    } catch (const Json::parse_error& error) {
        // nlohmann's text starts with its own error number in brackets.
        const std::string_view what = error.what();
        fail_read(file, "malformed glTF: no JSON: " +
                            std::string(what.substr(std::min(what.find("] ") + 2, what.size()))));
    }
}

void check_extensions(const std::filesystem::path& file, const Json& json) {
    if (!json.contains("extensionsRequired")) return;
    for (const Json& name : json["extensionsRequired"]) {
        bool known = !name.is_string() || name.get<std::string>().starts_with("KHR_materials_") ||
                     name == "KHR_texture_transform";
        for (const char* extension : extensions_read) known = known || name == extension;
        if (!known) fail_read(file, "it requires the extension " + name.dump() + ", which is not read");
    }
}

}  // namespace

Json copy_gltf(const std::filesystem::path& file, const std::string& text, GltfFilePart part) {
    const Json json = parse(file, text);
    Json copy = Copier(file, part).object(json, root, "glTF");
    const std::string version = copy.value("asset", Json::object()).value("version", std::string());
    if (version.empty() || version[0] != '2')
        fail_read(file, "glTF version " + in_quotes(version, 20) + "; version 2 is read");
    check_extensions(file, json);
    // assimp looks at extensions only where they are announced.
    Json used = Json::array();
    for (const char* extension : extensions_read) used.push_back(extension);
    copy["extensionsUsed"] = used;
    return copy;
}

std::string decode_uri(const std::string& uri) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1;
    };
    std::string path;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            path += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
            i += 2;
        } else {
            path += uri[i];
        }
    }
    return path;
}

}  // namespace setka::io::detail
