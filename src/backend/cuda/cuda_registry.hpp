// SPDX-License-Identifier: MIT
/// Which devices does the CUDA runtime know?
#pragma once

#include "backend/registry.hpp"

namespace setka::backend {

/// Appends every CUDA device that has code in this build, and notes on the rest. A machine without a driver gets a note.
void add_cuda_devices(Registry& registry);

}  // namespace setka::backend
