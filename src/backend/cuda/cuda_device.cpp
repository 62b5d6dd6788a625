// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_device.hpp"

#include <algorithm>
#include <bit>

#include "backend/cuda/cuda_queue.hpp"
#include "backend/cuda/kernel_table.hpp"

namespace setka::backend {

CudaDevice::CudaDevice(int number, DeviceInfo info, const DeviceOptions& options)
    : number_(number), info_(std::move(info)) {
    check(cudaSetDevice(number_), "selecting " + info_.id);
    check(cudaFree(nullptr), "starting " + info_.id);
    resolve_options(options);
}

void CudaDevice::resolve_options(const DeviceOptions& options) {
    options_ = options;
    // A kernel that uses many registers allows smaller groups.
    std::uint32_t largest = std::min<std::uint32_t>(256, info_.max_work_group_size);
    for (std::size_t i = 0; i < kernel_count; ++i) {
        cudaFuncAttributes attributes{};
        check(cudaFuncGetAttributes(&attributes, cuda_kernel(static_cast<Kernel>(i))),
              std::string("asking for the limits of ") + kernel_names[i]);
        largest = std::min(largest, static_cast<std::uint32_t>(attributes.maxThreadsPerBlock));
    }
    largest = std::bit_floor(std::max(largest, 1u));
    if (options.work_group_size != 0 &&
        (!std::has_single_bit(options.work_group_size) || options.work_group_size > largest))
        throw Error(ErrorCategory::InvalidArgument,
                    "work_group_size is " + std::to_string(options.work_group_size) + "; " + info_.name +
                        " accepts powers of two up to " + std::to_string(largest));
    if (options_.work_group_size == 0) options_.work_group_size = std::min(largest, 128u);
    if (options_.primitives == PrimitiveShape::Auto) options_.primitives = PrimitiveShape::Library;
    if (options_.primitives == PrimitiveShape::Portable) options_.primitives = PrimitiveShape::Group;
    if (options_.memory_budget_bytes == 0) options_.memory_budget_bytes = info_.memory_bytes / 4 * 3;
}

std::shared_ptr<Queue> CudaDevice::make_queue() {
    auto pool = std::make_shared<CudaPool>();
    auto queue = std::make_shared<CudaQueue>(std::static_pointer_cast<CudaDevice>(shared_from_this()), pool);
    const std::scoped_lock lock(pools_mutex_);
    std::erase_if(pools_, [](const auto& weak) { return weak.expired(); });
    pools_.push_back(pool);
    return queue;
}

void CudaDevice::trim() {
    const std::scoped_lock lock(pools_mutex_);
    for (const auto& weak : pools_)
        if (const auto pool = weak.lock()) pool->clear();
}

}  // namespace setka::backend
