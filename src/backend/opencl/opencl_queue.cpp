// SPDX-License-Identifier: MIT
#include "backend/opencl/opencl_queue.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <optional>
#include <vector>

#include "backend/opencl/large_pages.hpp"
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

/// Host memory for writes that the device has yet to make, and the largest that goes there: tables of instances and lights, meshes of some
/// hundred thousand vertices. Copying more twice costs more than it gains.
constexpr std::size_t staging_bytes = std::size_t(32) << 20;
constexpr std::size_t largest_staged_bytes = std::size_t(8) << 20;

constexpr std::byte few_zeros[1024]{};

/// What is read at once, reports and sums among it, and for how long a thread looks whether it has come before it lets the driver wait.
constexpr std::size_t few_bytes = 4096;
constexpr std::chrono::milliseconds longest_look(1);

/// Whether a write has ended. Throws if it failed: always DeviceFailed, since whoever asked for it has gone on, and nobody who has
/// less to do next time makes up for it.
bool has_ended(const cl::Event& event) {
    const cl_int status = event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>();
    if (status < 0)
        throw Error(ErrorCategory::DeviceFailed,
                    opencl_error("an earlier write", cl::Error(status, "a command that was enqueued")).what());
    return status == CL_COMPLETE;
}

double time_of(const cl::Event& event) {
    const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    return static_cast<double>(end - start) * 1e-6;
}

class OpenClPendingRead final : public PendingRead {
  public:
    OpenClPendingRead(std::string what, const cl::CommandQueue& queue, const cl::Buffer& source, std::uint64_t size_bytes,
                      void* target)
        : what_(std::move(what)) {
        queue.enqueueReadBuffer(source, CL_FALSE, 0, size_bytes, target, nullptr, &event_);
    }
    ~OpenClPendingRead() override {
        try {
            if (!is_done_) event_.wait();
        } catch (const cl::Error&) {
            // Nobody wants the bytes any more, and a command that failed writes none.
        }
    }

    [[nodiscard]] bool is_ready() override {
        return is_done_ || guarded(what_, [&] {
                   return event_.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE;  // or has failed, which wait() tells
               });
    }
    void wait() override {
        if (is_done_) return;
        guarded(what_, [&] { event_.wait(); });
        is_done_ = true;
    }

  private:
    std::string what_;
    cl::Event event_;
    bool is_done_ = false;
};

}  // namespace

OpenClQueue::OpenClQueue(std::shared_ptr<OpenClDevice> device, std::shared_ptr<OpenClPool> pool)
    : device_(std::move(device)), pool_(std::move(pool)), staged_(staging_bytes) {
    guarded("making a queue on " + device_->info().id, [&] {
        queue_ = untimed_ = cl::CommandQueue(device_->context(), device_->device());
        for (const char* name : kernel_names) kernels_.emplace_back(device_->program(), name);
        if (device_->team_size() > 1) {
            std::array<cl_uint, launch_count_words> zeros{};
            auto counts = std::make_shared<OpenClMemory>(sizeof zeros, "launch counts");
            counts->buffer = cl::Buffer(device_->context(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, sizeof zeros, zeros.data());
            launch_counts_ = std::move(counts);
        }
    });
}

OpenClQueue::~OpenClQueue() {
    try {
        // The device may still have to fetch what is staged.
        if (!staged_.empty()) queue_.finish();
    } catch (const cl::Error& error) {
        log_line(opencl_error("waiting for " + device_->info().id, error).what());
    }
    try {
        if (answer_bytes_ != nullptr) queue_.enqueueUnmapMemObject(answer_, answer_bytes_);
    } catch (const cl::Error& error) {
        log_line(opencl_error("giving back memory of " + device_->info().id, error).what());
    }
}

std::shared_ptr<Memory> OpenClQueue::allocate(std::uint64_t size_bytes, std::string_view name) {
    const auto what = [&] { return "allocating '" + std::string(name) + "' (" + std::to_string(size_bytes) + " bytes)"; };
    return allocate_pooled<OpenClMemory>(device_, pool_, size_bytes, name, [&](std::uint64_t pooled_bytes) {
        return guarded(what, [&] {
            cl::Buffer buffer;
            // Where kernels have lanes the device is a CPU, and its driver is known to work in memory that it is given.
            if (device_->width() > 1) buffer = make_large_page_buffer(device_->context(), pooled_bytes);
            if (!buffer()) buffer = cl::Buffer(device_->context(), CL_MEM_READ_WRITE, pooled_bytes);
            return buffer;
        });
    });
}

std::shared_ptr<Memory> OpenClQueue::wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                               std::string_view name) {
    // A GPU beside the CPU wants pages and cache lines; elsewhere the driver would copy behind our back.
    const bool aligned = reinterpret_cast<std::uintptr_t>(data) % 4096 == 0 && size_bytes % 64 == 0;
    if (!device_->info().unified_memory || (device_->info().type != DeviceType::Cpu && !aligned)) return nullptr;
    return guarded([&] { return "wrapping '" + std::string(name) + "'"; }, [&] {
        const cl_mem_flags flags = CL_MEM_USE_HOST_PTR | (read_only ? CL_MEM_READ_ONLY : CL_MEM_READ_WRITE);
        auto memory = std::make_shared<OpenClMemory>(size_bytes, std::string(name));
        memory->buffer = cl::Buffer(device_->context(), flags, size_bytes, data);
        memory->host = data;
        return memory;
    });
}

