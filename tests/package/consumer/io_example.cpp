// SPDX-License-Identifier: MIT
/// Does setka::io link from an installed package? Writes a scene to the folder given, and reads it again, as the frames of a
/// sequence too.
#include <cstdio>
#include <filesystem>
#include <vector>

#include "setka/animation.hpp"
#include "setka/io.hpp"
#include "setka/scenes.hpp"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::filesystem::path file = std::filesystem::path(argv[1]) / "torus.ply";
    const setka::Scene scene = setka::make_scene("torus");
    setka::io::save_ply(file, scene);
    const auto count = setka::io::load_scene(file).triangle_count();
    std::printf("%llu triangles\n", static_cast<unsigned long long>(count));
    setka::Scene moved = scene;
    for (setka::Float3& position : moved.meshes[0].positions) position.y += 1;
    setka::io::save_ply(file.parent_path() / "frame1.ply", scene);
    setka::io::save_ply(file.parent_path() / "frame2.ply", moved);
    const setka::io::Animation animation(file.parent_path() / "frame%d.ply");
    moved = animation.scene();
    setka::apply(moved, animation.frame(2));
    const float rise = moved.bounds().upper[1] - animation.scene().bounds().upper[1];
    std::printf("%u frames, up by %g\n", animation.frame_count(), double(rise));
    if (animation.frame_count() != 2 || rise < 0.9f || rise > 1.1f) return 1;
    return count == scene.triangle_count() ? 0 : 1;
}
