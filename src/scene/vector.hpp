// SPDX-License-Identifier: MIT
/// How does host code calculate with the public plain structs? Conversions to GLM and back.
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "setka/scene.hpp"

namespace setka {

/// Doubles, because cameras and built-in scenes are calculated once and rounded at the end.
[[nodiscard]] inline glm::dvec3 to_glm(const Float3& v) { return {v.x, v.y, v.z}; }
[[nodiscard]] inline Float3 to_float3(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace setka