void OpenClQueue::launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                         const Arguments& arguments) {
    const auto what = [&] { return std::string("launching ") + to_string(kernel); };
    cl::Kernel& object = kernels_[static_cast<std::size_t>(kernel)];
    std::uint64_t parameter_bytes = 0;
    for (std::size_t i = 0; i < arguments.size(); ++i)
        parameter_bytes += arguments[i].value_bytes ? arguments[i].value_bytes : sizeof(cl_mem);
    if (parameter_bytes > device_->info().max_parameter_bytes)
        throw Error(ErrorCategory::Unsupported, what() + " needs " + std::to_string(parameter_bytes) +
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
        is_idle_ = false;
        queue_.enqueueNDRangeKernel(object, cl::NullRange, cl::NDRange(global), cl::NDRange(group_size), nullptr,
                                    clock_.is_running() ? &event : nullptr);
        if (clock_.is_running()) clock_.add(std::move(event));
        if (settings().log_launch) log_line(what() + ", " + std::to_string(group_count) + " x " + std::to_string(group_size));
        if (settings().synchronous) queue_.finish();
        if (clock_.is_full()) clock_.collect_older([](const cl::Event& last) { last.wait(); }, time_of);
    });
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
    // Where there is nothing to wait for, waiting is cheaper than a copy; and a checker may take memory for unused too early.
    if (!is_idle_ && size_bytes <= largest_staged_bytes && settings().pooling)
        return write_staged(target, at, source, size_bytes);
    guarded([&] { return "writing '" + target.name() + "'"; }, [&] {
        queue_.enqueueWriteBuffer(as_opencl(target).buffer, CL_TRUE, at, size_bytes, source);
    });
    note_idle();
}

void OpenClQueue::write_staged(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) {
    if (!staging_) staging_ = std::make_unique_for_overwrite<std::byte[]>(staging_bytes);
    guarded([&] { return "writing '" + target.name() + "'"; }, [&] {
        staged_.use(size_bytes, has_ended, [](const cl::Event& oldest) { oldest.wait(); }, [&](std::size_t place) {
            cl::Event event;
            std::memcpy(staging_.get() + place, source, size_bytes);
            queue_.enqueueWriteBuffer(as_opencl(target).buffer, CL_FALSE, at, size_bytes, staging_.get() + place, nullptr,
                                      &event);
            return event;
        });
    });
}

void OpenClQueue::read(Memory& source, void* target, std::uint64_t size_bytes) {
    const auto what = [&] { return "reading '" + source.name() + "'"; };
    OpenClMemory& memory = as_opencl(source);
    if (memory.host == target) {
        guarded(what, [&] {
            void* mapped = queue_.enqueueMapBuffer(memory.buffer, CL_TRUE, CL_MAP_READ, 0, size_bytes);
            queue_.enqueueUnmapMemObject(memory.buffer, mapped);
            queue_.finish();
        });
    } else {
        guarded(what, [&] {
            // Without a pool a checker is at work: it is to see a plain read.
            if (size_bytes <= few_bytes && device_->info().type == DeviceType::Gpu && settings().pooling)
                read_few(memory.buffer, target, size_bytes);
            else  // NVIDIA's driver takes longer to read without blocking and to wait for that, if the driver does not own the memory.
                queue_.enqueueReadBuffer(memory.buffer, CL_TRUE, 0, size_bytes, target);
        });
    }
    note_idle();
}

