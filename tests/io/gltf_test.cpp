// SPDX-License-Identifier: MIT
/// Are glTF scenes read with their nodes, cameras, lights and materials, and refused where they contradict
/// themselves?
#include <nlohmann/json.hpp>

#include "setka/animation.hpp"
#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

using Json = nlohmann::json;

/// A triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) in scene.bin: 36 bytes of positions, then 3 indices of 16 bits.
Json triangle(const Folder& folder) {
    std::string bytes;
    for (const float value : {0, 0, 0, 1, 0, 0, 0, 1, 0}) bytes += bytes_of(value);
    for (const std::uint16_t value : {0, 1, 2}) bytes += bytes_of(value);
    (void)folder.write("scene.bin", bytes);
    return Json::parse(
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"name": "tri", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"uri": "scene.bin", "byteLength": 42}]})");
}

std::filesystem::path write(const Folder& folder, const Json& json) {
    return folder.write("scene.gltf", json.dump());
}

TEST(Gltf, PlacesOneInstancePerMeshAndNode) {
    const Folder folder;
    Json json = triangle(folder);
    json["nodes"] =
        Json::parse(R"([{"children": [1, 2], "translation": [10, 0, 0]}, {"mesh": 0, "scale": [2, 2, 2]},
                                    {"mesh": 0, "rotation": [0, 0, 0.7071068, 0.7071068]}])");
    const Scene scene = load_scene(write(folder, json));
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.instances[0].transform.rows,
              (std::array<float, 12>{2, 0, 0, 10, 0, 2, 0, 0, 0, 0, 2, 0}));
    const auto& rows = scene.instances[1].transform.rows;
    EXPECT_NEAR(rows[1], -1, 1e-6) << "a quarter turn about z takes y to -x";
    EXPECT_NEAR(rows[4], 1, 1e-6);
}

TEST(Gltf, ReadsCameraLightsAndMaterials) {
    const Folder folder;
    Json json = triangle(folder);
    json["cameras"] = Json::parse(
        R"([{"type": "perspective", "perspective": {"yfov": 0.7853982, "aspectRatio": 1.5, "znear": 0.1}}])");
    json["extensions"] = Json::parse(R"({"KHR_lights_punctual": {"lights": [
        {"type": "directional", "color": [1, 0.5, 0.25], "intensity": 1}, {"type": "point", "intensity": 0.5}]}})");
    json["materials"] = Json::parse(R"([{"name": "gold", "pbrMetallicRoughness":
        {"baseColorFactor": [1, 0.75, 0.25, 1], "metallicFactor": 1, "roughnessFactor": 0}},
        {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 0.25], "metallicFactor": 0}},
        {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}, "pbrMetallicRoughness": {"metallicFactor": 0}}])");
    const Json primitive = json["meshes"][0]["primitives"][0];
    for (int i = 0; i < 3; ++i) {
        json["meshes"][0]["primitives"][i] = primitive;
        json["meshes"][0]["primitives"][i]["material"] = i;
    }
    json["nodes"] =
        Json::parse(R"([{"mesh": 0, "children": [1, 2, 3]}, {"camera": 0, "translation": [0, 0, 5]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}, "translation": [1, 2, 3]}])");
    const Scene scene = load_scene(write(folder, json));
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->eye, (Float3{0, 0, 5}));
    EXPECT_EQ(scene.camera->target, (Float3{0, 0, 0}));
    EXPECT_NEAR(scene.camera->vertical_fov_degrees, 45, 1e-3);
    ASSERT_EQ(scene.directional_lights.size(), 1u);
    EXPECT_EQ(scene.directional_lights[0].direction, (Float3{0, 0, -1}));
    EXPECT_EQ(scene.directional_lights[0].intensity, (Float3{1, 0.5f, 0.25f}));
    ASSERT_EQ(scene.point_lights.size(), 1u);
    EXPECT_EQ(scene.point_lights[0].position, (Float3{1, 2, 3}));
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[0].specular, (Float3{1, 0.75f, 0.25f}));
    EXPECT_EQ(scene.materials[0].reflectivity, 1);
    EXPECT_EQ(scene.materials[1].transparency, 0.75f);
    EXPECT_EQ(scene.materials[2].transparency, 1);
}

