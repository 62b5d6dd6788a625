// SPDX-License-Identifier: MIT
/// What does a file's material look like in Whitted shading?
#pragma once

#include <filesystem>
#include <optional>

#include "setka/scene.hpp"

struct aiMaterial;
struct aiScene;

namespace setka::io::detail {

struct ImportedMaterial {
    Material material;
    bool has_colour = false;  ///< the file says which, if only by default
};

/// An OBJ material (MTL): colours as they are, Ns, d, Tf, Ni and illum.
[[nodiscard]] ImportedMaterial convert_mtl(const aiMaterial& source, const std::filesystem::path& folder);
/// A glTF material: metallic-roughness or specular-glossiness, transmission, alpha blending.
[[nodiscard]] ImportedMaterial convert_gltf(const aiMaterial& source, const aiScene& scene,
                                            const std::filesystem::path& folder);

}  // namespace setka::io::detail
