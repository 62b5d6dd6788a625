// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_registry.hpp"

#include <fstream>
#include <string>

#include "backend/cuda/cuda_device.hpp"
#include "backend/cuda/kernel_table.hpp"

namespace setka::backend {

namespace {

std::string version_text(int version) {
    return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

/// The driver's own version, "580.95.05", which the runtime does not tell but Linux does; else an empty string.
std::string driver_version() {
    // "NVRM version: NVIDIA UNIX x86_64 Kernel Module  580.95.05  <date>"
    std::ifstream file("/proc/driver/nvidia/version");
    for (std::string word; file >> word;)
        if (word.find_first_not_of("0123456789.") == std::string::npos && word.find('.') != std::string::npos)
            return word;
    return {};
}

DeviceInfo describe(int number, const cudaDeviceProp& properties, int driver, int runtime) {
    DeviceInfo info;
    info.id = "cuda:" + std::to_string(number);
    info.backend = Backend::Cuda;
    info.type = DeviceType::Gpu;
    info.name = properties.name;
    info.vendor = "NVIDIA Corporation";
    info.platform = "CUDA " + version_text(runtime) + ", compute capability " + std::to_string(properties.major) + "." +
                    std::to_string(properties.minor);
    const std::string version = driver_version();
    info.driver = version + (version.empty() ? "CUDA " : ", CUDA ") + version_text(driver);
    info.compute_units = static_cast<std::uint32_t>(properties.multiProcessorCount);
    info.max_work_group_size = static_cast<std::uint32_t>(properties.maxThreadsPerBlock);
    info.memory_bytes = properties.totalGlobalMem;
    info.max_allocation_bytes = properties.totalGlobalMem;
    info.local_memory_bytes = properties.sharedMemPerBlock;
    info.max_parameter_bytes = 4096;  // of every architecture (CUDA C++ Programming Guide, "Function parameters")
    info.unified_memory = false;
    info.correctly_rounded_divide_sqrt = true;  // by the flags that the kernels are compiled with
    return info;
}

}  // namespace

std::string cuda_platform_note(cudaError_t code, int driver, int runtime) {
    if (driver == 0 && code == cudaSuccess)
        return "CUDA: no NVIDIA driver was found; for an NVIDIA GPU install one for CUDA " + version_text(runtime) +
               " or later";
    const std::string versions = " (driver for CUDA " + (driver == 0 ? "unknown" : version_text(driver)) +
                                 ", built with CUDA " + version_text(runtime) + ")";
    const std::string advice = cuda_advice(code);
    return "CUDA: " + cuda_code_name(code) + versions + (advice.empty() ? "" : "; ") + advice;
}

std::string cuda_device_note(cudaError_t code, int number, const cudaDeviceProp& properties) {
    const std::string advice = cuda_advice(code);
    return "CUDA device " + std::to_string(number) + " (" + properties.name + ", compute capability " +
           std::to_string(properties.major) + "." + std::to_string(properties.minor) + ") cannot be used: " +
           cuda_code_name(code) + (advice.empty() ? "" : "; ") + advice;
}

void add_cuda_devices(Registry& registry) {
    int driver = 0, runtime = 0, count = 0;
    cudaError_t found = cudaDriverGetVersion(&driver);
    (void)cudaRuntimeGetVersion(&runtime);
    // The version is 0 without a driver; that is no error.
    if (found == cudaSuccess && driver != 0) found = cudaGetDeviceCount(&count);
    if (found != cudaSuccess || driver == 0) {
        (void)cudaGetLastError();
        registry.notes.push_back(cuda_platform_note(found, driver, runtime));
        return;
    }
    for (int number = 0; number < count; ++number) {
        cudaDeviceProp properties{};
        cudaFuncAttributes attributes{};
        cudaError_t code = cudaGetDeviceProperties(&properties, number);
        if (code == cudaSuccess) code = cudaSetDevice(number);
        // Fails if the build has neither code for this architecture nor PTX that the driver can translate for it.
        if (code == cudaSuccess) code = cudaFuncGetAttributes(&attributes, cuda_kernel(Kernel::grid_emit));
        if (code != cudaSuccess) {
            (void)cudaGetLastError();
            registry.notes.push_back(cuda_device_note(code, number, properties));
            continue;
        }
        const DeviceInfo info = describe(number, properties, driver, runtime);
        registry.devices.push_back({info, [number, info](const DeviceOptions& options) {
                                        return std::make_shared<CudaDevice>(number, info, options);
                                    }});
    }
}

}  // namespace setka::backend
