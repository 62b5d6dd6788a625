// SPDX-License-Identifier: MIT
/// Does a scene survive being saved and loaded again, and does a failure leave nothing behind?
#include <limits>

#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

Scene tetrahedron() {
    Scene scene;
    const float denormal = std::numeric_limits<float>::denorm_min();
    scene.meshes.push_back({"t",
                            {{0.1f, denormal, -0.0f}, {1e30f, 0, 0}, {0, 1.0000001f, 0}, {0, 0, 16777216}},
                            {{3, 2, 1}, {0, 1, 3}, {0, 0, 2}, {1, 2, 0}},
                            {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                            {}});
    scene.materials.emplace_back();
    scene.instances.emplace_back();
    return scene;
}

TEST(SavePly, KeepsEveryBitOfAMesh) {
    const Folder folder;
    const Scene scene = tetrahedron();
    save_ply(folder / "a.ply", scene);
    const Scene again = load_scene(folder / "a.ply");
    ASSERT_EQ(again.meshes.size(), 1u);
    const Mesh &a = scene.meshes[0], &b = again.meshes[0];
    EXPECT_EQ(b.triangles, a.triangles);
    ASSERT_EQ(b.positions.size(), a.positions.size());
    EXPECT_EQ(std::memcmp(b.positions.data(), a.positions.data(), a.positions.size() * sizeof(Float3)), 0);
    EXPECT_EQ(b.normals, a.normals);
}

TEST(SavePly, MovesInstances) {
    const Folder folder;
    Scene scene = tetrahedron();
    scene.instances.emplace_back();
    scene.instances[1].transform.rows = {0, -2, 0, 5, 2, 0,
                                         0, 6,  0, 0, 2, 7};  // a quarter turn about z, twice as large
    save_ply(folder / "a.ply", scene);
    const Mesh mesh = load_scene(folder / "a.ply").meshes[0];
    ASSERT_EQ(mesh.triangles.size(), 8u);
    EXPECT_EQ(mesh.triangles[4], (Triangle{7, 6, 5}));
    EXPECT_EQ(mesh.positions[6], (Float3{5 - 2 * 1.0000001f, 6, 7}));
    EXPECT_EQ(mesh.normals[5], (Float3{-1, 0, 0}));
}

TEST(SavePly, WithoutNormalsWritesNone) {
    const Folder folder;
    Scene scene = tetrahedron();
    scene.meshes[0].normals.clear();
    save_ply(folder / "a.ply", scene);
    EXPECT_EQ(read_bytes(folder / "a.ply").find("property float nx"), std::string::npos);
}

TEST(SavePly, LeavesNothingBehindOnFailure) {
    const Folder folder;
    expect_error([&] { save_ply(folder / "absent/a.ply", tetrahedron()); }, ErrorCategory::InvalidArgument,
                 {"a.ply", "no directory"});
    std::filesystem::create_directory(folder / "d.ply");
    expect_error([&] { save_ply(folder / "d.ply", tetrahedron()); }, ErrorCategory::InvalidArgument,
                 {"d.ply", "directory"});
    EXPECT_THROW(save_ply(folder / "b.ply", Scene{}), Error);
    EXPECT_EQ(folder.file_count(), 1u);
}

TEST(SavePly, KeepsTheOldFileUntilTheNewOneIsComplete) {
    const Folder folder;
    (void)folder.write("a.ply", "old");
    EXPECT_THROW(save_ply(folder / "a.ply", Scene{}), Error);
    EXPECT_EQ(read_bytes(folder / "a.ply"), "old");
    save_ply(folder / "a.ply", tetrahedron());
    EXPECT_EQ(load_scene(folder / "a.ply").triangle_count(), 4u);
    EXPECT_EQ(folder.file_count(), 1u);
}

}  // namespace

}  // namespace setka::io::test
