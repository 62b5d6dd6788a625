// SPDX-License-Identifier: MIT
/// Which transforms, camera and lights does an imported scene have?
#pragma once

#include <assimp/matrix4x4.h>

#include <filesystem>
#include <optional>
#include <span>

#include "io/gltf_use.hpp"
#include "setka/scene.hpp"

struct aiNode;
struct aiScene;

namespace setka::io::detail {

/// The world transform of a node. Throws InvalidData if it is not affine or not finite.
[[nodiscard]] Matrix34 take_transform(const std::filesystem::path& file, const aiMatrix4x4& matrix,
                                      const aiNode& node);

/// A camera at the origin of its node that looks along -z, as glTF has it; nothing if that is no camera.
[[nodiscard]] std::optional<Camera> place_camera(const aiMatrix4x4& world, double vertical_fov);

/// The first perspective camera of a glTF scene, placed by its node; nothing if none can be used.
/// The cameras of assimp 5.2 are left alone: it keeps an angle only as angle times aspect, sorts them as it
/// comes upon them, and repeats a node's translation in the camera's position.
[[nodiscard]] std::optional<Camera> take_camera(const aiScene& source, std::span<const GltfCamera> cameras);
/// Adds point lights (spots among them) and directional lights, placed by their nodes. Physical units have no
/// meaning in Whitted shading, so lights that are too bright for it at the middle of the scene are dimmed
/// together.
void take_lights(const aiScene& source, Scene& scene);

}  // namespace setka::io::detail
