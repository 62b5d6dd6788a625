// SPDX-License-Identifier: MIT
/// Do numbered files become the frames of one scene, and does it say which file does not fit?
#include <cmath>

#include "io/raw_mesh.hpp"
#include "setka/animation.hpp"
#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

using testing::ElementsAre;

/// A quad of two triangles that bends: its fourth corner is at this height.
std::string quad_ply(const std::string& height, const std::string& faces = "3 0 1 2\n3 0 2 3\n") {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n1 1 0\n0 1 " +
           height + "\n" + faces;
}

Float3 last(const SceneUpdate& update) { return update.vertices.at(0).positions.at(3); }

TEST(Sequence, TakesVerticesOfEachFrame) {
    const Folder folder;
    for (const int number : {8, 9, 10, 11})
        (void)folder.write("cloth_" + std::to_string(number) + ".ply", quad_ply(std::to_string(number - 8)));
    (void)folder.write("cloth_rest.ply", "no frame");
    (void)folder.write("notes1.txt", "no mesh");
    std::vector<std::filesystem::path> list;
    for (const int number : {10, 8, 9, 11})
        list.push_back(folder / ("cloth_" + std::to_string(number) + ".ply"));
    const Animation by_pattern(folder / "cloth_%03d.ply"), by_folder(folder.path()), by_list(list);
    for (const Animation* animation : {&by_pattern, &by_folder, &by_list}) {
        EXPECT_EQ(animation->kind(), MotionKind::Sequence);
        EXPECT_EQ(animation->duration_seconds(), 0);
        EXPECT_EQ(animation->first_frame(), 8u);
        ASSERT_EQ(animation->frame_count(), 4u);
        EXPECT_EQ(animation->files()[2].filename(), "cloth_10.ply") << "by number, not by letters";
        EXPECT_EQ(animation->scene().triangle_count(), 2u);
        EXPECT_EQ(last(animation->frame(8)).z, 0);
        EXPECT_EQ(last(animation->frame(11)).z, 3);
        Scene scene = animation->scene();
        apply(scene, animation->frame(11));
        scene.validate();
        apply(scene, animation->frame(8));
        EXPECT_EQ(scene.meshes[0].positions, animation->scene().meshes[0].positions);
        EXPECT_EQ(scene.meshes[0].normals, animation->scene().meshes[0].normals);
    }
    expect_error([&] { (void)by_folder.frame(12); }, ErrorCategory::InvalidArgument,
                 {"frame = 12", "8 to 11"});
    expect_error([&] { (void)by_folder.frame(7); }, ErrorCategory::InvalidArgument, {"frame = 7"});
    expect_error([&] { (void)by_folder.at(0); }, ErrorCategory::InvalidArgument, {"seconds", "8 to 11"});
    expect_error([&] { (void)Animation(folder.path(), "walk"); }, ErrorCategory::InvalidArgument, {"'walk'"});
}

/// Flat at first, so one normal a vertex; folded later, by more than a crease, they are still shared.
TEST(Sequence, KeepsTheEdgesOfTheFirstFrame) {
    const Folder folder;
    (void)folder.write("a1.ply", quad_ply("0"));
    (void)folder.write("a2.ply", quad_ply("5"));
    const Animation animation(folder / "a%d.ply");
    const SceneUpdate update = animation.frame(2);
    ASSERT_EQ(update.vertices[0].positions.size(), 4u);
    const Float3 own = update.vertices[0].normals[3];
    const float length = std::sqrt(51.0f);  // the upper triangle's normal is (5, -5, 1)
    EXPECT_NEAR(own.x, 5 / length, 1e-6f);
    EXPECT_NEAR(own.y, -5 / length, 1e-6f);
    const Float3 shared = update.vertices[0].normals[0];  // with the lower one's (0, 0, 1)
    EXPECT_NEAR(shared.x, 5 / std::sqrt(54.0f), 1e-6f);
    EXPECT_NEAR(shared.z, 2 / std::sqrt(54.0f), 1e-6f);
}

