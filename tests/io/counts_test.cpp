// SPDX-License-Identifier: MIT
/// Are all triangles of real models read? Counts of independent readers, from the manifest of the reference
/// scenes.
#include <sstream>

#include "tests/io/support.hpp"

namespace setka::io::test {

namespace {

bool is_read(const std::filesystem::path& file) {
    static const std::vector<std::string> extensions = {".obj", ".ply",  ".stl", ".STL",
                                                        ".off", ".gltf", ".glb"};
    return std::ranges::find(extensions, file.extension().string()) != extensions.end();
}

TEST(ReferenceScenes, HaveTheTrianglesOfTheManifest) {
    std::ifstream manifest(scenes_folder() / "MANIFEST.tsv");
    if (!manifest)
        GTEST_SKIP() << "no MANIFEST.tsv in " << scenes_folder()
                     << "; set SETKA_SCENES to where the reference scenes are";
    std::string line;
    std::getline(manifest, line);  // names of the columns
    std::size_t checked = 0;
    while (std::getline(manifest, line)) {
        std::istringstream columns(line);
        std::string name, skipped, triangles;
        std::getline(columns, name, '\t');
        for (int i = 0; i < 3; ++i) std::getline(columns, skipped, '\t');
        std::getline(columns, triangles, '\t');
        if (name.starts_with("nasty/") || !is_read(name)) continue;  // those have a table of their own
        SCOPED_TRACE(name);
        ++checked;
        EXPECT_NO_THROW(
            EXPECT_EQ(std::to_string(load_scene(scenes_folder() / name).triangle_count()), triangles));
    }
    EXPECT_GT(checked, 0u);
}

}  // namespace

}  // namespace setka::io::test