/// The first camera of the file that the scene uses, in whatever order nodes use them.
TEST(Gltf, TakesTheFirstCameraOfItsScene) {
    const Folder folder;
    Json json = triangle(folder);
    json["cameras"] = Json::parse(R"([{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1}},
        {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
        {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])");
    json["nodes"] = Json::parse(R"([{"mesh": 0}, {"camera": 2, "translation": [0, 0, 1]},
        {"camera": 1, "translation": [0, 0, 2]}, {"camera": 1, "translation": [0, 0, 3]},
        {"camera": 0, "translation": [0, 0, 4]}])");
    const auto expect = [&](const Json& nodes, float z, double radians) {
        json["scenes"][0]["nodes"] = nodes;
        const std::filesystem::path file = write(folder, json);
        for (const Scene& scene : {load_scene(file), Animation(file).scene()}) {
            ASSERT_TRUE(scene.camera);
            EXPECT_EQ(scene.camera->eye.z, z) << nodes;
            EXPECT_NEAR(scene.camera->vertical_fov_degrees, radians * 180 / 3.14159265, 1e-4) << nodes;
        }
    };
    expect({0, 1, 2, 3, 4}, 2, 0.5);
    expect({4, 3, 2, 1, 0}, 2, 0.5);
    expect({0, 1}, 1, 1);
    expect({0, 1, 3}, 3, 0.5);
    json["scenes"][0]["nodes"] = {0, 4};
    EXPECT_FALSE(load_scene(write(folder, json)).camera) << "which has no angle";
}