void OpenClQueue::read_few(const cl::Buffer& source, void* target, std::uint64_t size_bytes) {
    if (answer_bytes_ == nullptr) {
        answer_ = cl::Buffer(device_->context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, few_bytes);
        answer_bytes_ = queue_.enqueueMapBuffer(answer_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, few_bytes);
    }
    cl::Event event;
    queue_.enqueueReadBuffer(source, CL_FALSE, 0, size_bytes, answer_bytes_, nullptr, &event);
    queue_.flush();
    const auto enough = std::chrono::steady_clock::now() + longest_look;
    while (event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() > CL_COMPLETE && std::chrono::steady_clock::now() < enough) {
    }
    event.wait();  // tells of failures, too
    std::memcpy(target, answer_bytes_, size_bytes);
}

std::unique_ptr<PendingRead> OpenClQueue::read_later(Memory& source, void* target, std::uint64_t size_bytes) {
    const std::string what = "reading '" + source.name() + "'";
    return guarded(what, [&] {
        is_idle_ = false;
        auto pending = std::make_unique<OpenClPendingRead>(what, queue_, as_opencl(source).buffer, size_bytes, target);
        queue_.flush();  // so that the device begins before anybody waits
        return pending;
    });
}

void OpenClQueue::copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
                       std::uint64_t size_bytes) {
    is_idle_ = false;
    guarded([&] { return "copying '" + source.name() + "' to '" + target.name() + "'"; }, [&] {
        queue_.enqueueCopyBuffer(as_opencl(source).buffer, as_opencl(target).buffer, source_at, target_at, size_bytes);
    });
}

void OpenClQueue::fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) {
    // A checker may follow one transfer but not a fill: Oclgrind 21.10 takes the latter's first word for all.
    if (!settings().pooling) {
        const std::vector<std::uint32_t> words(size_bytes / sizeof pattern, pattern);
        return write(target, 0, words.data(), size_bytes);
    }
    is_idle_ = false;
    guarded([&] { return "filling '" + target.name() + "'"; }, [&] {
        // A few bytes are part of the command that writes them: NVIDIA's driver takes half as long to enqueue it.
        if (pattern == 0 && size_bytes <= sizeof few_zeros)
            queue_.enqueueWriteBuffer(as_opencl(target).buffer, CL_FALSE, 0, size_bytes, few_zeros);
        else
            queue_.enqueueFillBuffer(as_opencl(target).buffer, pattern, 0, size_bytes);
    });
}

void OpenClQueue::finish() {
    guarded([&] { return "waiting for " + device_->info().id; }, [&] { queue_.finish(); });
    note_idle();
}

void OpenClQueue::note_idle() {
    is_idle_ = true;
    std::optional<Error> first;
    for (bool is_over = false; !is_over;) {
        try {
            guarded([&] { return "writing to " + device_->info().id; }, [&] { staged_.retire(has_ended); });
            is_over = true;
        } catch (const Error& error) {  // and that place is forgotten
            if (!first) first = error;
        }
    }
    if (first) throw Error(*first);
}

std::vector<StageTime> OpenClQueue::take_timings() {
    collect_events();  // and nothing is left to do, so that another command queue may go on
    if (!timed_())
        timed_ = guarded([&] { return "making a queue on " + device_->info().id; }, [&] {
            return cl::CommandQueue(device_->context(), device_->device(), CL_QUEUE_PROFILING_ENABLE);
        });
    queue_ = timed_;
    clock_.start();
    return clock_.take_timings();
}

void OpenClQueue::stop_timings() {
    if (!clock_.is_running()) return;
    (void)take_timings();
    queue_ = untimed_;
    clock_.stop();
}

void OpenClQueue::collect_events() {
    finish();
    guarded("reading profiling data", [&] { clock_.collect(time_of); });
}

}  // namespace setka::backend
