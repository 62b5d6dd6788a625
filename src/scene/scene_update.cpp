// SPDX-License-Identifier: MIT
/// How does a scene on the host move? Everything is checked before anything is changed.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "scene/checks.hpp"
#include "setka/error.hpp"
#include "setka/scene.hpp"

namespace setka {

namespace {

template <typename... Ts>
[[noreturn]] void fail(const Ts&... parts) {
    std::ostringstream message;
    (message << ... << parts);
    throw Error(ErrorCategory::InvalidArgument, message.str());
}

void check_finite(const std::vector<Float3>& list, std::size_t index, const char* what) {
    const auto is_finite = [](const Float3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    const auto found = std::ranges::find_if_not(list, is_finite);
    if (found != list.end())
        fail("update.vertices[", index, "]: ", what, ' ', found - list.begin(), " is (", found->x, ", ",
             found->y, ", ", found->z, "); finite numbers are accepted");
}

void check(const SceneUpdate::Placement& placement, std::size_t index, const Scene& scene) {
    if (placement.instance >= scene.instances.size())
        fail("update.placements[", index, "]: instance = ", placement.instance, " does not exist; there are ",
             scene.instances.size());
    const auto& rows = placement.transform.rows;
    const auto found = std::ranges::find_if_not(rows, [](float value) { return std::isfinite(value); });
    if (found != rows.end())
        fail("update.placements[", index, "]: transform.rows[", found - rows.begin(), "] = ", *found,
             "; finite numbers are accepted");
}

void check(const SceneUpdate::Vertices& vertices, std::size_t index, const Scene& scene) {
    if (vertices.mesh >= scene.meshes.size())
        fail("update.vertices[", index, "]: mesh = ", vertices.mesh, " does not exist; there are ",
             scene.meshes.size());
    const Mesh& mesh = scene.meshes[vertices.mesh];
    const auto check_count = [&](std::size_t count, std::size_t accepted, const char* what) {
        if (count != accepted)
            fail("update.vertices[", index, "]: ", count, ' ', what, " for mesh ", vertices.mesh,
                 ", which has ", accepted);
    };
    check_count(vertices.positions.size(), mesh.positions.size(), "positions");
    if (!vertices.normals.empty()) check_count(vertices.normals.size(), mesh.normals.size(), "normals");
    check_finite(vertices.positions, index, "position");
    check_finite(vertices.normals, index, "normal");
}

}  // namespace

void apply(Scene& scene, const SceneUpdate& update) {
    for (std::size_t i = 0; i < update.placements.size(); ++i) check(update.placements[i], i, scene);
    for (std::size_t i = 0; i < update.vertices.size(); ++i) check(update.vertices[i], i, scene);
    if (update.camera) try {
            check(*update.camera);
        } catch (const Error& error) {
            fail("update.", error.what());
        }
    // The numbers fit, so nothing is allocated, and nothing fails half way.
    for (const SceneUpdate::Vertices& vertices : update.vertices) {
        Mesh& mesh = scene.meshes[vertices.mesh];
        std::ranges::copy(vertices.positions, mesh.positions.begin());
        std::ranges::copy(vertices.normals, mesh.normals.begin());
    }
    for (const SceneUpdate::Placement& placement : update.placements)
        scene.instances[placement.instance].transform = placement.transform;
    if (update.camera) scene.camera = update.camera;
}

}  // namespace setka
