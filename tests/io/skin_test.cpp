// SPDX-License-Identifier: MIT
/// Do skinned glTF meshes stand where their joints put them? Two joints, with answers worked out by hand.
#include <cmath>
#include "scene/transform.hpp"
#include "tests/io/gltf_maker.hpp"

namespace setka::io::test {

namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

/// Two triangles 0 1 2 and 0 2 3. Vertex 0 hangs on the first joint, 1 on the second, 2 on both with weights
/// that sum to 4, and 3 on none. Joint 3 is a child of joint 2, and both are moved by node 0; so is the mesh.
Json arm(const Folder& folder) {
    Json json = Json::parse(
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1, 2], "translation": [10, 0, 0]},
                  {"mesh": 0, "skin": 0, "translation": [0, 100, 0], "name": "node 3"},
                  {"children": [3], "scale": [2, 1, 1]},
                  {"rotation": [0, 0, 0.70710678, 0.70710678], "translation": [0, 0, 5]}],
        "meshes": [{"name": "рука", "primitives": [{"attributes":
                  {"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 4}]}],
        "skins": [{"joints": [2, 3], "inverseBindMatrices": 5}],
        "accessors": [], "bufferViews": []})");
    std::string bytes;
    (void)add_accessor<float>(json, bytes, "VEC3", 4, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    (void)add_accessor<float>(json, bytes, "VEC3", 4, {1, 1, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1});
    (void)add_accessor<std::uint8_t>(json, bytes, "VEC4", 4,
                                     {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    (void)add_accessor<float>(json, bytes, "VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0});
    (void)add_accessor<std::uint16_t>(json, bytes, "SCALAR", 6, {0, 1, 2, 0, 2, 3});
    (void)add_accessor<float>(json, bytes, "MAT4", 2, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1,
                                                       3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0,  0, 0, 1});
    json["buffers"].push_back({{"uri", "scene.bin"}, {"byteLength", bytes.size()}});
    (void)folder.write("scene.bin", bytes);
    return json;
}

Scene load(const Folder& folder, const Json& json) {
    return load_scene(folder.write("scene.gltf", json.dump()));
}

TEST(Skin, MovesVerticesAndNormalsByTheirJoints) {
    const Folder folder;
    const Scene scene = load(folder, arm(folder));
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].transform, Matrix34{}) << "the vertices are in world space";
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.name, "рука") << "names stay UTF-8";
    // The joints' matrices take (x, y, z) to (2x + 8, y, z) and to (10 - 6y, 3x, 3z + 5).
    EXPECT_THAT(mesh.positions,
                ElementsAre(near(8, 0, 0), near(10, 3, 5), near(6, 0.5f, 2.5f), near(10, 100, 1)));
    const float a = 1 / std::sqrt(5.0f), b = 2 * a;
    EXPECT_THAT(mesh.normals, ElementsAre(near(a, b, 0), near(-a, b, 0), near(0, 0, 1), near(0, 0, 1)));
}

TEST(Skin, WithoutMatricesBindsToTheJointsThemselves) {
    const Folder folder;
    Json json = arm(folder);
    json["skins"][0].erase("inverseBindMatrices");
    const Scene scene = load(folder, json);
    EXPECT_THAT(scene.meshes[0].positions,
                ElementsAre(near(10, 0, 0), near(10, 1, 5), near(9, 0.5f, 2.5f), near(10, 100, 1)));
}

TEST(Skin, OfOneNodeLeavesOtherNodesOfTheMeshAlone) {
    const Folder folder;
    Json json = arm(folder);
    json["skins"].push_back({{"joints", {3, 2}}, {"inverseBindMatrices", 5}});
    json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 7, 0}}});
    json["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
    json["scenes"][0]["nodes"] = {0, 4, 5};
    const Scene scene = load(folder, json);
    ASSERT_EQ(scene.instances.size(), 3u);
    const auto first_vertex = [&](std::size_t i) {
        const Instance& instance = scene.instances[i];
        return transform_point(instance.transform, scene.meshes[instance.mesh].positions[0]);
    };
    EXPECT_THAT(first_vertex(0), near(8, 0, 0));
    EXPECT_THAT(first_vertex(1), near(0, 7, 0));
    EXPECT_THAT(first_vertex(2), near(10, -1, 5)) << "(x, y, z) goes to (10 - 2y, x - 1, z + 5)";
}

TEST(Skin, IsRefusedWhereItContradictsItself) {
    const Folder folder;
    const auto refuses = [&](const char* pointer, const Json& value, const std::string& reason) {
        Json json = arm(folder);
        json[Json::json_pointer(pointer)] = value;
        SCOPED_TRACE(pointer);
        expect_unreadable(folder.write("scene.gltf", json.dump()), reason);
    };
    refuses("/nodes/1/skin", 1, "index 1 into 'skins'");
    refuses("/skins/0/joints", {2, 9}, "index 9 into 'nodes'");
    refuses("/skins/0/joints", {2, 3, 3}, "the inverseBindMatrices of skin 0");
    refuses("/skins/0/joints", "x", "'joints' must be");
    refuses("/skins/0/joints", Json::array(), "skin 0 has no joints");
    refuses("/skins/0/inverseBindMatrices", 0, "the inverseBindMatrices of skin 0");
    refuses("/accessors/3/componentType", 5123, "four floats");
    refuses("/accessors/2/componentType", 5126, "reaches");
    refuses("/accessors/2/type", "VEC3", "four unsigned integers");
    refuses("/nodes/2/matrix", Json(std::vector<int>{1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
            "not affine");
    refuses("/nodes/2/children", Json::array(), "joint 3 of skin 0 is in no scene");
    // A cycle that only the skin leads into.
    Json json = arm(folder);
    json["nodes"].push_back({{"children", {5}}});
    json["nodes"].push_back({{"children", {4}}});
    json["skins"][0]["joints"] = {2, 4};
    expect_unreadable(folder.write("scene.gltf", json.dump()), "joint 4 of skin 0 is in no scene");
}

/// Two triangles that nothing moves stand in the scene; the arm is in another one, or in none, or its joints
/// are in a cycle besides.
TEST(Skin, OfAnotherSceneIsLeftOut) {
    const Folder folder;
    Json json = arm(folder);
    json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 7, 0}}});
    const auto check = [&](const Json& scenes) {
        json["scenes"] = scenes;
        json["scene"] = scenes.size() - 1;
        const std::filesystem::path file = folder.write("scene.gltf", json.dump());
        for (const Scene& scene : {load_scene(file), Animation(file).scene()}) {
            ASSERT_EQ(scene.instances.size(), 1u);
            ASSERT_EQ(scene.meshes.size(), 1u);
            EXPECT_THAT(scene.meshes[0].positions.at(1), near(1, 0, 0));
            EXPECT_EQ(scene.instances[0].transform.rows[7], 7);
        }
    };
    check({{{"nodes", {0}}}, {{"nodes", {4}}}});
    check({{{"nodes", {4}}}});
    json["nodes"][3]["children"] = {5};
    json["nodes"].push_back({{"children", {3}}});
    json["nodes"][2].erase("children");
    check({{{"nodes", {4}}}});
}

}  // namespace

}  // namespace setka::io::test