TEST(Gltf, RefusesWhatContradictsItself) {
    const Folder folder;
    const auto refuses = [&](const char* pointer, const Json& value, const std::string& reason) {
        Json json = triangle(folder);
        json[Json::json_pointer(pointer)] = value;
        SCOPED_TRACE(pointer);
        expect_unreadable(write(folder, json), reason);
    };
    EXPECT_EQ(load_scene(write(folder, triangle(folder))).triangle_count(), 1u);
    refuses("/asset/version", "1.0", "version 2 is read");
    refuses("/nodes/0/mesh", 7, "index 7 into 'meshes'");
    refuses("/nodes/0/mesh", "x", "'mesh' must be");
    refuses("/nodes/0/children", Json{0}, "is not a root");
    refuses("/nodes", Json::parse(R"([{"children": [1]}, {"children": [0]}])"), "is not a root");
    refuses("/accessors/0/count", 1000000, "accessor 0 reaches");
    refuses("/accessors/1/count", -1, "'count' must be");
    refuses("/accessors/1/componentType", 5122, "not unsigned integers");
    refuses("/accessors/0/bufferView", 9, "index 9 into 'bufferViews'");
    refuses("/bufferViews/0/byteLength", 1000, "bufferView 0 reaches");
    refuses("/buffers/0/byteLength", 43, "buffer 0 reaches");
    refuses("/buffers/0/uri", "absent.bin", "absent.bin");
    refuses("/extensionsRequired", Json{"KHR_draco_mesh_compression"}, "KHR_draco_mesh_compression");
    refuses("/nodes/0/matrix", Json(std::vector<int>{1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
            "not affine");
    expect_unreadable(folder.write("a.gltf", "{\"asset\": "), "no JSON");
    expect_unreadable(folder.write("b.gltf", std::string(100000, '[')), "malformed glTF");
    expect_unreadable(folder.write("c.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12) + std::string(20, ' ')),
                      "promises 255 bytes");
}

TEST(Gltf, RefusesDataWithoutBase64) {
    const Folder folder;
    for (const char* uri : {"data:,", "data:x,", "data:;base64", "data:base64,AAAA"}) {
        Json json = triangle(folder);
        json["buffers"][0]["uri"] = uri;
        SCOPED_TRACE(uri);
        expect_unreadable(write(folder, json), "buffer 0 is a data URI that is not base64");
    }
}

TEST(Gltf, DropsPrimitivesWithoutTriangles) {
    const Folder folder;
    Json json = triangle(folder);
    Json points = json["meshes"][0]["primitives"][0];
    points["mode"] = 0;
    json["meshes"][0]["primitives"].push_back(points);
    json["meshes"].push_back({{"primitives", Json::array({points})}});
    json["nodes"].push_back({{"mesh", 1}});
    json["scenes"][0]["nodes"].push_back(1);
    const Scene scene = load_scene(write(folder, json));
    EXPECT_EQ(scene.triangle_count(), 1u);
    EXPECT_EQ(scene.instances.size(), 1u);
    json["meshes"].erase(0);
    json["nodes"][1]["mesh"] = 0;
    expect_unreadable(write(folder, json), "no triangle");
}

/// A second triangle without indices, (0, 0, 0), (1, 0, 0), (0, 1, 0) backwards in x, as mesh 1.
Json two_triangles(const Folder& folder) {
    Json json = triangle(folder);
    std::string bytes = read_bytes(folder / "scene.bin") + "..";
    for (const float value : {0, 0, 0, -1, 0, 0, 0, 1, 0}) bytes += bytes_of(value);
    (void)folder.write("scene.bin", bytes);
    json["buffers"][0]["byteLength"] = bytes.size();
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 44}, {"byteLength", 36}});
    json["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 2}}}}}}});
    return json;
}

/// The x of the second corner of all instances, where there is nothing else; as an animation, too.
std::vector<float> second_corners(const std::filesystem::path& file) {
    const auto corners = [](const Scene& scene) {
        EXPECT_EQ(scene.meshes.size(), scene.instances.size());
        std::vector<float> list;
        for (const Instance& instance : scene.instances)
            list.push_back(scene.meshes[instance.mesh].positions.at(1).x + instance.transform.rows[3]);
        return list;
    };
    const std::vector<float> list = corners(load_scene(file));
    EXPECT_EQ(list, corners(Animation(file).scene()));
    return list;
}

TEST(Gltf, LeavesOutMeshesThatNoNodeUses) {
    const Folder folder;
    Json json = two_triangles(folder);
    EXPECT_THAT(second_corners(write(folder, json)), testing::ElementsAre(1));
    json["nodes"][0]["mesh"] = 1;
    EXPECT_THAT(second_corners(write(folder, json)), testing::ElementsAre(-1)) << "the first is unused";
    json["nodes"].push_back({{"mesh", 0}, {"translation", {10, 0, 0}}});
    EXPECT_THAT(second_corners(write(folder, json)), testing::ElementsAre(-1)) << "nor by a node in no scene";
    json["nodes"][0]["children"] = {1};
    EXPECT_THAT(second_corners(write(folder, json)), testing::ElementsAre(-1, 11));
    json["scenes"][0]["nodes"] = Json::array();
    expect_unreadable(write(folder, json), "no triangle");
}

TEST(Gltf, LeavesOutMeshesOfOtherScenes) {
    const Folder folder;
    Json json = two_triangles(folder);
    json["nodes"] =
        Json::parse(R"([{"mesh": 0}, {"mesh": 1, "children": [2]}, {"mesh": 0, "translation": [5, 0, 0]}])");
    json["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [1]}])");
    EXPECT_THAT(second_corners(write(folder, json)), testing::ElementsAre(1));
    json["scene"] = 1;
    EXPECT_THAT(second_corners(write(folder, json)), testing::ElementsAre(-1, 6));
    json.erase("scene");
    EXPECT_THAT(second_corners(write(folder, json)), testing::ElementsAre(1)) << "the first, if it says none";
}

TEST(Gltf, RefusesAnIndexOutOfRangeInABuffer) {
    const Folder folder;
    const Json json = triangle(folder);
    std::string bytes = read_bytes(folder / "scene.bin");
    bytes[40] = 9;
    (void)folder.write("scene.bin", bytes);
    expect_unreadable(write(folder, json), "an index is out of range");
}

/// As many triangles are lost as a mesh has that is left out, or one that is not.
TEST(Gltf, RefusesAnIndexOutOfRangeBesideMeshesThatAreLeftOut) {
    const Folder folder;
    Json json = two_triangles(folder);
    std::string bytes = read_bytes(folder / "scene.bin");
    json["bufferViews"][1] = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", 12}};
    json["buffers"][0]["byteLength"] = bytes.size() + 12;
    json["accessors"][1]["count"] = 6;
    for (const std::uint16_t index : {0, 1, 2, 0, 1, 9}) bytes += bytes_of(index);
    (void)folder.write("scene.bin", bytes);
    expect_unreadable(write(folder, json), "only 1 of 2 triangles can be used: an index is out of range");
    json["nodes"].push_back({{"mesh", 1}});
    json["scenes"][0]["nodes"].push_back(1);
    expect_unreadable(write(folder, json), "only 2 of 3 triangles can be used: an index is out of range");
    bytes[bytes.size() - 2] = 2;
    (void)folder.write("scene.bin", bytes);
    EXPECT_EQ(load_scene(write(folder, json)).triangle_count(), 3u);
}

}  // namespace

}  // namespace setka::io::test
