// SPDX-License-Identifier: MIT
/// Do nodes, skins, morph targets and cameras of glTF files move as their keys say? Small files, with answers
/// worked out by hand.
#include "setka/animation.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "io/gltf_track.hpp"
#include "scene/transform.hpp"
#include "tests/io/gltf_maker.hpp"

namespace setka::io::test {

namespace {

using Json = nlohmann::json;
using testing::ElementsAre;

const float half = std::sqrt(0.5f);

TEST(Animation, MovesNodesAndWhatIsBelowThem) {
    File file;
    file.move(0, "translation", "LINEAR", {1, 3}, "VEC3", 3, {0, 0, 0, 10, 20, 0});
    file.move(1, "rotation", "LINEAR", {0, 2}, "VEC4", 4, {0, 0, 0, 1, 0, 0, half, half});
    const Animation animation = file.open();
    EXPECT_EQ(animation.kind(), MotionKind::Keyframes);
    EXPECT_EQ(animation.duration_seconds(), 3);
    EXPECT_EQ(animation.frame_count(), 1u);
    EXPECT_EQ(animation.scene().instances.size(), 2u);
    const auto corners = [&](double seconds) {
        const SceneUpdate update = animation.at(seconds);
        EXPECT_EQ(update.placements.size(), 1u) << "only what moves";
        EXPECT_EQ(update.placements.at(0).instance, 0u);
        EXPECT_TRUE(update.vertices.empty());
        std::vector<Float3> points;
        for (const Float3 p : {Float3{0, 0, 0}, Float3{1, 0, 0}})
            points.push_back(transform_point(update.placements.at(0).transform, p));
        return points;
    };
    EXPECT_THAT(corners(-5), ElementsAre(near(0, 0, 0), near(1, 0, 0))) << "the first key holds";
    EXPECT_THAT(corners(1), ElementsAre(near(0, 0, 0), near(half, half, 0)));
    EXPECT_THAT(corners(2), ElementsAre(near(5, 10, 0), near(5, 11, 0)));
    EXPECT_THAT(corners(1000), ElementsAre(near(10, 20, 0), near(10, 21, 0))) << "the last key holds";
}

TEST(Animation, MovesWhatIsBelowANodeThatMoves) {
    File file;
    file.move(0, "translation", "LINEAR", {0, 1}, "VEC3", 3, {0, 0, 0, 4, 0, 0});
    const SceneUpdate update = file.open().at(0.5);
    ASSERT_EQ(update.placements.size(), 1u);
    EXPECT_EQ(update.placements[0].instance, 0u);
    EXPECT_EQ(update.placements[0].transform.rows[3], 2);
}

TEST(Animation, OpensAtItsFirstMoment) {
    File file;
    file.move(1, "translation", "STEP", {0, 1}, "VEC3", 3, {7, 0, 0, 8, 0, 0});
    const Animation animation = file.open();
    EXPECT_EQ(animation.scene().instances[0].transform.rows[3], 7) << "not as the file has it at rest";
    EXPECT_EQ(animation.scene().instances[1].transform, Matrix34{});
}

TEST(Animation, StepsAndSplines) {
    File file;
    file.move(1, "translation", "STEP", {0, 1, 2}, "VEC3", 3, {0, 0, 0, 1, 0, 0, 2, 0, 0});
    // In tangent, value, out tangent; over two seconds.
    file.move(2, "scale", "CUBICSPLINE", {0, 2}, "VEC3", 3,
              {9, 9, 9, 1, 1, 1, 4, 0, 0, /**/ 0, 0, 2, 3, 3, 3, 9, 9, 9});
    const Animation animation = file.open();
    const auto rows = [&](double seconds, std::size_t which) {
        return animation.at(seconds).placements.at(which).transform.rows;
    };
    EXPECT_EQ(rows(0.999, 0)[3], 0);
    EXPECT_EQ(rows(1, 0)[3], 1);
    EXPECT_EQ(rows(1.999, 0)[3], 1);
    // Half way: the mean, and an eighth of the time times the difference of the tangents.
    EXPECT_FLOAT_EQ(rows(1, 1)[0], 2 + 2 / 8.0f * 4);
    EXPECT_FLOAT_EQ(rows(1, 1)[5], 2);
    EXPECT_FLOAT_EQ(rows(1, 1)[10], 2 - 2 / 8.0f * 2);
    EXPECT_FLOAT_EQ(rows(0.5, 1)[5], 1 + 2 * (3 / 16.0f - 2 / 64.0f)) << "a quarter of the way";
    EXPECT_FLOAT_EQ(rows(2, 1)[0], 3);
}

TEST(Animation, TurnsAlongTheShortestArcAtEvenSpeed) {
    const double angle = 2.8;
    const std::array<double, 4> from{0, 0, 0, 1}, to{std::sin(angle / 2), 0, 0, std::cos(angle / 2)};
    for (const double share : {0.0, 0.1, 0.25, 0.5, 0.9, 0.999999}) {
        for (const double sign : {1.0, -1.0}) {
            const auto q = detail::slerp(from, {to[0] * sign, 0, 0, to[3] * sign}, share);
            EXPECT_NEAR(q[0], std::sin(share * angle / 2), 1e-14) << share;
            EXPECT_NEAR(q[3], std::cos(share * angle / 2), 1e-14) << share;
        }
    }
}

/// Bits that the same file has to give on every machine: of rotations, splines and products of nodes.
TEST(Animation, HasTheSameBitsEverywhere) {
    File file;
    file.move(0, "rotation", "LINEAR", {0, 1}, "VEC4", 4, {0.1f, 0.2f, 0.3f, 0.9f, -0.7f, 0.1f, 0.5f, 0.2f});
    file.move(1, "rotation", "CUBICSPLINE", {0, 1}, "VEC4", 4,
              {0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 2, 0, 0, 1, 0, 0, 0.6f, 0, 0.8f, 0, 0, 0, 0, 0});
    file.move(1, "scale", "LINEAR", {0, 1}, "VEC3", 3, {1, 2, 3, 0.3f, 0.7f, 1.1f});
    const Matrix34 matrix = file.open().at(1 / 3.0).placements.at(0).transform;
    EXPECT_THAT(matrix.rows,
                ElementsAre(-0x1.6389p-2f, -0x1.c62dfcp-1f, 0x1.a142ap+0f, 0, 0x1.5d58f6p-1f, -0x1.82842p-2f,
                            0x1.d51f62p-1f, 0, -0x1.4ea2e2p-5f, 0x1.3c251p+0f, 0x1.736a4ep+0f, 0));
}

TEST(Animation, MovesSkins) {
    File file;
    add_skin(file);
    file.move(4, "translation", "LINEAR", {0, 1}, "VEC3", 3, {0, 0, 0, 8, 0, 0});
    const Animation animation = file.open();
    const SceneUpdate update = animation.at(0.5);
    EXPECT_TRUE(update.placements.empty()) << "a skinned mesh keeps its instance";
    ASSERT_EQ(update.vertices.size(), 1u);
    const std::uint32_t mesh = update.vertices[0].mesh;
    EXPECT_EQ(animation.scene().instances.at(2).mesh, mesh);
    EXPECT_EQ(animation.scene().instances.at(2).transform, Matrix34{});
    // Triangles of the scene may have repeated vertices for their creases: the first four are the file's.
    const std::vector<Float3> first(update.vertices[0].positions.begin(),
                                    update.vertices[0].positions.begin() + 4);
    EXPECT_THAT(first, ElementsAre(near(0, 0, 5), near(5, 0, 0), near(2, 1, 2.5f), near(0, 100, 1)));
    EXPECT_EQ(update.vertices[0].normals.size(), animation.scene().meshes[mesh].normals.size());
    // At rest it is what load_scene makes of it.
    EXPECT_EQ(animation.scene().meshes[mesh].positions, load_scene(file.write()).meshes[mesh].positions);
    EXPECT_EQ(animation.scene().meshes[mesh].normals, load_scene(file.write()).meshes[mesh].normals);
}

/// More vertices than one thread gets, each in a place of its own.
TEST(Animation, MovesEveryVertexOfALargeSkin) {
    File file;
    const std::size_t count = 60000;
    std::vector<float> positions, weights;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint16_t> indices;
    for (std::size_t i = 0; i < count; ++i) {
        for (const float value : {float(i), float(i % 3), float(i % 2)}) positions.push_back(value);
        for (const float value : {1.0f, 0.0f, 0.0f, 0.0f}) weights.push_back(value);
        joints.insert(joints.end(), 4, 0);
        indices.push_back(static_cast<std::uint16_t>(i));
    }
    add_skin(file);
    Json& primitive = file.json["meshes"][1]["primitives"][0];
    primitive["attributes"]["POSITION"] = file.add<float>("VEC3", positions, 3);
    primitive["attributes"]["JOINTS_0"] = file.add<std::uint8_t>("VEC4", joints, 4);
    primitive["attributes"]["WEIGHTS_0"] = file.add<float>("VEC4", weights, 4);
    primitive["indices"] = file.add<std::uint16_t>("SCALAR", indices);
    file.move(3, "translation", "LINEAR", {0, 1}, "VEC3", 3, {0, 0, 0, 0, 0, 64});
    const SceneUpdate update = file.open().at(0.25);
    ASSERT_EQ(update.vertices.at(0).positions.size(), count);
    for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(update.vertices[0].positions[i], (Float3{float(i), float(i % 3), float(i % 2) + 16}));
}

TEST(Animation, MovesTheCamera) {
    File file;
    file.json["cameras"] =
        Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.7853982, "znear": 0.1}}])");
    file.json["nodes"][0]["camera"] = 0;
    file.move(0, "translation", "LINEAR", {0, 1}, "VEC3", 3, {0, 0, 1, 0, 0, 3});
    const Animation animation = file.open();
    ASSERT_TRUE(animation.scene().camera);
    EXPECT_EQ(animation.scene().camera->eye, (Float3{0, 0, 1}));
    const SceneUpdate update = animation.at(0.5);
    ASSERT_TRUE(update.camera);
    EXPECT_EQ(update.camera->eye, (Float3{0, 0, 2}));
    EXPECT_NEAR(update.camera->vertical_fov_degrees, 45, 1e-3);
}

