// SPDX-License-Identifier: MIT
/// How does a scene on the host move? Everything is checked before anything is changed.
#include <algorithm>

#include "scene/checks.hpp"
#include "setka/error.hpp"
#include "setka/scene.hpp"

namespace setka {

namespace {

SceneNumbers numbers_of(const Scene& scene) {
    return {.meshes = scene.meshes.size(),
            .instances = scene.instances.size(),
            .vertices = [&](std::uint32_t mesh) -> std::optional<VertexCounts> {
                if (mesh >= scene.meshes.size()) return {};
                return VertexCounts{scene.meshes[mesh].positions.size(), scene.meshes[mesh].normals.size()};
            },
            .has_instance = [&](std::uint32_t instance) { return instance < scene.instances.size(); }};
}

}  // namespace

void apply(Scene& scene, const SceneUpdate& update) {
    check(update, numbers_of(scene));
    if (update.camera) try {
            check(*update.camera);
        } catch (const Error& error) {
            fail(ErrorCategory::InvalidArgument, "update.", error.what());
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
