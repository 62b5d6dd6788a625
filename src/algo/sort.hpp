// SPDX-License-Identifier: MIT
/// How are pairs ordered by key? A stable radix sort on the device, over only the bits that keys use.
#pragma once

#include <cstdint>

#include "setka/device.hpp"

namespace setka {

/// Bytes of scratch that a sort of n pairs holds while it runs, the second pair of buffers included.
[[nodiscard]] std::uint64_t sort_scratch_bytes(Queue& queue, std::uint32_t n, std::uint32_t key_bits);

/// Enqueues the stable sort of (keys[i], values[i]), i < n, by the lowest key_bits (0 to 32) of the keys; higher bits must be 0.
/// The handles may be exchanged for other buffers of n elements.
void stable_sort_pairs(Queue& queue, Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, std::uint32_t n,
                       std::uint32_t key_bits);

}  // namespace setka
