// SPDX-License-Identifier: MIT
#include "backend/opencl/opencl_queue.hpp"

#include <algorithm>

#include "core/settings.hpp"

namespace setka::backend {

namespace {

/// Events are summed up once there are this many, so that a long run does not collect them without end.
constexpr std::size_t max_pending_events = 1024;

class OpenClMemory final : public Memory {
  public:
    OpenClMemory(std::uint64_t size, std::string name, cl::Buffer handle, void* wrapped)
        : Memory(size, std::move(name)), buffer(std::move(handle)), host(wrapped) {}
    ~OpenClMemory() override {
        if (!device) return;
        device->release(size_bytes());
        pool->give(pooled_bytes, std::move(buffer));
    }

    cl::Buffer buffer;
    void* host = nullptr;  ///< the memory that the buffer wraps, if it does
    std::uint64_t pooled_bytes = 0;
    std::shared_ptr<OpenClDevice> device;  ///< null for a wrapped buffer
    std::shared_ptr<OpenClPool> pool;
};

OpenClMemory& as_opencl(Memory& memory) { return static_cast<OpenClMemory&>(memory); }

}  // namespace

OpenClQueue::OpenClQueue(std::shared_ptr<OpenClDevice> device, std::shared_ptr<OpenClPool> pool)
    : device_(std::move(device)), pool_(std::move(pool)) {
    guarded("making a queue on " + device_->info().id, [&] {
        queue_ = cl::CommandQueue(device_->context(), device_->device(), CL_QUEUE_PROFILING_ENABLE);
        for (const char* name : kernel_names) kernels_.emplace_back(device_->program(), name);
    });
    stages_.push_back({"other", 0, 0});
}

std::shared_ptr<Memory> OpenClQueue::allocate(std::uint64_t size_bytes, std::string_view name) {
    const std::uint64_t pooled_bytes = OpenClPool::pooled_size(size_bytes);
    if (pooled_bytes > device_->info().max_allocation_bytes)
        throw Error(ErrorCategory::OutOfMemory,
                    "buffer '" + std::string(name) + "' needs " + std::to_string(size_bytes) + " bytes; " +
                        device_->info().name + " allows " + std::to_string(device_->info().max_allocation_bytes) +
                        " in one allocation");
    device_->reserve(size_bytes, name);
    auto memory = std::make_shared<OpenClMemory>(size_bytes, std::string(name), cl::Buffer(), nullptr);
    try {
        if (auto pooled = pool_->take(pooled_bytes)) {
            memory->buffer = std::move(*pooled);
        } else {
            // Unused buffers of other sizes must not push the total over the budget.
            if (device_->in_use_bytes() + pool_->cached_bytes() > device_->options().memory_budget_bytes) pool_->clear();
            guarded("allocating '" + std::string(name) + "' (" + std::to_string(size_bytes) + " bytes)", [&] {
                memory->buffer = cl::Buffer(device_->context(), CL_MEM_READ_WRITE, pooled_bytes);
            });
        }
    } catch (...) {
        device_->release(size_bytes);
        throw;
    }
    memory->pooled_bytes = pooled_bytes;
    memory->pool = pool_;
    memory->device = device_;  // from here on the destructor releases
    if (settings().log_memory)
        log_line("allocated '" + std::string(name) + "', " + std::to_string(size_bytes) + " bytes");
    return memory;
}

std::shared_ptr<Memory> OpenClQueue::wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                               std::string_view name) {
    // A GPU beside the CPU wants pages and cache lines; elsewhere the driver would copy behind our back.
    const bool aligned = reinterpret_cast<std::uintptr_t>(data) % 4096 == 0 && size_bytes % 64 == 0;
    if (!device_->info().unified_memory || (device_->info().type != DeviceType::Cpu && !aligned)) return nullptr;
    return guarded("wrapping '" + std::string(name) + "'", [&] {
        const cl_mem_flags flags = CL_MEM_USE_HOST_PTR | (read_only ? CL_MEM_READ_ONLY : CL_MEM_READ_WRITE);
        return std::make_shared<OpenClMemory>(size_bytes, std::string(name),
                                              cl::Buffer(device_->context(), flags, size_bytes, data), data);
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
        events_.emplace_back(stage_, std::move(event));
        if (settings().log_launch) log_line(what + ", " + std::to_string(group_count) + " x " + std::to_string(group_size));
        if (settings().synchronous) queue_.finish();
    });
    if (events_.size() >= max_pending_events) collect_events();
}

void OpenClQueue::write(Memory& target, const void* source, std::uint64_t size_bytes) {
    guarded("writing '" + target.name() + "'", [&] {
        queue_.enqueueWriteBuffer(as_opencl(target).buffer, CL_TRUE, 0, size_bytes, source);
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

void OpenClQueue::copy(Memory& source, Memory& target, std::uint64_t size_bytes) {
    guarded("copying '" + source.name() + "' to '" + target.name() + "'", [&] {
        queue_.enqueueCopyBuffer(as_opencl(source).buffer, as_opencl(target).buffer, 0, 0, size_bytes);
    });
}

void OpenClQueue::fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) {
    // A checker may follow one transfer but not a fill: Oclgrind 21.10 takes the latter's first word for all.
    if (!settings().pooling) {
        const std::vector<std::uint32_t> words(size_bytes / sizeof pattern, pattern);
        return write(target, words.data(), size_bytes);
    }
    guarded("filling '" + target.name() + "'", [&] {
        queue_.enqueueFillBuffer(as_opencl(target).buffer, pattern, 0, size_bytes);
    });
}

void OpenClQueue::finish() {
    guarded("waiting for " + device_->info().id, [&] { queue_.finish(); });
}

void OpenClQueue::begin_stage(std::string_view stage) {
    const auto it = std::ranges::find(stages_, stage, &StageTime::stage);
    stage_ = static_cast<std::size_t>(it - stages_.begin());
    if (it == stages_.end()) stages_.push_back({std::string(stage), 0, 0});
}

void OpenClQueue::collect_events() {
    finish();
    guarded("reading profiling data", [&] {
        for (const auto& [stage, event] : events_) {
            const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
            const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
            stages_[stage].time_ms += static_cast<double>(end - start) * 1e-6;
            ++stages_[stage].launches;
        }
    });
    events_.clear();
}

std::vector<StageTime> OpenClQueue::take_timings() {
    collect_events();
    std::vector<StageTime> result;
    for (StageTime& stage : stages_) {
        if (stage.launches > 0) result.push_back(stage);
        stage.time_ms = 0;
        stage.launches = 0;
    }
    return result;
}

}  // namespace setka::backend
