// SPDX-License-Identifier: MIT
/// Where do two devices first differ? Everything that a device computes of a scene, on the host, and the
/// first of it, in the order in which it was computed, that is not the same bytes on both sides.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "workload/fingerprint.hpp"

namespace setka::workload {

/// A grid's tables.
struct Tables {
    SetkaGridHeader header{};
    std::vector<std::int32_t> offsets;
    std::vector<std::uint32_t> counts;
    std::vector<std::uint32_t> references;
};

[[nodiscard]] Tables download_tables(Queue& queue, const Grid& grid);

/// All that one device computed.
struct Answers {
    Tables tables;
    std::vector<Ray> primary_rays, shadow_rays, diffuse_rays;
    std::vector<std::pair<GridStep, Results>> steps;  ///< at least one
};

/// One difference, in words.
struct Difference {
    std::string part;   ///< "grid header", "cell offset", "cell count", "cell list", "primary ray", "primary
                        ///< hit", "pixel" …
    std::string place;  ///< which one of them, and by which step
    std::string reference;        ///< what the reference has there
    std::string other;            ///< what the other has there
    std::uint64_t differing = 0;  ///< how many of this part differ, of how many; 0 of 0 where nobody counted
    std::uint64_t total = 0;

    /// Three lines.
    [[nodiscard]] std::string to_string() const;
};

/// Nothing if every byte is the same. Each step of `other` is held against the reference's first: two steps
/// of one device are compared by first_difference(answers, answers).
[[nodiscard]] std::optional<Difference> first_difference(const Answers& reference, const Answers& other);

}  // namespace setka::workload
