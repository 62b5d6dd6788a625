// SPDX-License-Identifier: MIT
/// What does shading look up? Materials, lights, sRGB thresholds and colour ramps as the kernels read them.
#pragma once

#include <array>
#include <vector>

#include "device/shade/layout.h"
#include "setka/device_scene.hpp"
#include "setka/scene.hpp"

namespace setka {

[[nodiscard]] std::vector<SkMaterial> make_material_table(const std::vector<Material>& materials);
/// Point lights in order, then directional lights in order.
[[nodiscard]] std::vector<SkLight> make_light_table(const DeviceScene& scene);
[[nodiscard]] SkBackground make_background(const Background& background);

/// True if light can pass some surface of the scene.
[[nodiscard]] bool any_transparent(const std::vector<Material>& materials);
/// True unless every ray ends at the first surface that it meets.
[[nodiscard]] bool any_onward(const std::vector<Material>& materials);

/// thresholds[c - 1] is the least linear value with 8-bit sRGB code c: where rounding to the nearest code
/// goes up. Computed once, since it takes as long as a small picture.
[[nodiscard]] const std::array<float, 255>& srgb_thresholds();

/// Linear RGB triples from cold to hot: dark blue, violet, red, orange, yellow, white. Each knot is lighter
/// than the last, so that the ramp reads the same without colours.
[[nodiscard]] std::vector<float> make_heat_ramp();
/// Linear RGB triples from near to far.
[[nodiscard]] std::vector<float> make_depth_ramp();

}  // namespace setka
