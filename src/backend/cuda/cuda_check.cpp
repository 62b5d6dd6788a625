// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_check.hpp"

#include <atomic>

#include "core/settings.hpp"

namespace setka::backend {

namespace {

ErrorCategory category_of(cudaError_t code) {
    switch (code) {
        case cudaErrorMemoryAllocation: return ErrorCategory::OutOfMemory;
        case cudaErrorNoDevice:
        case cudaErrorInsufficientDriver:
        case cudaErrorCallRequiresNewerDriver:
        case cudaErrorStubLibrary:
        case cudaErrorSystemDriverMismatch:
        case cudaErrorCompatNotSupportedOnDevice:
        case cudaErrorNoKernelImageForDevice:
        case cudaErrorInvalidKernelImage:
        case cudaErrorInvalidPtx:
        case cudaErrorUnsupportedPtxVersion:
        case cudaErrorJitCompilerNotFound:
        case cudaErrorJitCompilationDisabled: return ErrorCategory::Unsupported;
        default: return ErrorCategory::DeviceFailed;
    }
}

}  // namespace

std::string cuda_code_name(cudaError_t code) {
    return std::string(cudaGetErrorName(code)) + " (" + cudaGetErrorString(code) + ")";
}

bool is_context_lost(cudaError_t code) noexcept {
    // cudaErrorContained and cudaErrorTensorMemoryLeak, which toolkits before 12.8 do not name.
    if (static_cast<int>(code) == 226 || static_cast<int>(code) == 721) return true;
    switch (code) {
        case cudaErrorECCUncorrectable:
        case cudaErrorNvlinkUncorrectable:
        case cudaErrorIllegalAddress:
        case cudaErrorLaunchTimeout:
        case cudaErrorAssert:
        case cudaErrorHardwareStackError:
        case cudaErrorIllegalInstruction:
        case cudaErrorMisalignedAddress:
        case cudaErrorInvalidAddressSpace:
        case cudaErrorInvalidPc:
        case cudaErrorLaunchFailure:
        case cudaErrorMpsClientTerminated:
        case cudaErrorExternalDevice: return true;
        default: return false;
    }
}

std::string cuda_advice(cudaError_t code) {
    switch (code) {
        case cudaErrorMemoryAllocation:
            return "the device has no such memory left; others may hold it (nvidia-smi lists them)";
        case cudaErrorNoDevice: return "no GPU is installed, or CUDA_VISIBLE_DEVICES hides all";
        case cudaErrorInsufficientDriver:
        case cudaErrorCallRequiresNewerDriver:
        case cudaErrorUnsupportedPtxVersion:
            return "update the NVIDIA driver, or build setka with the CUDA Toolkit of its version";
        case cudaErrorSystemDriverMismatch:
            return "the NVIDIA driver's kernel module and libraries differ: restart the machine after an update";
        case cudaErrorNoKernelImageForDevice:
        case cudaErrorInvalidKernelImage:
        case cudaErrorInvalidPtx:
        case cudaErrorJitCompilerNotFound:
        case cudaErrorJitCompilationDisabled:
            return "this build holds no code that the device can run: build setka with CMAKE_CUDA_ARCHITECTURES set to "
                   "its compute capability";
        case cudaErrorDevicesUnavailable:
            return "another process has the device for itself (nvidia-smi lists processes and the compute mode)";
        case cudaErrorInvalidConfiguration:
        case cudaErrorLaunchOutOfResources: return "open the device with a smaller work_group_size";
        default: break;
    }
    if (!is_context_lost(code)) return {};
    std::string cause;
    if (code == cudaErrorLaunchTimeout)
        cause = "a kernel ran for longer than the system allows on a device that drives a display; ";
    if (code == cudaErrorECCUncorrectable || code == cudaErrorNvlinkUncorrectable)
        cause = "the hardware failed (nvidia-smi -q shows its errors); ";
    return cause +
           "the CUDA context of this process is lost and every later call of CUDA fails: restart the process; "
           "SETKA_SYNC=1 names the kernel that failed";
}

Error cuda_error(const std::string& what, cudaError_t code) {
    const std::string advice = cuda_advice(code);
    return Error(category_of(code),
                 what + " failed: " + cuda_code_name(code) + (advice.empty() ? "" : "; ") + advice);
}

void check(cudaError_t code, const std::string& what) {
    if (code == cudaSuccess) return;
    if (!is_context_lost(code)) (void)cudaGetLastError();
    throw cuda_error(what, code);
}

void check_noexcept(cudaError_t code, const char* what) noexcept {
    static std::atomic<bool> is_loss_logged = false;
    // At the end of a process the runtime may be gone before its last user.
    if (code == cudaSuccess || code == cudaErrorCudartUnloading) return;
    if (is_context_lost(code) && is_loss_logged.exchange(true)) return;
    log_line(cuda_error(what, code).what());
}

}  // namespace setka::backend
