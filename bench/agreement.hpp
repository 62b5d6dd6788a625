// SPDX-License-Identifier: MIT
/// Does another tracer see what setka sees? Not bit for bit: it rounds in its own way, and may miss at an
/// edge.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "setka/scene.hpp"

namespace setka::bench {

/// Hits of the same ray agree if their t differ by no more than this share of setka's.
inline constexpr double t_tolerance = 1e-4;
/// Of a batch so many rays may disagree, or one.
inline constexpr double tolerated_fraction = 1e-4;

/// Rays that only one of both hits anything with, or whose t differ. Which triangle was hit is not compared:
/// where two meet, either is right.
[[nodiscard]] std::uint64_t count_disagreements(std::span<const Hit> expected, std::span<const Hit> found);
/// Rays whose flag, 1 if occluded, does not say whether they hit something.
[[nodiscard]] std::uint64_t count_disagreements(std::span<const Hit> expected,
                                                std::span<const std::uint32_t> occluded);

/// Throws Mismatch if too many disagree. `what` names scene, tracer and rays.
void require_agreement(std::uint64_t disagreements, std::uint64_t ray_count, const std::string& what);

}  // namespace setka::bench
