// SPDX-License-Identifier: MIT
/// What of a glTF file can move, and where is it in the scene?
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/gltf_deformer.hpp"
#include "io/gltf_document.hpp"
#include "io/gltf_use.hpp"
#include "setka/scene.hpp"

namespace setka::io::detail {

/// A scene at rest, without morph targets.
struct MovableGltf {
    Scene scene;
    std::shared_ptr<const GltfDocument> document;
    std::vector<GltfPart> instances;  ///< what each instance is in the file
    std::vector<GltfCamera> cameras;
};
/// `wanted` is Posed or Moving.
[[nodiscard]] MovableGltf read_movable_gltf(const std::filesystem::path& file, std::string bytes,
                                            GltfFilePart wanted);

}  // namespace setka::io::detail