/// The other way round: an edge that is sharp in the first frame stays sharp, and its vertices stay together.
TEST(Sequence, MovesRepeatedVerticesTogether) {
    const Folder folder;
    (void)folder.write("a1.ply", quad_ply("5"));
    (void)folder.write("a2.ply", quad_ply("0"));
    const Animation animation(folder / "a%d.ply");
    const SceneUpdate update = animation.frame(2);
    ASSERT_EQ(update.vertices[0].positions.size(), 6u) << "two corners are repeated";
    EXPECT_EQ(update.vertices[0].positions[4], update.vertices[0].positions[0]);
    EXPECT_EQ(update.vertices[0].positions[5], update.vertices[0].positions[2]);
    EXPECT_THAT(update.vertices[0].normals, testing::Each(Float3{0, 0, 1})) << "flat: all the same";
}

/// What remake_normals makes of a mesh where it stands is what make_normals made.
TEST(Sequence, RemakesTheNormalsThatWereMade) {
    for (const char* name : {"scan/fandisk.obj", "dynamic/rod-twist/3036.ply"}) {
        const std::filesystem::path path = scenes_folder() / name;
        if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
        const Mesh mesh = load_scene(path).meshes[0];
        detail::RawMesh raw;
        raw.positions = mesh.positions;
        for (const Triangle& t : mesh.triangles) {
            raw.corners.insert(raw.corners.end(), {t.a, t.b, t.c});
            raw.end_face();
        }
        const detail::TracedMesh traced = detail::finish_traced_mesh(path, raw);
        ASSERT_EQ(traced.normals_from, detail::NormalsFrom::Faces);
        const detail::NormalRecipe recipe = detail::normal_recipe(traced.mesh, traced.sources);
        EXPECT_EQ(detail::remake_normals(recipe, traced.mesh.triangles, traced.mesh.positions),
                  traced.mesh.normals);
    }
}

TEST(Sequence, ReadsObjByItsIndices) {
    const Folder folder;
    // Two groups, written so that they do not follow their vertices; corners meet at first and part later,
    // and the normals are listed in another order in the second frame.
    const std::string first =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv -1 0 0\nv 0 -1 0\nvn 0 0 1\nvn 0 1 0\n"
        "g left\nf 4//2 5//2 6//2\ng right\nf 1//1 2//1 3//1\n";
    const std::string second =
        "vn 0 1 0\nvn 0 0 1\nv 0 0 7\nv 1 0 0\nv 0 1 0\nv 0 0 -7\nv -1 0 0\nv 0 -1 0\n"
        "g left\nf 4//1 5//1 6//1\ng right\nf 1//2 2//2 3//2\n";
    (void)folder.write("a1.obj", first);
    (void)folder.write("a2.obj", second);
    const Animation animation(folder / "a%d.obj");
    ASSERT_EQ(animation.scene().meshes.size(), 2u);
    const SceneUpdate update = animation.frame(2);
    ASSERT_EQ(update.vertices.size(), 2u);
    EXPECT_THAT(update.vertices[0].positions,
                ElementsAre(Float3{0, 0, -7}, Float3{-1, 0, 0}, Float3{0, -1, 0}));
    EXPECT_THAT(update.vertices[1].positions, ElementsAre(Float3{0, 0, 7}, Float3{1, 0, 0}, Float3{0, 1, 0}));
    EXPECT_THAT(update.vertices[0].normals, testing::Each(Float3{0, 1, 0}));
    EXPECT_THAT(update.vertices[1].normals, testing::Each(Float3{0, 0, 1}));
}

std::string stl(const std::string& apex_a, const std::string& apex_b) {
    const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
        return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
               "\nendloop\nendfacet\n";
    };
    return "solid s\n" + facet("0 0 0", "1 0 0", apex_a) + facet("0 0 0", apex_b, "-1 0 0") + "endsolid s\n";
}

TEST(Sequence, OfStlKeepsTrianglesTogether) {
    const Folder folder;
    (void)folder.write("a1.stl", stl("0 1 0", "0 1 0"));
    (void)folder.write("a2.stl", stl("0 1 3", "0 1 3"));
    (void)folder.write("a3.stl", stl("0 1 3", "0 1 4"));
    const Animation animation(folder / "a%d.stl");
    EXPECT_EQ(animation.frame(2).vertices.at(0).positions.size(), 4u);
    expect_error([&] { (void)animation.frame(3); }, ErrorCategory::InvalidData,
                 {"a3.stl", "frame 3", "parts triangle 1", "frame 1"});
}

