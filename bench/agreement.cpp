// SPDX-License-Identifier: MIT
/// Does another tracer see what setka sees? See the header.
#include "bench/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "bench/validation.hpp"

namespace setka::bench {

namespace {

[[nodiscard]] bool is_hit(const Hit& hit) { return hit.primitive != SETKA_NO_HIT; }

[[nodiscard]] bool agree(const Hit& expected, const Hit& found) {
    if (is_hit(expected) != is_hit(found)) return false;
    // As it is written, so that a NaN disagrees.
    return !is_hit(expected) || std::abs(double(found.t) - expected.t) <= t_tolerance * expected.t;
}

template <typename T, typename Agree>
[[nodiscard]] std::uint64_t count(std::span<const Hit> expected, std::span<const T> found,
                                  const Agree& is_same) {
    std::uint64_t differing =
        expected.size() > found.size() ? expected.size() - found.size() : found.size() - expected.size();
    for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i)
        if (!is_same(expected[i], found[i])) ++differing;
    return differing;
}

}  // namespace

std::uint64_t count_disagreements(std::span<const Hit> expected, std::span<const Hit> found) {
    return count(expected, found, agree);
}

std::uint64_t count_disagreements(std::span<const Hit> expected, std::span<const std::uint32_t> occluded) {
    return count(expected, occluded,
                 [](const Hit& hit, std::uint32_t flag) { return flag == (is_hit(hit) ? 1u : 0u); });
}

void require_agreement(std::uint64_t disagreements, std::uint64_t ray_count, const std::string& what) {
    const auto tolerated = std::max(1.0, tolerated_fraction * double(ray_count));
    if (double(disagreements) <= tolerated) return;
    std::ostringstream message;
    message << what << ": " << disagreements << " of " << ray_count << " rays disagree with setka's; up to "
            << tolerated << " are put down to rounding; it is not timed";
    throw Mismatch(message.str());
}

}  // namespace setka::bench
