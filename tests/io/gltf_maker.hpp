// SPDX-License-Identifier: MIT
/// How is a glTF file made by hand? JSON, and arrays of numbers behind accessors. And what is near to a
/// point?
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "setka/animation.hpp"
#include "tests/io/support.hpp"

namespace setka::io::test {

/// Appends an array to `bytes`, as a view and an accessor of it; returns the accessor's number.
template <typename T>
std::size_t add_accessor(nlohmann::json& json, std::string& bytes, const char* type, std::size_t count,
                         const std::vector<T>& values) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const int component = sizeof(T) == 1 ? 5121 : sizeof(T) == 2 ? 5123 : 5126;
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size()},
                                 {"componentType", component},
                                 {"count", count},
                                 {"type", type}});
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
    for (const T value : values) bytes += bytes_of(value);
    return json["accessors"].size() - 1;
}

[[nodiscard]] inline testing::Matcher<Float3> near(float x, float y, float z) {
    using testing::Field, testing::FloatNear;
    return testing::AllOf(Field("x", &Float3::x, FloatNear(x, 1e-5f)),
                          Field("y", &Float3::y, FloatNear(y, 1e-5f)),
                          Field("z", &Float3::z, FloatNear(z, 1e-5f)));
}

/// A triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) at node 1, a child of node 0, and another one at node 2.
class File {
  public:
    File() {
        json =
            nlohmann::json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
            "nodes": [{"children": [1], "name": "truck"}, {"mesh": 0, "name": "wheel"}, {"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [], "bufferViews": []})");
        (void)add<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
        (void)add<std::uint16_t>("SCALAR", {0, 1, 2});
    }

    template <typename T>
    std::size_t add(const char* type, const std::vector<T>& values, std::size_t width = 1) {
        return add_accessor<T>(json, bytes, type, values.size() / width, values);
    }

    /// Adds a channel to an animation.
    void move(int node, const char* path, const char* interpolation, const std::vector<float>& times,
              const char* type, std::size_t width, const std::vector<float>& values,
              std::size_t animation = 0) {
        nlohmann::json& list = json["animations"];
        while (list.size() <= animation)
            list.push_back({{"channels", nlohmann::json::array()}, {"samplers", nlohmann::json::array()}});
        nlohmann::json& into = list[animation];
        into["channels"].push_back(
            {{"sampler", into["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
        const std::size_t input = add<float>("SCALAR", times), output = add<float>(type, values, width);
        into["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    }

    [[nodiscard]] std::filesystem::path write() const {
        (void)folder.write("scene.bin", bytes);
        nlohmann::json whole = json;
        whole["buffers"] = nlohmann::json::array({{{"uri", "scene.bin"}, {"byteLength", bytes.size()}}});
        return folder.write("scene.gltf", whole.dump());
    }
    [[nodiscard]] Animation open(const std::string& name = {}) const { return Animation(write(), name); }

    Folder folder;
    nlohmann::json json;
    std::string bytes;
};

/// Two triangles 0 1 2 and 0 2 3 that hang on the joints of nodes 3 and 4.
inline void add_skin(File& file) {
    const std::size_t positions = file.add<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3);
    const std::size_t joints =
        file.add<std::uint8_t>("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, 4);
    const std::size_t weights = file.add<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0}, 4);
    const std::size_t indices = file.add<std::uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
    file.json["meshes"].push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
            {"indices", indices}}}}});
    file.json["nodes"].push_back({{"translation", {0, 0, 5}}});
    file.json["nodes"].push_back(nlohmann::json::object());
    file.json["nodes"].push_back({{"mesh", 1}, {"skin", 0}, {"translation", {0, 100, 0}}});
    file.json["skins"].push_back({{"joints", {3, 4}}});
    file.json["scenes"][0]["nodes"] = {0, 2, 3, 4, 5};
}

}  // namespace setka::io::test