TEST(Sequence, SaysWhatDoesNotFit) {
    const Folder folder;
    const auto refuses = [&](const std::string& second, const std::vector<std::string>& phrases) {
        SCOPED_TRACE(phrases[0]);
        (void)folder.write("a1.ply", quad_ply("0"));
        (void)folder.write("a2.ply", second);
        const Animation animation(folder / "a%d.ply");
        expect_error([&] { (void)animation.frame(2); }, ErrorCategory::InvalidData, phrases);
    };
    const std::string good = quad_ply("1");
    refuses(quad_ply("1", "3 0 1 2\n3 0 3 2\n"),
            {"a2.ply", "frame 2 has face 1", "'0 3 2' instead of '0 2 3'", "frame 1"});
    refuses(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n",
        {"a2.ply", "frame 2 has 3 vertices instead of 4"});
    refuses(
        good.substr(0, good.find("element face 2")) + "element face 1" +
            good.substr(good.find("element face 2") + 14, good.size() - good.find("element face 2") - 14 - 8),
        {"a2.ply", "frame 2 has 1 faces instead of 2"});
    refuses(quad_ply("nan"), {"a2.ply", "frame 2 has a vertex that is not finite: 3"});
    refuses("nonsense", {"a2.ply"});
}

TEST(Sequence, SaysWhichFilesAreMissing) {
    const Folder folder;
    const auto refuses = [&](const std::filesystem::path& what, const std::vector<std::string>& phrases) {
        expect_error([&] { (void)Animation(what); }, ErrorCategory::InvalidData, phrases);
    };
    refuses(folder / "a%d.ply", {"a%d.ply", "no file of this name"});
    refuses(folder.path(), {"no mesh file whose name ends with a number"});
    refuses(folder / "none", {"none"});
    for (const char* name : {"a1.ply", "a2.ply", "a4.ply"}) (void)folder.write(name, quad_ply("0"));
    refuses(folder / "a%d.ply", {"a4.ply", "frame 3 is missing", "'a2.ply'"});
    refuses(folder.path(), {"frame 3 is missing"});
    (void)folder.write("a02.ply", quad_ply("0"));
    refuses(folder / "a%d.ply", {"frame 2", "'a02.ply'"});
    (void)folder.write("b1.ply", quad_ply("0"));
    refuses(folder.path(), {"several names", "'b1.ply'", "'a%d.ply'"});
    (void)folder.write("c1.glb", "glTF");
    refuses(folder / "c%d.glb", {"c1.glb", "motion of its own"});
    const std::vector<std::filesystem::path> unnumbered{folder.write("rest.ply", quad_ply("0"))}, none;
    expect_error([&] { (void)Animation(unnumbered); }, ErrorCategory::InvalidData,
                 {"rest.ply", "does not end with a number"});
    expect_error([&] { (void)Animation(none); }, ErrorCategory::InvalidArgument, {"at least one"});
}

class SequenceFolder : public testing::TestWithParam<std::pair<const char*, std::uint32_t>> {};

TEST_P(SequenceFolder, IsReadWhole) {
    const auto& [name, count] = GetParam();
    const std::filesystem::path path = scenes_folder() / "dynamic" / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const Animation animation(path);
    ASSERT_EQ(animation.frame_count(), count);
    Scene scene = animation.scene();
    EXPECT_EQ(scene.triangle_count(), load_scene(animation.files()[0]).triangle_count());
    for (std::uint32_t i = 0; i < count; ++i) {
        apply(scene, animation.frame(animation.first_frame() + i));
        const Bounds moved = scene.bounds(), alone = load_scene(animation.files()[i]).bounds();
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_FLOAT_EQ(moved.lower[axis], alone.lower[axis]) << "frame " << i;
            EXPECT_FLOAT_EQ(moved.upper[axis], alone.upper[axis]) << "frame " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SequenceFolder,
                         testing::Values(std::pair("horse_poses", 10u), std::pair("cloth-ball", 2u),
                                         std::pair("cloth-funnel", 2u), std::pair("rod-twist", 2u)),
                         [](const auto& test) {
                             std::string name = test.param.first;
                             std::erase(name, '-');
                             return name;
                         });

}  // namespace

}  // namespace setka::io::test
