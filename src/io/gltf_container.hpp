// SPDX-License-Identifier: MIT
/// How do JSON and bytes lie in a GLB file?
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace setka::io::detail {

/// The two chunks of a GLB container, or a text alone.
struct GltfContainer {
    std::string json;
    std::optional<std::string> binary;
    bool is_glb = false;
};

/// Takes a GLB file apart; anything else is taken for JSON. Throws InvalidData for chunks that do not fit.
[[nodiscard]] GltfContainer open_container(const std::filesystem::path& file, const std::string& bytes);
/// The file again with another JSON text.
[[nodiscard]] std::string close_container(std::string text, const GltfContainer& container);

}  // namespace setka::io::detail