TEST(Animation, IsChosenByNameOrNumber) {
    File file;
    for (std::size_t i = 0; i < 3; ++i)
        file.move(1, "translation", "STEP", {0}, "VEC3", 3, {float(i + 1), 0, 0}, i);
    file.json["animations"][0]["name"] = "walk";
    file.json["animations"][1]["name"] = "run";
    const auto place = [&](const std::string& name) {
        return file.open(name).scene().instances[0].transform.rows[3];
    };
    EXPECT_EQ(place(""), 1);
    EXPECT_EQ(place("walk"), 1);
    EXPECT_EQ(place("run"), 2);
    EXPECT_EQ(place("2"), 3);
    EXPECT_THAT(file.open().names(), ElementsAre("walk", "run", "2"));
    expect_error([&] { (void)file.open("swim"); }, ErrorCategory::InvalidArgument,
                 {"animation = 'swim'", "scene.gltf", "'walk', 'run', '2'"});
    expect_error([&] { (void)file.open("3"); }, ErrorCategory::InvalidArgument, {"animation = '3'"});
}

TEST(Animation, OfAFileWithoutMotionIsOneFrame) {
    const File file;
    const Animation animation = file.open();
    EXPECT_EQ(animation.kind(), MotionKind::None);
    EXPECT_EQ(animation.duration_seconds(), 0);
    EXPECT_EQ(animation.frame_count(), 1u);
    EXPECT_TRUE(animation.at(3).placements.empty());
    expect_error([&] { (void)animation.frame(0); }, ErrorCategory::InvalidArgument, {"frame = 0"});
    expect_error([&] { (void)file.open("walk"); }, ErrorCategory::InvalidArgument,
                 {"'walk'", "has no animation"});
    expect_error([&] { (void)animation.at(std::nan("")); }, ErrorCategory::InvalidArgument, {"seconds = "});
    const Folder folder;
    const Animation mesh(folder.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    EXPECT_EQ(mesh.kind(), MotionKind::None);
    EXPECT_EQ(mesh.scene().triangle_count(), 1u);
}

TEST(Animation, IsRefusedWhereItContradictsItself) {
    const auto refuses = [](const std::function<void(File&)>& spoil, const std::string& reason) {
        File file;
        add_skin(file);
        file.move(1, "translation", "LINEAR", {0, 1}, "VEC3", 3, {0, 0, 0, 1, 0, 0});
        spoil(file);
        SCOPED_TRACE(reason);
        expect_error([&] { (void)file.open().at(1); }, ErrorCategory::InvalidData, {"scene.gltf", reason});
    };
    const auto set = [](const char* pointer, const Json& value) {
        return [=](File& file) { file.json[Json::json_pointer(pointer)] = value; };
    };
    refuses(
        [](File& f) {
            f.move(1, "scale", "LINEAR", {0, 1}, "VEC3", 3, {1, 1, 1, 0, 1, 1});
        },
        "the transform of node 1 'wheel' is singular at 1.0");
    refuses(
        [](File& f) {
            f.move(0, "scale", "LINEAR", {0, 1}, "VEC3", 3, {1, 1, 1, 3e38f, 1, 1});
            f.move(1, "scale", "LINEAR", {0, 1}, "VEC3", 3, {1, 1, 1, 3e38f, 1, 1});
        },
        "the transform of node 1 'wheel' is not finite at 1.0");
    refuses(
        [](File& f) {
            f.move(1, "scale", "LINEAR", {0}, "VEC3", 3, {NAN, 1, 1});
        },
        "value 0 is not finite");
    refuses(
        [](File& f) {
            f.move(1, "scale", "LINEAR", {0, 1}, "VEC3", 3, {1, 1, 1});
        },
        "has 3 numbers for 2 keys; 6 are needed");
    refuses(
        [](File& f) {
            f.move(1, "scale", "LINEAR", {1, 0}, "VEC3", 3, {1, 1, 1, 1, 1, 1});
        },
        "must not fall");
    refuses(
        [](File& f) {
            f.move(1, "rotation", "LINEAR", {0}, "VEC3", 3, {1, 1, 1});
        },
        "VEC4 is needed here");
    refuses([](File& f) { f.move(1, "weights", "LINEAR", {0}, "SCALAR", 1, {1}); }, "no morph targets");
    refuses(set("/animations/0/samplers/0/interpolation", "WAVE"),
            "'WAVE'; known are LINEAR, STEP and CUBICSPLINE");
    refuses(set("/animations/0/samplers/0/input", 99), "index 99 into 'accessors'");
    refuses(set("/animations/0/channels/0/sampler", 1),
            "channel 0 of animation '0' has sampler 1; there are 1");
    refuses(set("/animations/0/channels/0/target/node", 77), "index 77 into 'nodes'");
    refuses(set("/animations/0/channels/0/target/path", "colour"), "'colour'; known are translation");
    refuses(set("/animations/0/channels", 3), "'channels' must be");
    refuses(set("/nodes/1/matrix", Json(std::vector<int>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})),
            "moves node 1, which has a matrix");
    refuses(
        [](File& f) {
            f.json["meshes"][0]["primitives"][0]["targets"] = {
                {{"POSITION", f.add<float>("VEC3", {0, 0, 0}, 3)}}};
        },
        "has 1 elements, but there are 3 vertices");
    refuses([](File& f) { f.json["skins"][0]["joints"] = {3}; }, "hangs on joint 1; the skin has 1");
}

