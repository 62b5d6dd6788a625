// SPDX-License-Identifier: MIT
#include "algo/scan.hpp"

#include <cstddef>
#include <limits>
#include <string>

#include "algo/shape.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

void check_size(const char* name, std::size_t size, std::size_t needed) {
    if (size < needed)
        throw Error(ErrorCategory::InvalidArgument, std::string(name) + " has " + std::to_string(size) +
                                                        " elements; " + std::to_string(needed) + " are needed");
}

}  // namespace

std::uint64_t scan_scratch_bytes(Queue& queue, std::uint32_t n) {
    constexpr std::uint64_t total = sizeof(std::uint64_t);
    if (n == 0) return total;
    if (queue.device().options().primitives == PrimitiveShape::Library)
        return total + queue.impl().library_scan_bytes(n);
    return (primitive_layout(queue.device(), n).groups + std::uint64_t(1)) * sizeof(std::uint64_t);
}

Buffer<std::uint64_t> enqueue_exclusive_scan(Queue& queue, const Buffer<std::uint32_t>& counts, std::uint32_t n,
                                             const Buffer<std::uint32_t>& offsets) {
    check_size("counts", counts.size(), n);
    check_size("offsets", offsets.size(), std::size_t(n) + 1);
    if (n == 0) {
        auto total = queue.make_buffer<std::uint64_t>(1, "scan sums");
        queue.impl().fill(*total.memory(), 0, sizeof(std::uint64_t));
        queue.impl().fill(*offsets.memory(), 0, sizeof(std::uint32_t));
        return total;
    }
    if (queue.device().options().primitives == PrimitiveShape::Library) {
        auto total = queue.make_buffer<std::uint64_t>(1, "scan sums");
        const auto scratch = queue.make_buffer<std::byte>(queue.impl().library_scan_bytes(n), "scan scratch");
        queue.impl().check_stop("scanning");
        queue.impl().library_scan(*counts.memory(), *offsets.memory(), *total.memory(), *scratch.memory(), n);
        queue.impl().wait_if_stoppable();
        return total;
    }
    const PrimitiveLayout layout = primitive_layout(queue.device(), n);
    auto sums = queue.make_buffer<std::uint64_t>(layout.groups + std::size_t(1), "scan sums");
    const std::uint32_t spine_elements = (layout.groups + layout.group_size - 1) / layout.group_size;
    launch_groups(queue, Kernel::scan_reduce, layout.groups, layout.group_size, n, layout.elements, counts, sums);
    launch_groups(queue, Kernel::scan_spine, 1, layout.group_size, layout.groups, spine_elements, sums);
    launch_groups(queue, Kernel::scan_apply, layout.groups, layout.group_size, n, layout.elements, layout.groups,
                  counts, sums, offsets);
    return sums;
}

std::uint64_t total_of(Queue& queue, const Buffer<std::uint64_t>& sums) { return queue.download(sums).back(); }

std::uint64_t exclusive_scan(Queue& queue, const Buffer<std::uint32_t>& counts, std::uint32_t n,
                             const Buffer<std::uint32_t>& offsets, const char* what) {
    const std::uint64_t total = total_of(queue, enqueue_exclusive_scan(queue, counts, n, offsets));
    constexpr std::uint64_t limit = std::numeric_limits<std::int32_t>::max();
    if (total > limit)
        throw Error(ErrorCategory::OutOfMemory, "the scene needs " + std::to_string(total) + " " + what +
                                                    "; tables hold up to " + std::to_string(limit));
    return total;
}

}  // namespace setka
