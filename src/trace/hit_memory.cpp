// SPDX-License-Identifier: MIT
#include "trace/hit_memory.hpp"

#include <limits>
#include <string>

#include "setka/error.hpp"
#include "setka/layout.h"

namespace setka {

void check_hit_memory(const Device& device, std::size_t ray_count, std::uint64_t hit_count) {
    const std::string hits = "the rays, " + std::to_string(ray_count) + " in this call, have " +
                             std::to_string(hit_count) + " hits";
    const std::string advice = ": trace fewer rays in a call, or set max_hits";
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    if (hit_count > most)
        throw Error(ErrorCategory::OutOfMemory, hits + "; a call returns up to " + std::to_string(most) + advice);
    const std::uint64_t bytes = hit_count * sizeof(::SetkaHit);
    const std::uint64_t budget = device.options().memory_budget_bytes, used = device.memory_in_use_bytes();
    const std::uint64_t largest = device.info().max_allocation_bytes;
    if (used > budget || bytes > budget - used)
        throw Error(ErrorCategory::OutOfMemory, hits + " of together " + std::to_string(bytes) + " bytes; " +
                                                    std::to_string(used) + " of the memory budget of " +
                                                    std::to_string(budget) + " bytes are in use" + advice);
    if (bytes > largest)
        throw Error(ErrorCategory::OutOfMemory, hits + " of together " + std::to_string(bytes) + " bytes; " +
                                                    device.info().name + " allocates up to " +
                                                    std::to_string(largest) + " bytes at a time" + advice);
}

}  // namespace setka
