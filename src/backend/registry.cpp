// SPDX-License-Identifier: MIT
#include "backend/registry.hpp"

#ifdef SETKA_HAS_CUDA
#include "backend/cuda/cuda_registry.hpp"
#endif
#include "backend/opencl/opencl_registry.hpp"

namespace setka::backend {

Registry find_devices() {
    Registry registry;
#ifdef SETKA_HAS_CUDA
    add_cuda_devices(registry);
#else
    registry.notes.push_back("CUDA: this build has no CUDA backend (SETKA_CUDA)");
#endif
    add_opencl_devices(registry);
    return registry;
}

}  // namespace setka::backend
