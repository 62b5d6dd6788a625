// SPDX-License-Identifier: MIT
/// What scene do the meshes of a file without nodes and materials make?
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "io/raw_mesh.hpp"
#include "setka/scene.hpp"

namespace setka::io::detail {

/// A scene whose vertices are known by what they were in the file.
struct PlacedMeshes {
    struct Part {
        std::uint32_t mesh = 0;  ///< in the scene
        std::size_t raw = 0;     ///< in the file
        std::vector<std::uint32_t> sources;
        NormalsFrom normals_from = NormalsFrom::File;
    };
    Scene scene;
    std::vector<Part> parts;  ///< those with triangles
};

/// An instance a mesh. Throws what finish_mesh throws.
[[nodiscard]] PlacedMeshes place_meshes(const std::filesystem::path& file, std::vector<RawMesh> meshes);

}  // namespace setka::io::detail
