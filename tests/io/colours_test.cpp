// SPDX-License-Identifier: MIT
/// Do vertices of files keep their colours, also where they are repeated, left out or welded?
#include "tests/io/gltf_maker.hpp"

namespace setka::io::test {

namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

/// The colour of each corner of each triangle, which must stand where the file has it.
std::vector<Float3> corner_colours(const Mesh& mesh) {
    EXPECT_EQ(mesh.colors.size(), mesh.positions.size());
    std::vector<Float3> colours;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t vertex : {t.a, t.b, t.c}) colours.push_back(mesh.colors.at(vertex));
    return colours;
}

/// Two triangles that share an edge at a right angle, so that vertices 1 and 2 are repeated; no triangle uses
/// vertex 0.
std::filesystem::path write_ply(const Folder& folder, const std::string& type, const std::string& suffix,
                                const std::vector<std::string>& colours) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 5\n";
    for (const char* name : {"red", "green", "blue"}) text += "property " + type + " " + name + suffix + "\n";
    text += "property float x\nproperty float y\nproperty float z\n";
    text += "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    const char* points[] = {"9 9 9", "0 0 0", "1 0 0", "0 1 0", "0 0 1"};
    for (std::size_t i = 0; i < 5; ++i) text += colours[i] + " " + points[i] + "\n";
    return folder.write("a.ply", text + "3 1 2 3\n3 2 1 4\n");
}

TEST(Colours, OfPlyFollowTheirVertices) {
    const Folder folder;
    const Scene scene =
        load_scene(write_ply(folder, "float", "", {"1 1 1", "0.5 0 0", "0 0.25 0", "0 0 0.125", "-1 nan 7"}));
    EXPECT_EQ(scene.meshes.at(0).positions.size(), 6u) << "4 and 2 that are repeated";
    const Float3 a{0.5f, 0, 0}, b{0, 0.25f, 0}, c{0, 0, 0.125f}, d{0, 0, 1};
    EXPECT_THAT(corner_colours(scene.meshes[0]), ElementsAre(a, b, c, b, a, d)) << "floats are linear";
    EXPECT_EQ(scene.materials.at(0).diffuse, (Float3{1, 1, 1}));
}

TEST(Colours, OfPlyIntegersAreSrgb) {
    const Folder folder;
    const auto first = [&](const std::string& type, const std::string& colour) {
        return corner_colours(
            load_scene(write_ply(folder, type, "", std::vector(5, colour))).meshes.at(0))[0];
    };
    EXPECT_THAT(first("uchar", "255 0 188"), near(1, 0, 0.502886f));
    EXPECT_THAT(first("int", "255 -1 188"), near(1, 0, 0.502886f));
    EXPECT_THAT(first("ushort", "65535 10 48316"), near(1, 0, 0.502886f));
    const Scene without = load_scene(write_ply(folder, "uchar", "ish", std::vector<std::string>(5, "1 2 3")));
    EXPECT_TRUE(without.meshes.at(0).colors.empty()) << "those are no colours";
    EXPECT_EQ(without.materials.at(0).diffuse, Material{}.diffuse);
}

TEST(Colours, OfGltfAreLinearWithoutAlpha) {
    File file;
    const auto colour = [&](std::size_t accessor) -> Json& {
        Json& list = file.json["meshes"][0]["primitives"];
        list.push_back(list[0]);
        list.back()["attributes"]["COLOR_0"] = accessor;
        return list.back();
    };
    file.json["materials"] = Json::parse(
        R"([{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 1, 1], "metallicFactor": 0}}])");
    colour(file.add<float>("VEC3", {0.5, 0, 0, 0, 0.25, 0, -1, 2, 0.125}, 3))["material"] = 0;
    const std::size_t bytes = file.add<std::uint8_t>("VEC4", {255, 0, 0, 0, 0, 51, 0, 9, 0, 0, 102, 255}, 4);
    file.json["accessors"][bytes]["normalized"] = true;
    (void)colour(bytes);
    const std::filesystem::path path = file.write();
    for (const Scene& scene : {load_scene(path), Animation(path).scene()}) {
        ASSERT_EQ(scene.meshes.size(), 3u);
        EXPECT_TRUE(scene.meshes[0].colors.empty());
        EXPECT_THAT(corner_colours(scene.meshes[1]),
                    ElementsAre(near(0.5, 0, 0), near(0, 0.25, 0), near(0, 1, 0.125)));
        EXPECT_THAT(corner_colours(scene.meshes[2]),
                    ElementsAre(near(1, 0, 0), near(0, 0.2f, 0), near(0, 0, 0.4f)));
        const auto diffuse = [&](std::size_t i) {
            return scene.materials[scene.instances[i].material].diffuse;
        };
        EXPECT_EQ(diffuse(1), (Float3{0.5f, 0.5f, 1})) << "which they multiply";
        EXPECT_EQ(diffuse(2), (Float3{1, 1, 1}));
    }
}

/// assimp gives each corner of an OBJ a vertex: those at one place become one again if they have one colour.
TEST(Colours, OfObjKeepVerticesApart) {
    const Folder folder;
    (void)folder.write("a.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    const auto load = [&](const std::string& material, const std::string& colour) {
        return load_scene(
            folder.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 1 1 0 1 1 1\nv 0 1 0 " +
                                      colour + "\n" + material + "f 1 2 3\nf 5 2 4\n"));
    };
    const Scene one = load("", "0 0 1"), two = load("mtllib a.mtl\nusemtl grey\n", "0 0 0.5");
    EXPECT_EQ(one.meshes.at(0).positions.size(), 4u);
    EXPECT_EQ(two.meshes.at(0).positions.size(), 5u);
    const Float3 red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, white{1, 1, 1};
    EXPECT_THAT(corner_colours(one.meshes[0]), ElementsAre(red, green, blue, blue, green, white));
    EXPECT_THAT(corner_colours(two.meshes[0]),
                ElementsAre(red, green, blue, Float3{0, 0, 0.5f}, green, white));
    EXPECT_EQ(one.materials.at(one.instances[0].material).diffuse, white);
    EXPECT_EQ(two.materials.at(two.instances[0].material).diffuse, (Float3{0.5f, 0.5f, 0.5f}));
}

