// SPDX-License-Identifier: MIT
/// Does setka::io link from an installed package? Writes a scene to the folder given and reads it again.
#include <cstdio>
#include <filesystem>

#include "setka/io.hpp"
#include "setka/scenes.hpp"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::filesystem::path file = std::filesystem::path(argv[1]) / "torus.ply";
    const setka::Scene scene = setka::make_scene("torus");
    setka::io::save_ply(file, scene);
    const auto count = setka::io::load_scene(file).triangle_count();
    std::printf("%llu triangles\n", static_cast<unsigned long long>(count));
    return count == scene.triangle_count() ? 0 : 1;
}
