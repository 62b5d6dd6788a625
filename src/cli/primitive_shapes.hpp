// SPDX-License-Identifier: MIT
/// What are the shapes of the primitives called on a command line?
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "setka/device.hpp"

namespace setka::cli {

/// Every shape with its word.
inline constexpr std::array<std::pair<const char*, PrimitiveShape>, 5> primitive_shapes{{
    {"auto", PrimitiveShape::Auto},
    {"library", PrimitiveShape::Library},
    {"portable", PrimitiveShape::Portable},
    {"serial", PrimitiveShape::Serial},
    {"group", PrimitiveShape::Group},
}};

[[nodiscard]] inline const char* to_string(PrimitiveShape shape) {
    return std::ranges::find(primitive_shapes, shape, [](const auto& entry) { return entry.second; })->first;
}

[[nodiscard]] inline std::optional<PrimitiveShape> find_primitive_shape(std::string_view word) {
    for (const auto& [name, shape] : primitive_shapes)
        if (name == word) return shape;
    return std::nullopt;
}

/// "auto|library|…".
[[nodiscard]] inline std::string primitive_shape_words() {
    std::string words;
    for (const auto& entry : primitive_shapes) words += (words.empty() ? "" : "|") + std::string(entry.first);
    return words;
}

}  // namespace setka::cli
