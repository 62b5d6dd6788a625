// SPDX-License-Identifier: MIT
/// What numbers does a checked glTF file hold? Its JSON, its buffers, and accessors as doubles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf_schema.hpp"

namespace setka::io::detail {

/// The values of an accessor, one element behind the other. Where they first go wrong is found once, however
/// many channels share them.
struct GltfNumbers {
    std::size_t count = 0;  ///< elements
    std::size_t width = 0;  ///< numbers of each
    std::vector<double> values;
    std::size_t first_not_finite = 0;  ///< of `values`; their number if all are finite
    std::size_t first_no_time = 0;     ///< the first that is not finite, is below 0 or falls; likewise
};

/// JSON whose references and ranges were checked, with the binary chunk of a GLB. All that is decoded and
/// made of it has one budget, since accessors can be sparse and shared: a file of a few kilobytes could ask
/// for any amount of memory.
class GltfDocument {
  public:
    /// The budget of a file whose buffers are small.
    static constexpr std::uint64_t min_budget_bytes = std::uint64_t(1) << 29;
    /// The budget of others, in bytes for each byte of their buffers.
    static constexpr std::uint64_t budget_per_byte = 16;

    GltfDocument(std::filesystem::path file, nlohmann::json json, std::optional<std::string> binary,
                 std::uint64_t min_budget = min_budget_bytes);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const nlohmann::json& json() const { return json_; }
    /// An array of the root; empty if there is none.
    [[nodiscard]] const nlohmann::json& list(const char* key) const;
    /// One of its elements. Throws InvalidData if there is no such.
    [[nodiscard]] const nlohmann::json& element(const char* list, std::uint64_t index) const;
    /// Normalised integers become shares; sparse values are put in. Decoded and charged once, until forget().
    /// Throws InvalidData for another type than `type`, for a file that cannot be read, and beyond the
    /// budget.
    [[nodiscard]] std::shared_ptr<const GltfNumbers> numbers(std::uint64_t accessor, const char* type) const;
    /// Takes what `what` is about to keep from the budget. Throws InvalidData beyond it.
    void charge(std::uint64_t size_bytes, const std::string& what) const;
    /// Lets go of decoded accessors; who holds one keeps it.
    void forget() const { decoded_.clear(); }

  private:
    [[nodiscard]] GltfNumbers decode(const nlohmann::json& accessor, std::size_t width,
                                     const std::string& what) const;
    [[nodiscard]] const std::string& buffer(std::size_t index) const;
    [[nodiscard]] std::vector<double> read(const nlohmann::json& user, std::size_t count, std::size_t width,
                                           std::uint64_t component, bool is_normalized) const;

    std::filesystem::path file_;
    nlohmann::json json_;
    std::optional<std::string> binary_;
    std::uint64_t budget_bytes_;
    mutable std::uint64_t charged_bytes_ = 0;
    mutable std::vector<std::optional<std::string>> buffers_;  ///< those that were needed so far
    mutable std::map<std::uint64_t, std::shared_ptr<const GltfNumbers>> decoded_;  ///< by accessor
};

}  // namespace setka::io::detail
