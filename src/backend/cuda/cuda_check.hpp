// SPDX-License-Identifier: MIT
/// How do CUDA's codes become errors? With the call that failed, the code's name and text, and what a user can do.
#pragma once

#include <cuda_runtime_api.h>

#include <string>

#include "setka/error.hpp"

namespace setka::backend {

/// Throws an Error if `code` is a failure; `what` says what was being done. Clears errors that do not stick.
void check(cudaError_t code, const std::string& what);

/// For destructors: logs a failure and goes on.
void check_noexcept(cudaError_t code, const char* what) noexcept;

}  // namespace setka::backend
