// SPDX-License-Identifier: MIT
#include "backend/opencl/opencl_registry.hpp"

#include "backend/opencl/opencl_device.hpp"

namespace setka::backend {

namespace {

/// Drivers pad names with spaces and end them with a zero byte.
std::string trimmed(std::string text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\0' || c == '\n'; };
    while (!text.empty() && is_blank(text.back())) text.pop_back();
    text.erase(0, text.find_first_not_of(' '));
    return text;
}

DeviceType type_of(cl_device_type type) {
    if (type & CL_DEVICE_TYPE_CPU) return DeviceType::Cpu;
    if (type & CL_DEVICE_TYPE_GPU) return DeviceType::Gpu;
    if (type & CL_DEVICE_TYPE_ACCELERATOR) return DeviceType::Accelerator;
    return DeviceType::Other;
}

DeviceInfo describe(const cl::Device& device, const std::string& platform) {
    DeviceInfo info;
    info.backend = Backend::OpenCL;
    info.type = type_of(device.getInfo<CL_DEVICE_TYPE>());
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    info.platform = platform;
    info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.max_work_group_size = static_cast<std::uint32_t>(device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>());
    info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.local_memory_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    info.max_parameter_bytes = device.getInfo<CL_DEVICE_MAX_PARAMETER_SIZE>();
    info.unified_memory = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != 0;
    info.correctly_rounded_divide_sqrt =
        (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    return info;
}

/// Why a device cannot be used, or an empty string.
std::string obstacle(const cl::Device& device) {
    if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "is not available";
    if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "has no compiler";
    if (!device.getInfo<CL_DEVICE_ENDIAN_LITTLE>()) return "is big-endian";
    const std::string version = device.getInfo<CL_DEVICE_VERSION>();  // "OpenCL <major>.<minor> …"
    int major = 0, minor = 0;
    if (std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor) != 2 || major * 10 + minor < 12)
        return "offers " + version + "; OpenCL 1.2 is needed";
    return {};
}

}  // namespace

void add_opencl_devices(Registry& registry) {
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error& error) {
        registry.notes.push_back("OpenCL: no platform found (" + opencl_code_name(error.err()) +
                                 "); install a driver, e.g. Debian's pocl-opencl-icd for the CPU");
        return;
    }
    std::size_t index = 0;
    for (const cl::Platform& platform : platforms) {
        std::string platform_name = "?";
        std::vector<cl::Device> devices;
        try {
            platform_name = trimmed(platform.getInfo<CL_PLATFORM_NAME>()) + ", " +
                            trimmed(platform.getInfo<CL_PLATFORM_VERSION>());
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error& error) {
            registry.notes.push_back("OpenCL platform " + platform_name + " has no device (" +
                                     opencl_code_name(error.err()) + ")");
        }
        for (const cl::Device& device : devices) {
            try {
                DeviceInfo info = describe(device, platform_name);
                if (const std::string reason = obstacle(device); !reason.empty()) {
                    registry.notes.push_back("OpenCL device " + info.name + " " + reason);
                    continue;
                }
                info.id = "opencl:" + std::to_string(index++);
                registry.devices.push_back({info, [device, info](const DeviceOptions& options) {
                                                return std::make_shared<OpenClDevice>(device, info, options);
                                            }});
            } catch (const cl::Error& error) {
                registry.notes.push_back("an OpenCL device of " + platform_name + " does not answer (" +
                                         opencl_code_name(error.err()) + ")");
            }
        }
    }
}

}  // namespace setka::backend
