// SPDX-License-Identifier: MIT
/// How is a primitive spread over the device? Groups of work-items that each own a run of consecutive elements.
#pragma once

#include <algorithm>
#include <cstdint>

#include "setka/device.hpp"

namespace setka {

/// groups * group_size work-items own `elements` elements each; together at least n.
struct PrimitiveLayout {
    std::uint32_t groups = 1;
    std::uint32_t group_size = 1;
    std::uint32_t elements = 1;
};

/// The layout for n > 0 elements. It depends on the device and never changes a result.
[[nodiscard]] inline PrimitiveLayout primitive_layout(const Device& device, std::uint32_t n) {
    const auto divide_up = [](std::uint64_t a, std::uint64_t b) { return static_cast<std::uint32_t>((a + b - 1) / b); };
    const DeviceOptions& options = device.options();
    if (options.primitives == PrimitiveShape::Serial) {
        // Long runs keep counters in cache; eight runs a core even out their lengths. Some CPU drivers end a work-item silently
        // after 65,535 loop turns, all its loops together; a scatter passes over its run and over its counters twice or more, the
        // one work-item of the scan's spine over all runs twice: enough for tables of 2 GiB, which such drivers allocate at most.
        constexpr std::uint32_t shortest = 4096, longest = 24576;
        const std::uint32_t wanted = std::min(divide_up(n, shortest), 8 * std::max(1u, device.info().compute_units));
        const std::uint32_t groups = std::max({1u, wanted, divide_up(n, longest)});
        return {groups, 1, divide_up(n, groups)};
    }
    // Also for what a library does not do: a Library device is a GPU.
    constexpr std::uint32_t elements = 16;
    return {divide_up(n, std::uint64_t(options.work_group_size) * elements), options.work_group_size, elements};
}

}  // namespace setka
