// SPDX-License-Identifier: MIT
/// Where do morph targets put the vertices of a glTF file, as it stands and as it moves? Answers worked out
/// by hand.
#include <cmath>

#include "tests/io/gltf_maker.hpp"

namespace setka::io::test {

namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

TEST(Morph, MovesByItsKeys) {
    File file;
    const std::size_t up = file.add<float>("VEC3", {0, 0, 4, 0, 0, 0, 0, 0, 0}, 3);
    const std::size_t aside = file.add<float>("VEC3", {0, 0, 0, 2, 0, 0, 0, 0, 0}, 3);
    const std::size_t normals = file.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const std::size_t tilt = file.add<float>("VEC3", {1, 0, 0, 0, 0, 0, 0, 0, 0}, 3);
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = normals;
    primitive["targets"] = {{{"POSITION", up}, {"NORMAL", tilt}}, {{"POSITION", aside}}};
    file.json["meshes"][0]["weights"] = {0, 0.5};
    file.move(1, "weights", "LINEAR", {0, 1}, "SCALAR", 1, {0, 0, 1, 1});
    const Animation animation = file.open();
    const Scene& scene = animation.scene();
    ASSERT_EQ(scene.meshes.size(), 2u) << "each node has weights of its own";
    const std::uint32_t moving = scene.instances[0].mesh, still = scene.instances[1].mesh;
    EXPECT_THAT(scene.meshes[moving].positions, ElementsAre(near(0, 0, 0), near(1, 0, 0), near(0, 1, 0)));
    EXPECT_THAT(scene.meshes[still].positions, ElementsAre(near(0, 0, 0), near(2, 0, 0), near(0, 1, 0)))
        << "the weights of the mesh, where no animation changes them";
    const SceneUpdate update = animation.at(0.5);
    ASSERT_EQ(update.vertices.size(), 1u);
    EXPECT_EQ(update.vertices[0].mesh, moving);
    EXPECT_THAT(update.vertices[0].positions, ElementsAre(near(0, 0, 2), near(2, 0, 0), near(0, 1, 0)));
    const float length = std::sqrt(1.25f);
    EXPECT_THAT(update.vertices[0].normals,
                ElementsAre(near(0.5f / length, 0, 1 / length), near(0, 0, 1), near(0, 0, 1)));
}

/// Without normals in the file they follow the faces.
TEST(Morph, RemakesNormalsOfFaces) {
    File file;
    const std::size_t up = file.add<float>("VEC3", {0, 0, 0, 0, 0, 1, 0, 0, 0}, 3);
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}};
    file.move(1, "weights", "LINEAR", {0, 1}, "SCALAR", 1, {0, 1});
    const SceneUpdate update = file.open().at(1);
    EXPECT_THAT(update.vertices.at(0).normals, testing::Each(near(-std::sqrt(0.5f), 0, std::sqrt(0.5f))));
}

/// Two targets for the triangle of nodes 1 and 2: up moves its first corner, aside its second.
Json& add_targets(File& file) {
    const std::size_t up = file.add<float>("VEC3", {0, 0, 4, 0, 0, 0, 0, 0, 0}, 3);
    const std::size_t aside = file.add<float>("VEC3", {0, 0, 0, 2, 0, 0, 0, 0, 0}, 3);
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}};
    return file.json;
}

/// The corners of an instance of what load_scene reads, which must be what an animation opens with.
std::vector<Float3> stand(const File& file, std::size_t instance) {
    const std::filesystem::path path = file.write();
    const Scene scene = load_scene(path);
    const Animation animation(path);
    const Scene& first = animation.scene();
    EXPECT_EQ(scene.instances.size(), first.instances.size());
    for (std::size_t i = 0; i < std::min(scene.instances.size(), first.instances.size()); ++i) {
        const Mesh &a = scene.meshes.at(scene.instances[i].mesh),
                   &b = first.meshes.at(first.instances[i].mesh);
        EXPECT_EQ(scene.instances[i].transform, first.instances[i].transform);
        EXPECT_EQ(a.positions, b.positions);
        EXPECT_EQ(a.normals, b.normals);
        EXPECT_EQ(a.triangles, b.triangles);
    }
    return scene.meshes.at(scene.instances.at(instance).mesh).positions;
}

