// SPDX-License-Identifier: MIT
#include "backend/registry.hpp"

#include "backend/opencl/opencl_registry.hpp"

namespace setka::backend {

Registry find_devices() {
    Registry registry;
    add_opencl_devices(registry);
    return registry;
}

}  // namespace setka::backend