/// Zeros that take no space in the file, as many as are believed.
std::size_t add_zeros(File& file, const char* type) {
    const std::size_t place = file.add<std::uint16_t>("SCALAR", {0}),
                      value = file.add<float>(type, {0, 0, 0, 1}, 4);
    const auto view = [&](std::size_t i) { return file.json["accessors"][i]["bufferView"]; };
    const Json sparse = {{"count", 1},
                         {"indices", {{"bufferView", view(place)}, {"componentType", 5123}}},
                         {"values", {{"bufferView", view(value)}}}};
    file.json["accessors"].push_back(
        {{"componentType", 5126}, {"count", 1 << 22}, {"type", type}, {"sparse", sparse}});
    return file.json["accessors"].size() - 1;
}

void turn(File& file, std::size_t input, std::size_t output) {
    file.move(1, "rotation", "STEP", {0}, "VEC4", 4, {0, 0, 0, 1});
    file.json["animations"][0]["samplers"].back() = {{"input", input}, {"output", output}};
}

/// Small files could ask for any amount of memory. A channel of these takes 2^25 bytes of times and 2^27 of
/// values: four are above 2^29 if they share the times, and any number is not if they share the values too.
TEST(Animation, HasABudgetForAllThatIsDecoded) {
    File file;
    const std::size_t times = add_zeros(file, "SCALAR"), values = add_zeros(file, "VEC4");
    for (int i = 0; i < 100; ++i) turn(file, times, values);
    EXPECT_EQ(file.open().kind(), MotionKind::Keyframes);
    for (int i = 0; i < 3; ++i) turn(file, times, add_zeros(file, "VEC4"));
    expect_error([&] { (void)file.open(); }, ErrorCategory::InvalidData,
                 {"scene.gltf", "accessor " + std::to_string(file.json["accessors"].size() - 3),
                  " takes 134217728 bytes beside 436207616", "together they may take 536870912"});
}