/// Of a sequence the first frame has the colours.
TEST(Colours, StayInASequence) {
    const Folder folder;
    const std::vector<std::string> colours{"1 1 1", "0.5 0 0", "0 0.25 0", "0 0 0.125", "0 0 1"};
    const std::vector paths{folder / "f1.ply", folder / "f2.ply", folder / "f3.ply"};
    std::filesystem::rename(write_ply(folder, "float", "", colours), paths[0]);
    std::filesystem::rename(write_ply(folder, "float", "ish", colours), paths[1]);
    std::filesystem::rename(write_ply(folder, "float", "", {5, "0.75 1 0"}), paths[2]);
    const Animation animation{std::span<const std::filesystem::path>(paths)};
    const Float3 a{0.5f, 0, 0}, b{0, 0.25f, 0}, c{0, 0, 0.125f}, d{0, 0, 1};
    Scene scene = animation.scene();
    for (const std::uint32_t frame : {1, 2, 3}) {
        apply(scene, animation.frame(frame));
        scene.validate();
        EXPECT_THAT(corner_colours(scene.meshes.at(0)), ElementsAre(a, b, c, b, a, d));
    }
}

/// Colours on some vertices only, which assimp gives to others.
TEST(Colours, OfSomeVerticesOfAnObjStayThere) {
    const Folder folder;
    const Scene scene =
        load_scene(folder.write("a.obj",
                                "v 0 0 0\nv 2 0 .0 2\nv 0 1 0 1 # 0 0\nv 2 0 0 .5 0 0\nv 3 0 0 0 1 0\n"
                                "v 2 1 0 0 0 1 # last\nv 4 4 -1 0.5\no A\nf 1 2 3\no B\nf 4 5 7\nf 6 4 5\n"));
    ASSERT_EQ(scene.meshes.size(), 2u);
    const Float3 white{1, 1, 1}, dark_red{0.5f, 0, 0}, green{0, 1, 0}, blue{0, 0, 1};
    EXPECT_THAT(corner_colours(scene.meshes[0]), testing::Each(white));
    EXPECT_THAT(corner_colours(scene.meshes[1]), ElementsAre(dark_red, green, white, blue, dark_red, green));
    EXPECT_THAT(scene.meshes[0].positions, ElementsAre(near(0, 0, 0), near(1, 0, 0), near(0, 1, 0)))
        << "numbers that are four end with a weight";
    EXPECT_EQ(scene.meshes[1].positions.at(scene.meshes[1].triangles.at(0).c), (Float3{8, 8, -2}));
    const auto refuse = [&](const std::string& weight, const std::string& reason) {
        expect_unreadable(folder.write("b.obj", "v 0 0 0 1 1 1\nv 1 1 0\nv 0 1 0 " + weight + "\nf 1 2 3\n"),
                          "line 3: 'v' stands at " + reason);
    };
    refuse("0", "'0' / '0', which is not finite");
    refuse("1e-45", "'1' / '1e-45', which is not finite");
}

/// Groups share the white that stands in for a material without a colour.
TEST(Colours, OfManyGroupsShareMaterials) {
    const Folder folder;
    (void)folder.write("a.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    const auto load = [&](const std::string& library, const std::string& one, const std::string& other) {
        std::string text = library + "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n";
        for (int i = 0; i < 20; ++i)
            text += "o g" + std::to_string(i) + "\n" + (i % 2 ? other : one) + "f 1 2 3\n";
        return load_scene(folder.write("a.obj", text));
    };
    const Float3 white{1, 1, 1}, grey{0.5f, 0.5f, 0.5f};
    const Scene plain = load("", "", "");
    EXPECT_EQ(plain.instances.size(), 20u);
    ASSERT_EQ(plain.materials.size(), 1u);
    EXPECT_EQ(plain.materials[0].diffuse, white);
    const Scene mixed = load("mtllib a.mtl\n", "usemtl unknown\n", "usemtl grey\n");
    ASSERT_EQ(mixed.instances.size(), 20u);
    ASSERT_EQ(mixed.materials.size(), 2u);
    EXPECT_EQ(mixed.materials[mixed.instances[0].material].diffuse, white);
    EXPECT_EQ(mixed.materials[mixed.instances[1].material].diffuse, grey);
}

TEST(Colours, OfGltfAreRefusedInOtherTypes) {
    File file;
    const std::size_t colours =
        file.add<float>("VEC4", {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9}, 8);
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours;
    Json& accessor = file.json["accessors"][colours];
    for (const char* type : {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"})
        for (const int component : {5120, 5121, 5122, 5123, 5125, 5126}) {
            const std::string text(type);
            if (text == "MAT3" || text == "MAT4") accessor["count"] = 1;
            accessor["type"] = type;
            accessor["componentType"] = component;
            const bool is_read = (text == "VEC3" || text == "VEC4") &&
                                 (component == 5121 || component == 5123 || component == 5126);
            if (is_read) EXPECT_EQ(load_scene(file.write()).meshes.at(0).colors.size(), 3u);
            else
                expect_unreadable(file.write(),
                                  "COLOR_0 of a primitive of mesh 0 is not made of three or four floats");
        }
}

}  // namespace

}  // namespace setka::io::test
