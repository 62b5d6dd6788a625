// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_check.hpp"

#include "core/settings.hpp"

namespace setka::backend {

namespace {

/// After these the process's CUDA context is lost; every later call returns the same code.
bool sticks(cudaError_t code) {
    switch (code) {
        case cudaErrorIllegalAddress:
        case cudaErrorLaunchTimeout:
        case cudaErrorAssert:
        case cudaErrorHardwareStackError:
        case cudaErrorIllegalInstruction:
        case cudaErrorMisalignedAddress:
        case cudaErrorInvalidAddressSpace:
        case cudaErrorInvalidPc:
        case cudaErrorLaunchFailure: return true;
        default: return false;
    }
}

}  // namespace

void check(cudaError_t code, const std::string& what) {
    if (code == cudaSuccess) return;
    std::string text = what + " failed: " + cudaGetErrorName(code) + " (" + cudaGetErrorString(code) + ")";
    if (sticks(code))
        text += "; CUDA is unusable in this process from here on: restart it, and set SETKA_SYNC=1 to learn the kernel";
    else
        (void)cudaGetLastError();
    throw Error(code == cudaErrorMemoryAllocation ? ErrorCategory::OutOfMemory : ErrorCategory::DeviceFailed, text);
}

void check_noexcept(cudaError_t code, const char* what) noexcept {
    // At the end of a process the runtime may be gone before its last user.
    if (code != cudaSuccess && code != cudaErrorCudartUnloading)
        log_line(std::string(what) + " failed: " + cudaGetErrorName(code));
}

}  // namespace setka::backend
