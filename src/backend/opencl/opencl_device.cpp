// SPDX-License-Identifier: MIT
#include "backend/opencl/opencl_device.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "backend/opencl/opencl_queue.hpp"
#include "backend/program_source.hpp"
#include "core/settings.hpp"

namespace setka::backend {

std::string opencl_code_name(cl_int code) {
    switch (code) {
#define SETKA_CODE(name) \
    case name: return #name
        SETKA_CODE(CL_DEVICE_NOT_FOUND);
        SETKA_CODE(CL_DEVICE_NOT_AVAILABLE);
        SETKA_CODE(CL_COMPILER_NOT_AVAILABLE);
        SETKA_CODE(CL_MEM_OBJECT_ALLOCATION_FAILURE);
        SETKA_CODE(CL_OUT_OF_RESOURCES);
        SETKA_CODE(CL_OUT_OF_HOST_MEMORY);
        SETKA_CODE(CL_MEM_COPY_OVERLAP);
        SETKA_CODE(CL_BUILD_PROGRAM_FAILURE);
        SETKA_CODE(CL_MAP_FAILURE);
        SETKA_CODE(CL_MISALIGNED_SUB_BUFFER_OFFSET);
        SETKA_CODE(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
        SETKA_CODE(CL_INVALID_VALUE);
        SETKA_CODE(CL_INVALID_DEVICE);
        SETKA_CODE(CL_INVALID_CONTEXT);
        SETKA_CODE(CL_INVALID_QUEUE_PROPERTIES);
        SETKA_CODE(CL_INVALID_COMMAND_QUEUE);
        SETKA_CODE(CL_INVALID_HOST_PTR);
        SETKA_CODE(CL_INVALID_MEM_OBJECT);
        SETKA_CODE(CL_INVALID_BUILD_OPTIONS);
        SETKA_CODE(CL_INVALID_PROGRAM);
        SETKA_CODE(CL_INVALID_PROGRAM_EXECUTABLE);
        SETKA_CODE(CL_INVALID_KERNEL_NAME);
        SETKA_CODE(CL_INVALID_KERNEL);
        SETKA_CODE(CL_INVALID_ARG_INDEX);
        SETKA_CODE(CL_INVALID_ARG_VALUE);
        SETKA_CODE(CL_INVALID_ARG_SIZE);
        SETKA_CODE(CL_INVALID_KERNEL_ARGS);
        SETKA_CODE(CL_INVALID_WORK_GROUP_SIZE);
        SETKA_CODE(CL_INVALID_WORK_ITEM_SIZE);
        SETKA_CODE(CL_INVALID_EVENT);
        SETKA_CODE(CL_INVALID_OPERATION);
        SETKA_CODE(CL_INVALID_BUFFER_SIZE);
        SETKA_CODE(CL_INVALID_GLOBAL_WORK_SIZE);
#undef SETKA_CODE
        case -1001: return "CL_PLATFORM_NOT_FOUND_KHR";
        default: return "OpenCL error " + std::to_string(code);
    }
}

Error opencl_error(const std::string& what, const cl::Error& error) {
    const bool memory = error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_RESOURCES ||
                        error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_INVALID_BUFFER_SIZE;
    return Error(memory ? ErrorCategory::OutOfMemory : ErrorCategory::DeviceFailed,
                 what + " failed: " + (error.what() ? error.what() : "OpenCL call") + " returned " +
                     opencl_code_name(error.err()));
}

namespace {

/// What SETKA_WIDTH says to have CPUs run the walks of GPUs.
constexpr const char* teams = "team";

/// Eight floats fill a register of AVX, sixteen one of AVX-512. Only compilers that are known to cope: Mesa's rusticl cannot translate
/// the reductions of vectors, and Oclgrind executes vectors no faster.
std::uint32_t width_of(const cl::Device& device, const DeviceInfo& info) {
    const bool copes = info.platform.starts_with("Portable Computing Language") || info.platform.starts_with("Intel(R)");
    if (info.type != DeviceType::Cpu || !copes) return 1;
    const std::string& width = settings().width;
    if (width == teams) return 1;
    if (width.empty()) return device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>() >= 16 ? 16 : 8;
    if (width != "1" && width != "8" && width != "16")
        throw Error(ErrorCategory::InvalidArgument, "SETKA_WIDTH is '" + width + "'; 1, 8, 16 and team are accepted");
    return static_cast<std::uint32_t>(std::stoul(width));
}

/// GPUs run 32 or 64 work-items in step. A CPU's run one after the other, and would wait at each barrier for all of them.
std::uint32_t team_of(const DeviceInfo& info) {
    const bool in_step = info.type == DeviceType::Gpu || (info.type == DeviceType::Cpu && settings().width == teams);
    return in_step && info.max_work_group_size >= 32 ? 32 : 1;
}

}  // namespace

OpenClDevice::OpenClDevice(cl::Device device, DeviceInfo info, const DeviceOptions& options)
    : device_(std::move(device)), info_(std::move(info)) {
    guarded("opening " + info_.id, [&] {
        context_ = cl::Context(device_);
        width_ = width_of(device_, info_);
        team_size_ = team_of(info_);
        has_doubles_ = device_.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
    });
    build_program();
    options_ = resolve_options(options, info_, capabilities());
}

void OpenClDevice::build_program() {
    const auto start = std::chrono::steady_clock::now();
    // Contraction is switched off in the source; no option may ever relax the arithmetic.
    std::string build_options = "-cl-std=CL1.2";
    if (info_.correctly_rounded_divide_sqrt) build_options += " -cl-fp32-correctly-rounded-divide-sqrt";
    build_options += " -DSK_WIDTH=" + std::to_string(width()) + "u";
    build_options += " -DSK_DOUBLE=" + std::to_string(int(has_doubles()));
    build_options += " -DSK_TEAM=" + std::to_string(team_size());
    // As for CUDA: walks wait for memory, so that more of them at a time are worth more than registers, and 28 teams of 72 run at a time on a
    // multiprocessor. The limit is for kernels only that do not say how large their groups are.
    if (device_.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_nv_compiler_options") != std::string::npos)
        build_options += " -cl-nv-maxrregcount=72 -DSK_LIMITED";
    const auto build_log = [&]() -> std::string {
        try {
            return program_.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_);
        } catch (const cl::Error&) {
            return "(the driver gave no log)";
        }
    };
    try {
        program_ = cl::Program(context_, assemble_program("kernels_cl/", ".cl"));
        program_.build(std::vector<cl::Device>{device_}, build_options.c_str());
    } catch (const cl::Error& error) {
        const std::string log = program_() ? build_log() : "";
        throw Error(ErrorCategory::BuildFailed, "compiling the kernels for " + info_.name + " failed: " +
                                                    opencl_code_name(error.err()) + "\n" + log);
    }
    if (settings().log_build) {
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        log_line("built the kernels for " + info_.name + " (" + build_options + ") in " + std::to_string(time.count()) + " ms\n" + build_log());
    }
}

DeviceCapabilities OpenClDevice::capabilities() const {
    DeviceCapabilities capabilities;
    // Drivers may allow a kernel less than the device's maximum.
    capabilities.kernel_work_group_size = info_.max_work_group_size;
    guarded("asking for the kernels' limits", [&] {
        for (std::size_t i = 0; i < kernel_count; ++i) {
            if (team_size() > 1 && is_team_kernel(static_cast<Kernel>(i))) continue;
            const cl::size_type limit = cl::Kernel(program_, kernel_names[i]).getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_) *
                                        elements_an_item(static_cast<Kernel>(i), width());
            capabilities.kernel_work_group_size = static_cast<std::uint32_t>(
                std::min<cl::size_type>(capabilities.kernel_work_group_size, limit));
        }
    });
    const bool is_cpu = info_.type == DeviceType::Cpu;
    capabilities.default_work_group_size = is_cpu ? 64 : 128;
    capabilities.portable_primitives = is_cpu ? PrimitiveShape::Serial : PrimitiveShape::Group;
    capabilities.default_primitives = capabilities.portable_primitives;
    capabilities.memory_bytes = info_.memory_bytes;
    // A CPU driver's figure may be a fraction of the machine's memory, taken at load time.
    if (is_cpu)
        capabilities.memory_bytes =
            std::max(capabilities.memory_bytes,
                     std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE)));
    return capabilities;
}

std::shared_ptr<Queue> OpenClDevice::make_queue() {
    return std::make_shared<OpenClQueue>(std::static_pointer_cast<OpenClDevice>(shared_from_this()),
                                         pools_.make_pool());
}

}  // namespace setka::backend
