// SPDX-License-Identifier: MIT
/// Where are the compiled kernels and library primitives? What nvcc compiles, behind plain functions for the rest.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "core/kernels.hpp"

namespace setka::backend {

/// The entry of a kernel, for cudaLaunchKernel.
[[nodiscard]] const void* cuda_kernel(Kernel kernel) noexcept;

// CUB. Each takes scratch of at least the bytes that its query returns; the pointers are device memory.
[[nodiscard]] cudaError_t cub_scan_bytes(std::uint32_t n, std::size_t* size_bytes);
[[nodiscard]] cudaError_t cub_scan(void* scratch, std::size_t size_bytes, const std::uint32_t* counts,
                                   std::uint32_t* offsets, std::uint64_t* total, std::uint32_t n, cudaStream_t stream);
[[nodiscard]] cudaError_t cub_sort_bytes(std::uint32_t n, std::uint32_t key_bits, std::size_t* size_bytes);
/// Sorts between two pairs of buffers; *selector is which pair holds the result.
[[nodiscard]] cudaError_t cub_sort(void* scratch, std::size_t size_bytes, std::uint32_t* const keys[2],
                                   std::uint32_t* const values[2], std::uint32_t n, std::uint32_t key_bits,
                                   cudaStream_t stream, int* selector);

}  // namespace setka::backend
