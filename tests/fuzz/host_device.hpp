// SPDX-License-Identifier: MIT
/// How do sanitizers see into kernels? A device whose kernels are the entries of kernels_cl, compiled for the
/// host, and whose buffers are allocations of exactly their size: one word beyond is reported. It takes the
/// place of a driver under the whole library, and costs no launch.
#pragma once

#include "setka/device.hpp"

namespace fuzz {

/// Bytes that a device of these tests may hold: enough for some ten thousand cells, so that no input takes
/// long.
inline constexpr std::uint64_t memory_budget_bytes = 1u << 19;

/// The host as a device.
[[nodiscard]] setka::Device host_device();

/// The queue that inputs run on: of the host device, or of the device that the environment's
/// SETKA_FUZZ_DEVICE names.
[[nodiscard]] setka::Queue& queue();

}  // namespace fuzz
