// SPDX-License-Identifier: MIT
/// How is a scene made by hand, in a few lines? Materials, boxes and spheres, and one scene with everything
/// in it.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "setka/scene.hpp"

namespace support {

using setka::Camera;
using setka::Float3;
using setka::Instance;
using setka::Material;
using setka::Matrix34;
using setka::Mesh;
using setka::Scene;

inline constexpr Float3 black{0, 0, 0};

/// Nothing but what is put in: no ambient light, a black background.
[[nodiscard]] inline Scene dark_scene() {
    Scene scene;
    scene.background = {black, black, black, 0};
    return scene;
}

[[nodiscard]] inline Material matte(const Float3& diffuse) {
    Material material;
    material.diffuse = diffuse;
    material.specular = black;
    return material;
}
[[nodiscard]] inline Material glowing(const Float3& emission) {
    Material material = matte(black);
    material.emission = emission;
    return material;
}
[[nodiscard]] inline Material mirror() {
    Material material = matte(black);
    material.specular = {1, 1, 1};
    material.reflectivity = 1;
    return material;
}
[[nodiscard]] inline Material glass(float refractive_index) {
    Material material = matte({0.7f, 0.7f, 0.7f});
    material.transparency = 1;
    material.refractive_index = refractive_index;
    return material;
}

/// Adds a mesh with a material of its own.
inline Instance& add(Scene& scene, Mesh mesh, const Material& material, const Matrix34& transform = {}) {
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
    Instance instance;
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
    instance.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
    instance.transform = transform;
    scene.instances.push_back(instance);
    return scene.instances.back();
}

/// A parallelogram around `centre`, with the front where u x v points.
[[nodiscard]] inline Mesh quad(const Float3& centre, const Float3& u, const Float3& v) {
    const auto corner = [&](float a, float b) {
        return Float3{centre.x + a * u.x + b * v.x, centre.y + a * u.y + b * v.y,
                      centre.z + a * u.z + b * v.z};
    };
    Mesh mesh;
    mesh.positions = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A closed box with its faces outwards.
[[nodiscard]] inline Mesh box(const Float3& lower, const Float3& upper) {
    Mesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.positions.push_back(
            {k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z});
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

/// A sphere of `rings` rings of twice as many segments, with normals.
[[nodiscard]] inline Mesh sphere(const Float3& centre, float radius, int rings = 24) {
    Mesh mesh;
    const int segments = 2 * rings;
    for (int ring = 0; ring <= rings; ++ring) {
        for (int segment = 0; segment < segments; ++segment) {
            const double polar = 3.14159265358979 * ring / rings,
                         turn = 2 * 3.14159265358979 * segment / segments;
            const Float3 n{static_cast<float>(std::sin(polar) * std::cos(turn)),
                           static_cast<float>(std::cos(polar)),
                           static_cast<float>(-std::sin(polar) * std::sin(turn))};
            mesh.normals.push_back(n);
            mesh.positions.push_back(
                {centre.x + radius * n.x, centre.y + radius * n.y, centre.z + radius * n.z});
        }
    }
    for (int ring = 0; ring < rings; ++ring) {
        for (int segment = 0; segment < segments; ++segment) {
            const auto at = [&](int r, int s) {
                return static_cast<std::uint32_t>(r * segments + s % segments);
            };
            const std::uint32_t a = at(ring, segment), b = at(ring, segment + 1);
            const std::uint32_t c = at(ring + 1, segment), d = at(ring + 1, segment + 1);
            if (ring > 0) mesh.triangles.push_back({a, c, b});
            if (ring + 1 < rings) mesh.triangles.push_back({b, c, d});
        }
    }
    return mesh;
}

[[nodiscard]] inline Camera look(const Float3& eye, const Float3& target, float fov = 90,
                                 const Float3& up = {0, 1, 0}) {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.up = up;
    camera.vertical_fov_degrees = fov;
    return camera;
}

/// Everything that shading knows: smooth and flat, matte, mirror, tinted glass, point and directional lights. The large
/// spheres have `rings` rings.
[[nodiscard]] inline Scene mirror_and_glass(int rings = 16) {
    Scene scene;
    add(scene, quad({0, 0, 0}, {0, 0, 8}, {8, 0, 0}), matte({0.7f, 0.65f, 0.6f}));
    scene.materials.back().reflectivity = 0.3f;
    scene.materials.back().specular = {0.2f, 0.2f, 0.2f};
    add(scene, sphere({-1.2f, 1, 0}, 1, rings), mirror());
    scene.materials.back().specular = {0.9f, 0.8f, 0.6f};
    add(scene, sphere({1.2f, 1, 0.6f}, 1, rings), glass(1.5f));
    scene.materials.back().transmission = {0.8f, 0.95f, 0.9f};
    scene.materials.back().specular = {0.5f, 0.5f, 0.5f};
    add(scene, box({-0.5f, 0, 1.5f}, {0.3f, 0.8f, 2.2f}), matte({0.2f, 0.3f, 0.8f}));
    add(scene, sphere({0, 0.5f, -2}, 0.5f, rings / 2), matte({0.8f, 0.2f, 0.2f}));
    scene.materials.back().specular = {0.5f, 0.5f, 0.5f};
    scene.point_lights.push_back({{3, 5, 4}, {0.8f, 0.7f, 0.6f}, 0});
    scene.point_lights.push_back({{-3, 2, 2}, {0.3f, 0.4f, 0.6f}, 3});
    scene.directional_lights.push_back({{-1, -3, -1}, {0.3f, 0.3f, 0.3f}});
    scene.camera = look({0.5f, 2, 5.5f}, {0, 0.8f, 0}, 45);
    return scene;
}

/// A flat sheet of 2 n^2 triangles.
[[nodiscard]] inline Scene sheet(std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) mesh.positions.push_back({static_cast<float>(i), static_cast<float>(j), 0});
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t at = j * (n + 1) + i, above = at + n + 1;
            mesh.triangles.push_back({at, at + 1, above + 1});
            mesh.triangles.push_back({at, above + 1, above});
        }
    Scene scene;
    add(scene, std::move(mesh), matte({0.5f, 0.5f, 0.5f}));
    return scene;
}

}  // namespace support
