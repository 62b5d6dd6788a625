// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_device.hpp"

#include <algorithm>

#include "backend/cuda/cuda_queue.hpp"
#include "backend/cuda/kernel_table.hpp"

namespace setka::backend {

CudaDevice::CudaDevice(int number, DeviceInfo info, const DeviceOptions& options)
    : number_(number), info_(std::move(info)) {
    check(cudaSetDevice(number_), "selecting " + info_.id);
    check(cudaFree(nullptr), "starting " + info_.id);
    options_ = resolve_options(options, info_, capabilities());
}

DeviceCapabilities CudaDevice::capabilities() const {
    DeviceCapabilities capabilities;
    // A kernel that uses many registers allows smaller groups.
    capabilities.kernel_work_group_size = info_.max_work_group_size;
    for (std::size_t i = 0; i < kernel_count; ++i) {
        if (is_team_kernel(static_cast<Kernel>(i))) continue;
        cudaFuncAttributes attributes{};
        check(cudaFuncGetAttributes(&attributes, cuda_kernel(static_cast<Kernel>(i))),
              std::string("asking for the limits of ") + kernel_names[i]);
        capabilities.kernel_work_group_size = std::min(capabilities.kernel_work_group_size,
                                                       static_cast<std::uint32_t>(attributes.maxThreadsPerBlock));
    }
    capabilities.default_work_group_size = 128;
    capabilities.portable_primitives = PrimitiveShape::Group;
    capabilities.default_primitives = PrimitiveShape::Library;
    capabilities.memory_bytes = info_.memory_bytes;
    return capabilities;
}

std::shared_ptr<Queue> CudaDevice::make_queue() {
    return std::make_shared<CudaQueue>(std::static_pointer_cast<CudaDevice>(shared_from_this()), pools_.make_pool(),
                                       landings_.make_pool(most_cached_landing_bytes));
}

}  // namespace setka::backend
