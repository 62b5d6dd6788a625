// SPDX-License-Identifier: MIT
/// Does tests/tools/lux_to_gltf.py make the scene that LuxCore's text says? A small one, written by hand.
#include <cmath>
#include <cstdlib>

#include "setka/animation.hpp"
#include "tests/io/gltf_maker.hpp"

namespace setka::io::test {

namespace {

/// A quad in the xy plane as a binary PLY file, with normals and a texture coordinate that nobody asks for.
std::string quad() {
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nelement face 1\n"
        "property list uchar uint vertex_indices\nend_header\n";
    for (const auto& [x, y] : {std::pair(0.0f, 0.0f), {2.0f, 0.0f}, {2.0f, 1.0f}, {0.0f, 1.0f}})
        for (const float value : {x, y, 0.0f, 0.0f, 0.0f, 2.0f, 0.5f}) text += bytes_of(value);
    text += '\4';
    for (const std::uint32_t corner : {0u, 1u, 2u, 3u}) text += bytes_of(corner);
    return text;
}

/// Two objects of one mesh, of which one is placed, and one of the same mesh in another material.
constexpr const char* scene_text = R"(# a comment
scene.camera.lookat.orig = 0 -10 5
scene.camera.lookat.target = 0 0 5
scene.camera.up = 0 0 1
scene.camera.fieldofview = 90
scene.materials.red.type = "matte"
scene.materials.red.kd = 0.5 0.25 0.125
scene.materials.grey.kd = 0.5
scene.objects.a.ply = "quad.ply"
scene.objects.a.material = "red"
scene.objects.b.ply = "quad.ply"
scene.objects.b.material = "red"
scene.objects.b.transformation = 0 2 0 0 0 0 2 0 2 0 0 0 10 20 30 1
scene.objects.c.ply = "quad.ply"
scene.objects.c.material = "grey"
)";

class Lux : public testing::Test {
  protected:
    void SetUp() override {
        (void)folder_.write("quad.ply", quad());
        (void)folder_.write("scene.scn", scene_text);
    }

    /// Runs the converter; its exit status.
    [[nodiscard]] int convert(const std::string& options = {}) const {
        const std::string command = "python3 " SETKA_LUX_TO_GLTF " '" + (folder_ / "scene.scn").string() + "' '" + output().string() +
                                    "' " + options + " > '" + (folder_ / "log").string() + "' 2>&1";
        return std::system(command.c_str());
    }
    [[nodiscard]] std::filesystem::path output() const { return folder_ / "scene.gltf"; }

    Folder folder_;
};

TEST_F(Lux, KeepsMeshesInstancesMaterialsAndTheCamera) {
    ASSERT_EQ(convert(), 0) << read_bytes(folder_ / "log");
    const Scene scene = load_scene(output());
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh) << "nothing is copied";
    const Mesh& mesh = scene.meshes[scene.instances[0].mesh];
    EXPECT_THAT(mesh.positions, testing::ElementsAre(near(0, 0, 0), near(2, 0, 0), near(2, 1, 0), near(0, 1, 0)));
    EXPECT_THAT(mesh.normals, testing::Each(near(0, 0, 1)));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(scene.instances[1].transform, (Matrix34{{0, 0, 2, 10, 2, 0, 0, 20, 0, 2, 0, 30}}));
    EXPECT_THAT(scene.materials[scene.instances[1].material].diffuse, near(0.5f, 0.25f, 0.125f));
    EXPECT_THAT(scene.materials[scene.instances[2].material].diffuse, near(0.5f, 0.5f, 0.5f));
    ASSERT_TRUE(scene.camera);
    EXPECT_THAT(scene.camera->eye, near(0, -10, 5));
    EXPECT_NEAR(scene.camera->vertical_fov_degrees, 2 * std::atan(9.0 / 16) * 180 / 3.14159265358979, 1e-3);
}

TEST_F(Lux, TurnsInstancesAboutTheirOwnAxis) {
    ASSERT_EQ(convert("--spin 4"), 0) << read_bytes(folder_ / "log");
    const Animation animation(output());
    EXPECT_EQ(animation.duration_seconds(), 4);
    const SceneUpdate quarter = animation.at(1);
    ASSERT_EQ(quarter.placements.size(), 1u) << "an object that is not placed stays";
    // b takes x to y, y to z, z to x, at twice the size. After a quarter turn, x goes where y went, and y where -x went.
    const auto& rows = quarter.placements[0].transform.rows;
    const float expected[12] = {0, 0, 2, 10, 0, -2, 0, 20, 2, 0, 0, 30};
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(rows[i], expected[i], 1e-5) << i;
}

TEST_F(Lux, RefusesWhatItWouldShowWrong) {
    (void)folder_.write("scene.scn", std::string(scene_text) + "scene.objects.b.transformation 1 0\n");
    EXPECT_NE(convert(), 0);
    EXPECT_THAT(read_bytes(folder_ / "log"), testing::HasSubstr("scene.scn:16: no \"=\""));
    (void)folder_.write("scene.scn", std::string(scene_text) + "scene.objects.b.transformation = 1 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1\n");
    EXPECT_NE(convert("--spin 4"), 0);
    EXPECT_THAT(read_bytes(folder_ / "log"), testing::HasSubstr("sheared"));
}

}  // namespace

}  // namespace setka::io::test
