// SPDX-License-Identifier: MIT
/// What numbers does a checked glTF file hold? Its JSON, its buffers, and accessors as doubles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf_schema.hpp"

namespace setka::io::detail {

/// The values of an accessor, one element behind the other.
struct GltfNumbers {
    std::size_t count = 0;  ///< elements
    std::size_t width = 0;  ///< numbers of each
    std::vector<double> values;
};

/// JSON whose references and ranges were checked, with the binary chunk of a GLB.
class GltfDocument {
  public:
    GltfDocument(std::filesystem::path file, nlohmann::json json, std::optional<std::string> binary)
        : file_(std::move(file)), json_(std::move(json)), binary_(std::move(binary)) {}

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const nlohmann::json& json() const { return json_; }
    /// An array of the root; empty if there is none.
    [[nodiscard]] const nlohmann::json& list(const char* key) const;
    /// One of its elements. Throws InvalidData if there is no such.
    [[nodiscard]] const nlohmann::json& element(const char* list, std::uint64_t index) const;
    /// Normalised integers become shares; sparse values are put in. Throws InvalidData for another type than
    /// `type`, for integers where floats are needed, and for a file that cannot be read.
    [[nodiscard]] GltfNumbers numbers(std::uint64_t accessor, const char* type) const;

  private:
    [[nodiscard]] const std::string& buffer(std::size_t index) const;
    [[nodiscard]] std::vector<double> read(const nlohmann::json& user, std::size_t count, std::size_t width,
                                           std::uint64_t component, bool is_normalized) const;

    std::filesystem::path file_;
    nlohmann::json json_;
    std::optional<std::string> binary_;
    mutable std::vector<std::optional<std::string>> buffers_;  ///< those that were needed so far
};

}  // namespace setka::io::detail
