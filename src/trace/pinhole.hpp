// SPDX-License-Identifier: MIT
/// Where does a pinhole camera look from and to? Its basis for the kernels, and the checks of a picture's
/// shape.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/shade/layout.h"
#include "setka/renderer.hpp"

namespace setka {

/// Throws InvalidArgument, naming the argument, unless low <= value <= high.
void check_range(std::string_view name, std::uint32_t value, std::uint32_t low, std::uint32_t high);
/// Throws InvalidArgument unless 1 <= width, height <= 16384 and 1 <= samples_per_axis <= 16.
void check_picture(std::uint32_t width, std::uint32_t height, std::uint32_t samples_per_axis);
/// The same for everything that a render is given.
void check_options(const RenderOptions& options);

/// Throws InvalidData for a camera that is not finite, looks nowhere or has no upright, or a field of view
/// out of range.
[[nodiscard]] SkCamera make_pinhole(const Camera& camera, std::uint32_t width, std::uint32_t height,
                                    std::uint32_t samples_per_axis);

}  // namespace setka
