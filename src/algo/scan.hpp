// SPDX-License-Identifier: MIT
/// What is the sum of everything before each element? Exclusive scan on the device.
#pragma once

#include <cstdint>

#include "setka/device.hpp"

namespace setka {

/// Bytes of scratch that a scan of n counts holds while it runs.
[[nodiscard]] std::uint64_t scan_scratch_bytes(Queue& queue, std::uint32_t n);

/// Enqueues offsets[i] = counts[0] + … + counts[i - 1] for i <= n, modulo 2^32; `offsets` has n + 1 elements. Returns a buffer
/// whose last element is the total.
Buffer<std::uint64_t> enqueue_exclusive_scan(Queue& queue, const Buffer<std::uint32_t>& counts, std::uint32_t n,
                                             const Buffer<std::uint32_t>& offsets);

/// The total in what enqueue_exclusive_scan() returned; waits for it.
[[nodiscard]] std::uint64_t total_of(Queue& queue, const Buffer<std::uint64_t>& sums);

/// The same as both, and waits for the total. Throws OutOfMemory if the total exceeds 2^31 - 1; `what` names what is counted.
std::uint64_t exclusive_scan(Queue& queue, const Buffer<std::uint32_t>& counts, std::uint32_t n,
                             const Buffer<std::uint32_t>& offsets, const char* what = "elements");

}  // namespace setka