TEST(Morph, StandsAtTheWeightsOfItsMesh) {
    File file;
    add_targets(file)["meshes"][0]["weights"] = {0.25, 0.5};
    for (const std::size_t instance : {0, 1})
        EXPECT_THAT(stand(file, instance), ElementsAre(near(0, 0, 1), near(2, 0, 0), near(0, 1, 0)));
}

TEST(Morph, StandsAtTheWeightsOfItsNode) {
    File file;
    add_targets(file)["meshes"][0]["weights"] = {0.25, 0.5};
    file.json["nodes"][2]["weights"] = {0, 0};
    EXPECT_THAT(stand(file, 0), ElementsAre(near(0, 0, 1), near(2, 0, 0), near(0, 1, 0)));
    EXPECT_THAT(stand(file, 1), ElementsAre(near(0, 0, 0), near(1, 0, 0), near(0, 1, 0)));
    file.json["nodes"][2]["weights"] = {0, -1};
    file.json["meshes"][0].erase("weights");
    EXPECT_THAT(stand(file, 0), ElementsAre(near(0, 0, 0), near(1, 0, 0), near(0, 1, 0)));
    EXPECT_THAT(stand(file, 1), ElementsAre(near(0, 0, 0), near(-1, 0, 0), near(0, 1, 0)));
}

