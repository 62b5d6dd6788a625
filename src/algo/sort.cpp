// SPDX-License-Identifier: MIT
#include "algo/sort.hpp"

#include <cstddef>
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

std::uint64_t sort_scratch_bytes(Queue& queue, std::uint32_t n, std::uint32_t key_bits) {
    if (n < 2 || key_bits == 0) return 0;
    const std::uint64_t pairs = 2 * std::uint64_t(n) * sizeof(std::uint32_t);
    if (queue.device().options().primitives == PrimitiveShape::Library)
        return pairs + queue.impl().library_sort_bytes(n, key_bits);
    const Passes passes = passes_of(queue.device(), key_bits);
    const std::uint32_t histogram = primitive_layout(queue.device(), n).groups << passes.bits;
    return pairs + (2 * std::uint64_t(histogram) + 1) * sizeof(std::uint32_t) + scan_scratch_bytes(queue, histogram);
}

void stable_sort_pairs(Queue& queue, Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, std::uint32_t n,
                       std::uint32_t key_bits) {
    if (key_bits > 32)
        throw Error(ErrorCategory::InvalidArgument, "key_bits is " + std::to_string(key_bits) + "; 0 to 32 are accepted");
    if (keys.size() < n || values.size() < n)
        throw Error(ErrorCategory::InvalidArgument, "keys and values hold " + std::to_string(keys.size()) + " and " +
                                                        std::to_string(values.size()) + " elements; " +
                                                        std::to_string(n) + " are to be sorted");
    if (n < 2 || key_bits == 0) return;
    auto other_keys = queue.make_buffer<std::uint32_t>(n, "sort keys");
    auto other_values = queue.make_buffer<std::uint32_t>(n, "sort values");
    if (queue.device().options().primitives == PrimitiveShape::Library) {
        const auto scratch =
            queue.make_buffer<std::byte>(queue.impl().library_sort_bytes(n, key_bits), "sort scratch");
        const backend::SortBuffers buffers{*keys.memory(), *values.memory(), *other_keys.memory(),
                                           *other_values.memory(), *scratch.memory()};
        queue.impl().check_stop("sorting");
        if (queue.impl().library_sort(buffers, n, key_bits) == 1) {
            std::swap(keys, other_keys);
            std::swap(values, other_values);
        }
        queue.impl().wait_if_stoppable();
        return;
    }
    const Passes passes = passes_of(queue.device(), key_bits);
    const PrimitiveLayout layout = primitive_layout(queue.device(), n);
    const std::uint32_t digits = 1u << passes.bits;
    const std::uint32_t histogram_size = layout.groups * digits;
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
