// SPDX-License-Identifier: MIT
/// Where do the test scenes come from? The library's own generators at small sizes, a ball of our own, and a
/// folder of files.
#include "support/scenes.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "setka/scenes.hpp"

namespace support {

setka::Scene from_triangles(const std::vector<Corners>& triangles) {
    setka::Mesh mesh;
    mesh.name = "triangles";
    for (const Corners& corners : triangles) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    setka::Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.emplace_back();
    scene.materials.emplace_back();
    return scene;
}

setka::Scene ball(std::uint32_t triangles, setka::Float3 centre, float radius) {
    const auto rings = static_cast<std::uint32_t>(std::sqrt(triangles / 4.0) + 2);
    const std::uint32_t sectors = 2 * rings;
    setka::Mesh mesh;
    mesh.name = "ball";
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < sectors; ++j) {
            const double theta = 3.14159265358979 * i / rings, phi = 2 * 3.14159265358979 * j / sectors;
            const double across = i == 0 || i == rings ? 0 : std::sin(theta);  // exactly closed at the poles
            mesh.positions.push_back({centre.x + radius * static_cast<float>(across * std::cos(phi)),
                                      centre.y + radius * static_cast<float>(std::cos(theta)),
                                      centre.z + radius * static_cast<float>(across * std::sin(phi))});
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < sectors; ++j) {
            const std::uint32_t a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
            mesh.triangles.push_back({a, b, b + sectors});
            mesh.triangles.push_back({a, b + sectors, a + sectors});
        }
    setka::Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.emplace_back();
    scene.materials.emplace_back();
    return scene;
}

std::vector<SceneCase> procedural_scenes() {
    const auto built_in = [](const char* name, std::uint64_t triangles, const char* edges = "") {
        return SceneCase{std::string("built_in_") + name, [=] { return setka::make_scene(name, triangles); },
                         edges};
    };
    return {built_in("cube", 0),
            built_in("sphere", 3000),
            built_in("torus", 3000),
            built_in("plane", 2000, "a regular sheet has a common period with the cells"),
            built_in("terrain", 4000),
            built_in("spheres", 5000),
            built_in("soup", 4000)};
}

std::vector<SceneCase> all_scenes() {
    auto scenes = procedural_scenes();
    for (auto& scene : degenerate_scenes()) scenes.push_back(std::move(scene));
    return scenes;
}

const SceneCase& find_scene(const std::string& name) {
    static const std::vector<SceneCase> scenes = all_scenes();
    for (const SceneCase& scene : scenes)
        if (scene.name == name) return scene;
    throw std::invalid_argument("no test scene is called " + name);
}

std::vector<std::string> names(const std::vector<SceneCase>& scenes) {
    std::vector<std::string> result;
    for (const SceneCase& scene : scenes) result.push_back(scene.name);
    return result;
}

std::optional<std::filesystem::path> scene_folder() {
    const char* set = std::getenv("SETKA_SCENES");
    const std::filesystem::path folder =
        set && *set ? std::filesystem::path(set)
                    : std::filesystem::path(SETKA_PROJECT_DIR).parent_path() / "shared" / "scenes";
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) return std::nullopt;
    return folder;
}

}  // namespace support
