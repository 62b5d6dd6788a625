// SPDX-License-Identifier: MIT
/// Which devices does the OpenCL loader know?
#pragma once

#include "backend/registry.hpp"

namespace setka::backend {

/// Appends every OpenCL device that can compile kernels, platform by platform, and notes on the rest. Never throws for a
/// driver's fault.
void add_opencl_devices(Registry& registry);

}  // namespace setka::backend
