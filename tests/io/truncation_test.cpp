// SPDX-License-Identifier: MIT
/// Can a damaged file do harm? Small files of every format, cut at every byte or with a byte changed, must
/// load or throw.
#include <random>

#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

struct Sample {
    const char* name;
    std::string bytes;
};

std::vector<Sample> samples() {
    const Folder folder;
    Scene scene;
    scene.meshes.push_back({"m",
                            {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
                            {},
                            {}});
    scene.materials.emplace_back();
    scene.instances.emplace_back();
    save_ply(folder / "a.ply", scene);
    std::string stl(80, 'h');
    stl += bytes_of(std::uint32_t(2));
    for (int i = 0; i < 24; ++i)
        stl += bytes_of(static_cast<float>(i % 7)) + (i % 12 == 11 ? std::string(2, '\0') : "");
    std::string json =
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)"
        R"({"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
        R"("type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})";
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string glb = "glTF" + bytes_of(2) + bytes_of(static_cast<std::uint32_t>(28 + json.size() + 36)) +
                      bytes_of(static_cast<std::uint32_t>(json.size())) + "JSON" + json + bytes_of(36) +
                      std::string("BIN\0", 4);
    for (const float value : {0, 0, 0, 1, 0, 0, 0, 1, 0}) glb += bytes_of(value);
    return {
        {"a.ply", read_bytes(folder / "a.ply")},
        {"a.stl", stl},
        {"b.stl",
         "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
         "0\nendloop\nendfacet\nendsolid x\n"},
        {"b.ply",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 "
         "2\n"},
        {"a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n"},
        {"a.obj",
         "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nusemtl red\ng part\nf 1//1 2//1 3//1\nf -1 -2 "
         "-3\n"},
        {"a.mtl",
         "newmtl red\nKd 1 0 0\nKs 1 1 1\nNs 10\nd 0.5\nTf 1 1 1\nNi 1.5\nillum 7\nmap_Kd -s 1 1 1 t.png\n"},
        {"a.glb", glb}};
}

/// Loads the bytes under this name; whatever it is but an Error fails the test.
void load(const Folder& folder, const Sample& sample, const std::string& bytes) {
    std::filesystem::path file = folder.write(sample.name, bytes);
    if (file.extension() == ".mtl")
        file = folder.write("user.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    try {
        EXPECT_GT(load_scene(file).triangle_count(), 0u);
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::InvalidData) << error.what();
    }
}

TEST(DamagedFiles, WholeSamplesLoad) {
    const Folder folder;
    for (const Sample& sample : samples()) {
        if (std::string_view(sample.name).ends_with(".mtl")) continue;
        EXPECT_NO_THROW((void)load_scene(folder.write(sample.name, sample.bytes))) << sample.name;
    }
}

TEST(DamagedFiles, CutAnywhereTheyLoadOrThrow) {
    const Folder folder;
    for (const Sample& sample : samples())
        for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
            SCOPED_TRACE(std::string(sample.name) + " cut to " + std::to_string(size) + " bytes");
            load(folder, sample, sample.bytes.substr(0, size));
        }
}

TEST(DamagedFiles, WithBytesChangedTheyLoadOrThrow) {
    const Folder folder;
    std::mt19937 random(20120901);
    for (const Sample& sample : samples())
        for (int round = 0; round < 150; ++round) {
            std::string bytes = sample.bytes;
            for (unsigned changes = 1 + random() % 3; changes; --changes)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            SCOPED_TRACE(std::string(sample.name) + " in round " + std::to_string(round));
            load(folder, sample, bytes);
        }
}

}  // namespace

}  // namespace setka::io::test
