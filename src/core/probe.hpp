// SPDX-License-Identifier: MIT
/// Does this device compute what every other one does? A few hundred operands through the kernels' own
/// arithmetic, every shared record, and a barrier, before anything else runs on it.
#pragma once

#include <cstdint>
#include <vector>

#include "setka/device.hpp"

namespace setka {

/// What the three probe kernels write, or have to write.
struct ProbeWords {
    std::vector<std::uint32_t> rounding;  ///< expression by expression, tuple by tuple
    std::vector<std::uint32_t> layout;    ///< a slot for each record
    std::vector<std::uint32_t> barrier;   ///< a word for each work-item
};

/// Runs the kernels and compares. Throws what the queue throws.
[[nodiscard]] ParityReport run_probe(Queue& queue);

/// What `found` says of a device with groups of `group_size` work-items: one sentence for each expression,
/// record member and barrier that differs from what is expected.
[[nodiscard]] ParityReport compare_probe(const ProbeWords& found, std::uint32_t group_size);

}  // namespace setka
