// SPDX-License-Identifier: MIT
/// How does CUB answer scan and sort? Integer sums and a stable sort have one right result, so it may stand in for our kernels.
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <cuda/std/functional>

#include <algorithm>

#include "backend/cuda/kernel_table.hpp"

namespace setka::backend {

namespace {

cudaError_t sum(void* scratch, std::size_t& size_bytes, const std::uint32_t* counts, std::uint64_t* total,
                std::uint32_t n, cudaStream_t stream) {
    return cub::DeviceReduce::Reduce(scratch, size_bytes, counts, total, n, cuda::std::plus<>{}, std::uint64_t{0},
                                     stream);
}

cudaError_t inclusive(void* scratch, std::size_t& size_bytes, const std::uint32_t* counts, std::uint32_t* sums,
                      std::uint32_t n, cudaStream_t stream) {
    return cub::DeviceScan::InclusiveSum(scratch, size_bytes, counts, sums, n, stream);
}

}  // namespace

cudaError_t cub_scan_bytes(std::uint32_t n, std::size_t* size_bytes) {
    std::size_t for_sum = 0, for_scan = 0;
    if (const cudaError_t code = sum(nullptr, for_sum, nullptr, nullptr, n, nullptr)) return code;
    if (const cudaError_t code = inclusive(nullptr, for_scan, nullptr, nullptr, n, nullptr)) return code;
    *size_bytes = std::max({for_sum, for_scan, std::size_t(1)});
    return cudaSuccess;
}

cudaError_t cub_scan(void* scratch, std::size_t size_bytes, const std::uint32_t* counts, std::uint32_t* offsets,
                     std::uint64_t* total, std::uint32_t n, cudaStream_t stream) {
    if (const cudaError_t code = sum(scratch, size_bytes, counts, total, n, stream)) return code;
    if (const cudaError_t code = cudaMemsetAsync(offsets, 0, sizeof(*offsets), stream)) return code;
    return inclusive(scratch, size_bytes, counts, offsets + 1, n, stream);
}

cudaError_t cub_sort_bytes(std::uint32_t n, std::uint32_t key_bits, std::size_t* size_bytes) {
    cub::DoubleBuffer<std::uint32_t> keys, values;
    std::size_t needed = 0;
    const cudaError_t code =
        cub::DeviceRadixSort::SortPairs(nullptr, needed, keys, values, n, 0, static_cast<int>(key_bits));
    *size_bytes = std::max(needed, std::size_t(1));
    return code;
}

cudaError_t cub_sort(void* scratch, std::size_t size_bytes, std::uint32_t* const keys[2], std::uint32_t* const values[2],
                     std::uint32_t n, std::uint32_t key_bits, cudaStream_t stream, int* selector) {
    cub::DoubleBuffer<std::uint32_t> key_buffers(keys[0], keys[1]), value_buffers(values[0], values[1]);
    const cudaError_t code = cub::DeviceRadixSort::SortPairs(scratch, size_bytes, key_buffers, value_buffers, n, 0,
                                                             static_cast<int>(key_bits), stream);
    *selector = key_buffers.selector;
    // Both move together: each pass moves keys and values.
    return key_buffers.selector == value_buffers.selector ? code : cudaErrorUnknown;
}

}  // namespace setka::backend