/// A skin moves what the targets made.
TEST(Morph, StandsBeforeItsSkin) {
    File file;
    add_skin(file);
    const std::size_t up = file.add<float>("VEC3", {0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3);
    file.json["meshes"][1]["primitives"][0]["targets"] = {{{"POSITION", up}}};
    const std::vector<Float3> rest = stand(file, 2);
    file.json["meshes"][1]["weights"] = {0.5};
    const std::vector<Float3> moved = stand(file, 2);
    ASSERT_GE(moved.size(), 4u);
    EXPECT_THAT(rest[0], near(0, 0, 5));
    EXPECT_THAT(moved[0], near(0, 0, 7));
    EXPECT_THAT(moved[3], near(0, 100, 1));
}

/// Weights of 0 leave a mesh that nodes share as it is; so do those of nodes outside of the scene.
TEST(Morph, IsSharedWhereNoWeightMovesIt) {
    File file;
    add_targets(file)["meshes"][0]["weights"] = {0, 0.0};
    EXPECT_EQ(load_scene(file.write()).meshes.size(), 1u);
    file.json["nodes"].push_back({{"mesh", 0}, {"weights", {1, 1}}});
    EXPECT_EQ(load_scene(file.write()).meshes.size(), 1u);
    file.json["scenes"][0]["nodes"].push_back(3);
    EXPECT_EQ(load_scene(file.write()).meshes.size(), 3u);
}

/// Nor are others copied for a mesh that weights move.
TEST(Morph, IsSharedBesideOneThatWeightsMove) {
    File file;
    Json& meshes = add_targets(file)["meshes"];
    meshes.push_back(meshes[0]);
    meshes[1]["weights"] = {0.25, 0};
    file.json["nodes"].push_back({{"mesh", 1}});
    file.json["scenes"][0]["nodes"].push_back(3);
    const Scene scene = load_scene(file.write());
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
    EXPECT_THAT(stand(file, 1), ElementsAre(near(0, 0, 0), near(1, 0, 0), near(0, 1, 0)));
    EXPECT_THAT(stand(file, 2), ElementsAre(near(0, 0, 1), near(1, 0, 0), near(0, 1, 0)));
    file.json["nodes"][3]["weights"] = {0, 0};
    EXPECT_EQ(load_scene(file.write()).meshes.size(), 2u) << "the node's weights count";
}

/// A matrix that cannot be used is no matter where the scene does not use it.
TEST(Morph, StandsWhateverOtherNodesAre) {
    File file;
    add_targets(file)["meshes"][0]["weights"] = {0.25, 0.5};
    file.json["nodes"].push_back({{"matrix", Json(std::vector<int>(16, 0))}});
    EXPECT_THAT(stand(file, 0), ElementsAre(near(0, 0, 1), near(2, 0, 0), near(0, 1, 0)));
    file.json["scenes"][0]["nodes"].push_back(3);
    expect_unreadable(file.write(), "the transform of node 3 is not affine");
}

/// load_scene takes the weights that stand, not those of the first key, nor any other motion.
TEST(Morph, StandsWithoutItsAnimation) {
    File file;
    add_targets(file)["meshes"][0]["weights"] = {0.25, 0.5};
    file.move(1, "weights", "STEP", {0}, "SCALAR", 1, {1, 1});
    file.move(1, "translation", "STEP", {0}, "VEC3", 3, {7, 0, 0});
    for (const bool is_readable : {true, false}) {
        if (!is_readable) file.json["animations"] = "nonsense";
        const Scene scene = load_scene(file.write());
        EXPECT_THAT(scene.meshes.at(scene.instances.at(0).mesh).positions,
                    ElementsAre(near(0, 0, 1), near(2, 0, 0), near(0, 1, 0)));
        EXPECT_EQ(scene.instances[0].transform, Matrix34{});
    }
}

TEST(Morph, IsRefusedWhereItContradictsItself) {
    File file;
    add_targets(file)["meshes"][0]["weights"] = {1};
    file.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = file.add<float>("VEC3", {0, 0, 0}, 3);
    expect_unreadable(file.write(), "has 1 elements, but there are 3 vertices");
    file.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 99;
    expect_unreadable(file.write(), "index 99 into 'accessors'");
    file.json["meshes"][0]["weights"] = "x";
    expect_unreadable(file.write(), "'weights' must be");
}

/// Each target keeps a vector for each vertex, also if all have one accessor.
TEST(Morph, HasABudgetForTargets) {
    File file;
    const std::size_t count = 50000;
    std::vector<float> points;
    std::vector<std::uint16_t> corners;
    for (std::size_t i = 0; i + 3 <= count; i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            points.insert(points.end(), {float(i), float(k == 1), float(k == 2)});
            corners.push_back(static_cast<std::uint16_t>(i + k));
        }
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = file.add<float>("VEC3", points, 3);
    primitive["indices"] = file.add<std::uint16_t>("SCALAR", corners);
    file.json["nodes"].erase(2);
    file.json["scenes"][0]["nodes"] = {0};
    const Json target = {{"POSITION", primitive["attributes"]["POSITION"]}};
    primitive["targets"] = Json(std::vector<Json>(800, target));
    EXPECT_EQ(file.open().kind(), MotionKind::None);
    primitive["targets"] = Json(std::vector<Json>(1000, target));
    expect_error([&] { (void)file.open(); }, ErrorCategory::InvalidData,
                 {"scene.gltf", "primitive 0 of mesh 0, for accessor 2, takes 599976 bytes",
                  "together they may take 536870912"});
}

TEST(Morph, HasALimitOfTargetsForFurtherNodes) {
    File file;
    const std::size_t up = file.add<float>("VEC3", {0, 0, 0, 0, 0, 1, 0, 0, 0}, 3);
    const Json target = {{"POSITION", up}};
    file.json["meshes"][0]["primitives"][0]["targets"] = Json(std::vector<Json>(1 << 10, target));
    while (file.json["nodes"].size() < (1 << 10) + 3) file.json["nodes"].push_back({{"mesh", 0}});
    expect_error([&] { (void)file.open(); }, ErrorCategory::InvalidData,
                 {"scene.gltf", "share meshes with more than 2^20 morph targets"});
    EXPECT_EQ(load_scene(file.write()).triangle_count(), 2u) << "which has no targets";
}

}  // namespace

}  // namespace setka::io::test
