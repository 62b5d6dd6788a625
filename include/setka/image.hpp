// SPDX-License-Identifier: MIT
/// What does a picture consist of? Pixels in rows from the top, as linear floats and as 8-bit sRGB.
#pragma once

#include <cstdint>
#include <vector>

#include "setka/scene.hpp"

namespace setka {

struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<Float3> linear;         ///< width * height linear RGB
    std::vector<std::uint8_t> srgb;     ///< width * height * 3, sRGB-encoded, made on the device
};

}  // namespace setka
