// SPDX-License-Identifier: MIT
/// Which part of a glTF file does setka read? A copy of the JSON with known keys of the right types only.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace setka::io::detail {

/// How much of a file is wanted.
enum class GltfFilePart {
    Still,   ///< what stands without morph targets and animations
    Posed,   ///< morph targets too
    Moving,  ///< all
};

/// Parses glTF 2 JSON and copies what setka reads of this part. Throws InvalidData for text that is no JSON, another
/// version, a value of the wrong type, or a required extension that is not read.
[[nodiscard]] nlohmann::json copy_gltf(const std::filesystem::path& file, const std::string& text,
                                       GltfFilePart part);

/// A relative URI as a path: %20 and the like decoded.
[[nodiscard]] std::string decode_uri(const std::string& uri);

}  // namespace setka::io::detail
