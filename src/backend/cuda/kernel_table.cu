// SPDX-License-Identifier: MIT
/// Which function is which kernel? All entries of kernels_cu in one translation unit, as in one OpenCL program; a kernel that is
/// missing does not compile.
#include "backend/cuda/kernel_table.hpp"

#include "all_hits.cu"
#include "bins.cu"
#include "blocks.cu"
#include "grid.cu"
#include "probe.cu"
#include "scan.cu"
#include "shade.cu"
#include "sort.cu"
#include "trace.cu"

namespace setka::backend {

const void* cuda_kernel(Kernel kernel) noexcept {
    static const void* const table[] = {
#define SETKA_KERNEL_ADDRESS(name) reinterpret_cast<const void*>(&::name),
        SETKA_KERNEL_LIST(SETKA_KERNEL_ADDRESS)
#undef SETKA_KERNEL_ADDRESS
    };
    return table[static_cast<std::size_t>(kernel)];
}

}  // namespace setka::backend
