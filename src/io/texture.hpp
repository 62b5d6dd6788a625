// SPDX-License-Identifier: MIT
/// Which colour has a texture on the whole?
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "setka/scene.hpp"

namespace setka::io::detail {

/// The mean linear colour of an image file, weighted by its opacity; nothing if it cannot be read.
[[nodiscard]] std::optional<Float3> mean_colour(const std::filesystem::path& image);
/// The same for an encoded image in memory.
[[nodiscard]] std::optional<Float3> mean_colour(std::span<const unsigned char> encoded);

}  // namespace setka::io::detail
