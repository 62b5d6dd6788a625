// SPDX-License-Identifier: MIT
/// Which camera and lights does an imported scene have?
#pragma once

#include <optional>

#include "setka/scene.hpp"

struct aiScene;

namespace setka::io::detail {

/// The first perspective camera, placed by its node; nothing if none can be used.
[[nodiscard]] std::optional<Camera> take_camera(const aiScene& source);
/// Adds point lights (spots among them) and directional lights, placed by their nodes. Physical units have no
/// meaning in Whitted shading, so lights that are too bright for it at the middle of the scene are dimmed
/// together.
void take_lights(const aiScene& source, Scene& scene);

}  // namespace setka::io::detail