/// What is refused when a picture of it is wanted must not depend on its motion.
TEST(Animation, IsNoConcernOfLoadScene) {
    File file;
    file.json["animations"] = "nonsense";
    EXPECT_EQ(load_scene(file.write()).triangle_count(), 2u);
}

class AnimationFile : public testing::TestWithParam<const char*> {};

/// Each animation of the reference scenes, at many times.
TEST_P(AnimationFile, StaysFinite) {
    const std::filesystem::path path = scenes_folder() / GetParam();
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const Animation first(path);
    ASSERT_EQ(first.kind(), MotionKind::Keyframes);
    EXPECT_EQ(first.scene().triangle_count(), load_scene(path).triangle_count());
    for (const std::string& name : first.names()) {
        const Animation animation(path, name);
        Scene scene = animation.scene();
        const Bounds rest = scene.bounds();
        for (int i = 0; i <= 10; ++i) apply(scene, animation.at(animation.duration_seconds() * i / 10));
        const Bounds moved = scene.bounds();
        for (int axis = 0; axis < 3; ++axis) {
            const float size = rest.upper[axis] - rest.lower[axis];
            EXPECT_NEAR(moved.upper[axis], rest.upper[axis], size) << name << ": it stays about where it was";
            EXPECT_NEAR(moved.lower[axis], rest.lower[axis], size) << name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, AnimationFile,
                         testing::Values("gltf/CesiumMilkTruck.glb", "gltf/pigman/scene.gltf"),
                         [](const auto& test) { return test.param[5] == 'C' ? "truck" : "pigman"; });

}  // namespace

}  // namespace setka::io::test
