// SPDX-License-Identifier: MIT
/// What does setka show on its front page? A scene with its camera and lights that uses every kind of
/// surface.
#pragma once

#include <cstdint>

#include "setka/scene.hpp"

namespace setka {

/// Stated here, so that listing the scenes does not build this one; a test compares.
inline constexpr std::uint64_t showcase_triangles = 839'360;

[[nodiscard]] Scene make_showcase();

}  // namespace setka
