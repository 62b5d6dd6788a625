// SPDX-License-Identifier: MIT
#include "backend/opencl/opencl_queue.hpp"

#include <cstddef>
#include <cstring>
#include <vector>

#include "backend/pooled_memory.hpp"
#include "core/settings.hpp"

namespace setka::backend {

namespace {

class OpenClMemory final : public PooledMemory<cl::Buffer> {
  public:
    using PooledMemory::PooledMemory;
    void* host = nullptr;  ///< the memory that the buffer wraps, if it does
};

OpenClMemory& as_opencl(Memory& memory) { return static_cast<OpenClMemory&>(memory); }

}  // namespace

OpenClQueue::OpenClQueue(std::shared_ptr<OpenClDevice> device, std::shared_ptr<OpenClPool> pool)
    : device_(std::move(device)), pool_(std::move(pool)) {
    guarded("making a queue on " + device_->info().id, [&] {
        queue_ = cl::CommandQueue(device_->context(), device_->device(), CL_QUEUE_PROFILING_ENABLE);
        for (const char* name : kernel_names) kernels_.emplace_back(device_->program(), name);
    });
}

std::shared_ptr<Memory> OpenClQueue::allocate(std::uint64_t size_bytes, std::string_view name) {
    const std::string what = "allocating '" + std::string(name) + "' (" + std::to_string(size_bytes) + " bytes)";
    return allocate_pooled<OpenClMemory>(device_, pool_, size_bytes, name, [&](std::uint64_t pooled_bytes) {
        return guarded(what, [&] { return cl::Buffer(device_->context(), CL_MEM_READ_WRITE, pooled_bytes); });
    });
}

std::shared_ptr<Memory> OpenClQueue::wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                               std::string_view name) {
    // A GPU beside the CPU wants pages and cache lines; elsewhere the driver would copy behind our back.
    const bool aligned = reinterpret_cast<std::uintptr_t>(data) % 4096 == 0 && size_bytes % 64 == 0;
    if (!device_->info().unified_memory || (device_->info().type != DeviceType::Cpu && !aligned)) return nullptr;
    return guarded("wrapping '" + std::string(name) + "'", [&] {
        const cl_mem_flags flags = CL_MEM_USE_HOST_PTR | (read_only ? CL_MEM_READ_ONLY : CL_MEM_READ_WRITE);
        auto memory = std::make_shared<OpenClMemory>(size_bytes, std::string(name));
        memory->buffer = cl::Buffer(device_->context(), flags, size_bytes, data);
        memory->host = data;
        return memory;
    });
}

void OpenClQueue::launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                         const Arguments& arguments) {
    const std::string what = std::string("launching ") + to_string(kernel);
    cl::Kernel& object = kernels_[static_cast<std::size_t>(kernel)];
    std::uint64_t parameter_bytes = 0;
    for (std::size_t i = 0; i < arguments.size(); ++i)
        parameter_bytes += arguments[i].value_bytes ? arguments[i].value_bytes : sizeof(cl_mem);
    if (parameter_bytes > device_->info().max_parameter_bytes)
        throw Error(ErrorCategory::Unsupported, what + " needs " + std::to_string(parameter_bytes) +
                                                    " bytes of arguments; " + device_->info().name + " allows " +
                                                    std::to_string(device_->info().max_parameter_bytes));
    guarded(what, [&] {
        for (std::size_t i = 0; i < arguments.size(); ++i) {
            const Argument& argument = arguments[i];
            const cl_uint index = static_cast<cl_uint>(i);
            if (argument.value_bytes) {
                object.setArg(index, argument.value_bytes, argument.value.data());
            } else {
                const cl_mem handle = argument.memory ? as_opencl(*argument.memory).buffer() : nullptr;
                object.setArg(index, sizeof(cl_mem), &handle);
            }
        }
        cl::Event event;
        const cl::size_type global = cl::size_type(group_count) * group_size;
        queue_.enqueueNDRangeKernel(object, cl::NullRange, cl::NDRange(global), cl::NDRange(group_size), nullptr,
                                    &event);
        clock_.add(std::move(event));
        if (settings().log_launch) log_line(what + ", " + std::to_string(group_count) + " x " + std::to_string(group_size));
        if (settings().synchronous) queue_.finish();
    });
    if (clock_.is_full()) collect_events();
}

void OpenClQueue::write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) {
    // A checker may forget at a transfer what it knew of the rest: Oclgrind 21.10 takes each for the whole buffer. It then believes of the rest
    // of such a buffer that somebody wrote it.
    if (!settings().pooling && size_bytes < target.size_bytes()) {
        std::vector<std::byte> whole(target.size_bytes());
        read(target, whole.data(), whole.size());
        std::memcpy(whole.data() + at, source, size_bytes);
        return write(target, 0, whole.data(), whole.size());
    }
    guarded("writing '" + target.name() + "'", [&] {
        queue_.enqueueWriteBuffer(as_opencl(target).buffer, CL_TRUE, at, size_bytes, source);
    });
}

void OpenClQueue::read(Memory& source, void* target, std::uint64_t size_bytes) {
    OpenClMemory& memory = as_opencl(source);
    guarded("reading '" + source.name() + "'", [&] {
        if (memory.host == target) {
            void* mapped = queue_.enqueueMapBuffer(memory.buffer, CL_TRUE, CL_MAP_READ, 0, size_bytes);
            queue_.enqueueUnmapMemObject(memory.buffer, mapped);
            queue_.finish();
        } else {
            queue_.enqueueReadBuffer(memory.buffer, CL_TRUE, 0, size_bytes, target);
        }
    });
}

void OpenClQueue::copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
                       std::uint64_t size_bytes) {
    guarded("copying '" + source.name() + "' to '" + target.name() + "'", [&] {
        queue_.enqueueCopyBuffer(as_opencl(source).buffer, as_opencl(target).buffer, source_at, target_at, size_bytes);
    });
}

void OpenClQueue::fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) {
    // A checker may follow one transfer but not a fill: Oclgrind 21.10 takes the latter's first word for all.
    if (!settings().pooling) {
        const std::vector<std::uint32_t> words(size_bytes / sizeof pattern, pattern);
        return write(target, 0, words.data(), size_bytes);
    }
    guarded("filling '" + target.name() + "'", [&] {
        queue_.enqueueFillBuffer(as_opencl(target).buffer, pattern, 0, size_bytes);
    });
}

void OpenClQueue::finish() {
    guarded("waiting for " + device_->info().id, [&] { queue_.finish(); });
}

std::vector<StageTime> OpenClQueue::take_timings() {
    collect_events();
    return clock_.take_timings();
}

void OpenClQueue::collect_events() {
    finish();
    guarded("reading profiling data", [&] {
        clock_.collect([](const cl::Event& event) {
            const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
            const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
            return static_cast<double>(end - start) * 1e-6;
        });
    });
}

}  // namespace setka::backend
