// SPDX-License-Identifier: MIT
#include "algo/sort.hpp"

#include <string>
#include <utility>

#include "algo/scan.hpp"
#include "algo/shape.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

/// How many passes of how many bits: as few passes as the counters in local memory allow, of equal width.
struct Passes {
    std::uint32_t count = 0;
    std::uint32_t bits = 0;
};

Passes passes_of(const Device& device, std::uint32_t key_bits) {
    // 2^bits counters for each of up to 256 work-items share 4096; a lone work-item is fastest with 11 bits.
    const std::uint32_t widest = device.options().primitives == PrimitiveShape::Serial ? 11 : 4;
    const std::uint32_t count = (key_bits + widest - 1) / widest;
    return {count, count == 0 ? 0 : (key_bits + count - 1) / count};
}

}  // namespace

std::uint64_t sort_scratch_bytes(const Device& device, std::uint32_t n, std::uint32_t key_bits) {
    const Passes passes = passes_of(device, key_bits);
    if (n < 2 || passes.count == 0) return 0;
    const std::uint32_t histogram = primitive_layout(device, n).groups << passes.bits;
    return (2 * std::uint64_t(n) + histogram + histogram + 1) * sizeof(std::uint32_t) +
           scan_scratch_bytes(device, histogram);
}

void stable_sort_pairs(Queue& queue, Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, std::uint32_t n,
                       std::uint32_t key_bits) {
    if (key_bits > 32)
        throw Error(ErrorCategory::InvalidArgument, "key_bits is " + std::to_string(key_bits) + "; 0 to 32 are accepted");
    if (keys.size() < n || values.size() < n)
        throw Error(ErrorCategory::InvalidArgument, "keys and values hold " + std::to_string(keys.size()) + " and " +
                                                        std::to_string(values.size()) + " elements; " +
                                                        std::to_string(n) + " are to be sorted");
    const Passes passes = passes_of(queue.device(), key_bits);
    if (n < 2 || passes.count == 0) return;
    const PrimitiveLayout layout = primitive_layout(queue.device(), n);
    const std::uint32_t digits = 1u << passes.bits;
    const std::uint32_t histogram_size = layout.groups * digits;
    auto other_keys = queue.make_buffer<std::uint32_t>(n, "sort keys");
    auto other_values = queue.make_buffer<std::uint32_t>(n, "sort values");
    const auto histogram = queue.make_buffer<std::uint32_t>(histogram_size, "sort histogram");
    const auto starts = queue.make_buffer<std::uint32_t>(histogram_size + std::size_t(1), "sort starts");
    for (std::uint32_t pass = 0; pass < passes.count; ++pass) {
        const std::uint32_t shift = pass * passes.bits;
        launch_groups(queue, Kernel::sort_count, layout.groups, layout.group_size, n, layout.elements, shift, digits,
                      layout.groups, keys, histogram);
        const auto sums = enqueue_exclusive_scan(queue, histogram, histogram_size, starts);
        launch_groups(queue, Kernel::sort_scatter, layout.groups, layout.group_size, n, layout.elements, shift, digits,
                      layout.groups, keys, values, starts, other_keys, other_values);
        std::swap(keys, other_keys);
        std::swap(values, other_values);
    }
}

}  // namespace setka
