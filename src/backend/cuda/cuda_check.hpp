// SPDX-License-Identifier: MIT
/// How do CUDA's codes become errors? With the call that failed, the code's name and text, and what a user can do.
#pragma once

#include <cuda_runtime_api.h>

#include <concepts>
#include <string>

#include "setka/error.hpp"

namespace setka::backend {

/// "cudaErrorNoDevice (no CUDA-capable device is detected)".
[[nodiscard]] std::string cuda_code_name(cudaError_t code);

/// Whether the process's CUDA context is lost: every later call of CUDA returns the same code, until the process ends.
[[nodiscard]] bool is_context_lost(cudaError_t code) noexcept;

/// What a user can do about a code, as a clause; empty if there is nothing to say.
[[nodiscard]] std::string cuda_advice(cudaError_t code);

/// The Error for a failed call; `what` says what was being done.
[[nodiscard]] Error cuda_error(const std::string& what, cudaError_t code);

/// Throws cuda_error() if `code` is a failure. Clears errors that do not stick.
void check(cudaError_t code, const std::string& what);
/// The same, with a sentence that is made only when it is needed: a launch takes as long as a few sentences.
template <std::invocable What>
void check(cudaError_t code, const What& what) {
    if (code != cudaSuccess) check(code, std::string(what()));
}

/// For destructors: logs a failure and goes on. A lost context fails each of them, and is logged once.
void check_noexcept(cudaError_t code, const char* what) noexcept;

}  // namespace setka::backend
