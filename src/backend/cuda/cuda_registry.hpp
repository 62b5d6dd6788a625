// SPDX-License-Identifier: MIT
/// Which devices does the CUDA runtime know?
#pragma once

#include <cuda_runtime_api.h>

#include <string>

#include "backend/registry.hpp"

namespace setka::backend {

/// Why the runtime shows no device at all, as a note. `driver` and `runtime` are versions as CUDA writes them: 13020 is 13.2.
[[nodiscard]] std::string cuda_platform_note(cudaError_t code, int driver, int runtime);

/// Why a device of this compute capability cannot be used, as a note.
[[nodiscard]] std::string cuda_device_note(cudaError_t code, int number, const cudaDeviceProp& properties);

/// Appends every CUDA device that has code in this build, and notes on the rest. A machine without a driver gets a note.
void add_cuda_devices(Registry& registry);

}  // namespace setka::backend
