// SPDX-License-Identifier: MIT
/// Which rays find mistakes? Random ones, and those that meet a special case of every step of the
/// specification.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "oracle/oracle.hpp"

namespace support {

/// The kinds of rays that adversarial_rays() takes in turn: ray i is of kind i modulo their number.
[[nodiscard]] const std::vector<std::string>& ray_kinds();

[[nodiscard]] std::vector<oracle::Ray> adversarial_rays(const oracle::World& world, std::size_t count,
                                                        std::uint64_t seed);

/// Bundles of rays, as neighbours in a picture are: each is an adversarial ray and others close to it, from one point, parallel, to one
/// point or neither, with one in sixteen of another kind in between.
[[nodiscard]] std::vector<oracle::Ray> bundled_rays(const oracle::World& world, std::size_t count, std::uint64_t seed);

}  // namespace support
