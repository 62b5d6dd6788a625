// SPDX-License-Identifier: MIT
/// Can so many hits be held? Asked when they are counted, before they are written.
#pragma once

#include <cstddef>
#include <cstdint>

#include "setka/device.hpp"

namespace setka {

/// Throws OutOfMemory, with numbers of hits and bytes, if the hits of so many rays cannot be numbered in 32 bits, or are more
/// than what is left of the device's budget or one of its allocations holds.
void check_hit_memory(const Device& device, std::size_t ray_count, std::uint64_t hit_count);

}  // namespace setka
