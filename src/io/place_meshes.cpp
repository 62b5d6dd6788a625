// SPDX-License-Identifier: MIT
/// What scene do the meshes of a file without nodes and materials make? See the header.
#include "io/place_meshes.hpp"

namespace setka::io::detail {

PlacedMeshes place_meshes(const std::filesystem::path& file, std::vector<RawMesh> meshes) {
    PlacedMeshes placed;
    Scene& scene = placed.scene;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        Material material;
        if (!meshes[i].colors.empty()) material.diffuse = {1, 1, 1};  // which the colours multiply
        TracedMesh traced = finish_traced_mesh(file, std::move(meshes[i]));
        if (traced.mesh.triangles.empty()) continue;
        const bool reuse = !scene.materials.empty() && scene.materials.back().diffuse == material.diffuse;
        if (!reuse) scene.materials.push_back(material);
        Instance instance;
        instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
        instance.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
        scene.instances.push_back(instance);
        placed.parts.push_back({instance.mesh, i, std::move(traced.sources), traced.normals_from});
        scene.meshes.push_back(std::move(traced.mesh));
    }
    return placed;
}

}  // namespace setka::io::detail
