// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_queue.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "backend/cuda/kernel_table.hpp"
#include "core/settings.hpp"

namespace setka::backend {

namespace {

/// Intervals are summed up once there are this many, so that a long run does not collect events without end.
constexpr std::size_t max_pending_intervals = 1024;
/// Pinned memory for transfers, one of two halves: large enough for full speed, small enough to have always.
constexpr std::size_t staging_bytes = std::size_t(8) << 20;

class CudaMemory final : public Memory {
  public:
    CudaMemory(std::uint64_t size, std::string name) : Memory(size, std::move(name)) {}
    ~CudaMemory() override {
        if (!device) return;
        device->release(size_bytes());
        pool->give(pooled_bytes, std::move(buffer));
    }

    CudaBuffer buffer;
    std::uint64_t pooled_bytes = 0;
    std::shared_ptr<CudaDevice> device;
    std::shared_ptr<CudaPool> pool;
};

void* pointer_of(Memory& memory) { return static_cast<CudaMemory&>(memory).buffer.get(); }

template <typename T>
T* pointer_as(Memory& memory) {
    return static_cast<T*>(pointer_of(memory));
}

}  // namespace

CudaQueue::CudaQueue(std::shared_ptr<CudaDevice> device, std::shared_ptr<CudaPool> pool)
    : device_(std::move(device)), pool_(std::move(pool)) {
    stages_.push_back({"other", 0, 0});
    select();
    try {
        check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream on " + device_->info().id);
        check(cudaHostAlloc(reinterpret_cast<void**>(&staging_), 2 * staging_bytes, cudaHostAllocDefault),
              "allocating pinned memory for transfers");
        for (cudaEvent_t& event : staged_)
            check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "making an event");
    } catch (...) {
        destroy();
        throw;
    }
}

CudaQueue::~CudaQueue() { destroy(); }

void CudaQueue::destroy() noexcept {
    check_noexcept(cudaSetDevice(device_->number()), "cudaSetDevice");
    if (stream_) check_noexcept(cudaStreamSynchronize(stream_), "cudaStreamSynchronize");
    for (const Interval& interval : intervals_)
        for (cudaEvent_t event : {interval.start, interval.end})
            check_noexcept(cudaEventDestroy(event), "cudaEventDestroy");
    for (cudaEvent_t event : spare_events_) check_noexcept(cudaEventDestroy(event), "cudaEventDestroy");
    for (cudaEvent_t event : staged_)
        if (event) check_noexcept(cudaEventDestroy(event), "cudaEventDestroy");
    if (staging_) check_noexcept(cudaFreeHost(staging_), "cudaFreeHost");
    if (stream_) check_noexcept(cudaStreamDestroy(stream_), "cudaStreamDestroy");
}

void CudaQueue::select() const { check(cudaSetDevice(device_->number()), "selecting " + device_->info().id); }

std::shared_ptr<Memory> CudaQueue::allocate(std::uint64_t size_bytes, std::string_view name) {
    const std::uint64_t pooled_bytes = CudaPool::pooled_size(size_bytes);
    device_->reserve(size_bytes, name);
    std::shared_ptr<CudaMemory> memory;
    try {
        memory = std::make_shared<CudaMemory>(size_bytes, std::string(name));
        if (auto pooled = pool_->take(pooled_bytes)) {
            memory->buffer = std::move(*pooled);
        } else {
            select();
            if (device_->in_use_bytes() + pool_->cached_bytes() > device_->options().memory_budget_bytes) pool_->clear();
            void* pointer = nullptr;
            cudaError_t code = cudaMalloc(&pointer, pooled_bytes);
            if (code == cudaErrorMemoryAllocation) {
                // Others may hold the card's memory; what is cached here helps first.
                (void)cudaGetLastError();
                pool_->clear();
                code = cudaMalloc(&pointer, pooled_bytes);
            }
            check(code, "allocating '" + std::string(name) + "' (" + std::to_string(size_bytes) + " bytes)");
            memory->buffer.reset(pointer);
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

std::shared_ptr<Memory> CudaQueue::wrap_host(void*, std::uint64_t, bool, std::string_view) { return nullptr; }

void CudaQueue::launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size, const Arguments& arguments) {
    const std::string what = std::string("launching ") + to_string(kernel);
    std::array<void*, Arguments::max_count> buffers{};
    std::array<void*, Arguments::max_count> pointers{};
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const Argument& argument = arguments[i];
        if (argument.value_bytes) {
            pointers[i] = const_cast<std::byte*>(argument.value.data());
        } else {
            buffers[i] = argument.memory ? pointer_of(*argument.memory) : nullptr;
            pointers[i] = &buffers[i];
        }
    }
    begin_interval();
    check(cudaLaunchKernel(cuda_kernel(kernel), dim3(group_count), dim3(group_size), pointers.data(), 0, stream_), what);
    end_interval(what);
    if (settings().log_launch) log_line(what + ", " + std::to_string(group_count) + " x " + std::to_string(group_size));
}

void CudaQueue::write(Memory& target, const void* source, std::uint64_t size_bytes) {
    select();
    const auto* from = static_cast<const std::byte*>(source);
    auto* to = pointer_as<std::byte>(target);
    for (std::size_t done = 0, half = 0; done < size_bytes; half ^= 1) {
        const std::size_t part = std::min<std::size_t>(staging_bytes, size_bytes - done);
        std::byte* staging = staging_ + half * staging_bytes;
        check(cudaEventSynchronize(staged_[half]), "writing '" + target.name() + "'");
        std::memcpy(staging, from + done, part);
        check(cudaMemcpyAsync(to + done, staging, part, cudaMemcpyHostToDevice, stream_),
              "writing '" + target.name() + "'");
        check(cudaEventRecord(staged_[half], stream_), "writing '" + target.name() + "'");
        done += part;
    }
}

void CudaQueue::read(Memory& source, void* target, std::uint64_t size_bytes) {
    select();
    const auto* from = pointer_as<const std::byte>(source);
    auto* to = static_cast<std::byte*>(target);
    const std::string what = "reading '" + source.name() + "'";
    const auto part_at = [&](std::size_t at) { return std::min<std::size_t>(staging_bytes, size_bytes - at); };
    const auto fetch = [&](std::size_t at, std::size_t half) {
        check(cudaMemcpyAsync(staging_ + half * staging_bytes, from + at, part_at(at), cudaMemcpyDeviceToHost, stream_),
              what);
        check(cudaEventRecord(staged_[half], stream_), what);
    };
    // While one half is copied out by the host, the device fills the other.
    if (size_bytes > 0) fetch(0, 0);
    for (std::size_t done = 0, half = 0; done < size_bytes; half ^= 1) {
        const std::size_t part = part_at(done);
        if (done + part < size_bytes) fetch(done + part, half ^ 1);
        check(cudaEventSynchronize(staged_[half]), what);
        std::memcpy(to + done, staging_ + half * staging_bytes, part);
        done += part;
    }
}

void CudaQueue::copy(Memory& source, Memory& target, std::uint64_t size_bytes) {
    select();
    check(cudaMemcpyAsync(pointer_of(target), pointer_of(source), size_bytes, cudaMemcpyDeviceToDevice, stream_),
          "copying '" + source.name() + "' to '" + target.name() + "'");
}

void CudaQueue::fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) {
    select();
    const std::string what = "filling '" + target.name() + "'";
    // cudaMemset repeats a byte; words go through pinned memory unless all their bytes are equal.
    if (pattern == (pattern & 0xffu) * 0x01010101u) {
        check(cudaMemsetAsync(pointer_of(target), static_cast<int>(pattern & 0xffu), size_bytes, stream_), what);
        return;
    }
    const std::vector<std::uint32_t> words(size_bytes / sizeof(pattern), pattern);
    write(target, words.data(), size_bytes);
}

void CudaQueue::finish() {
    select();
    check(cudaStreamSynchronize(stream_), "waiting for " + device_->info().id);
}

void CudaQueue::begin_stage(std::string_view stage) {
    const auto it = std::ranges::find(stages_, stage, &StageTime::stage);
    stage_ = static_cast<std::size_t>(it - stages_.begin());
    if (it == stages_.end()) stages_.push_back({std::string(stage), 0, 0});
}

cudaEvent_t CudaQueue::take_event() {
    cudaEvent_t event = nullptr;
    if (spare_events_.empty()) {
        check(cudaEventCreate(&event), "making an event");
    } else {
        event = spare_events_.back();
        spare_events_.pop_back();
    }
    return event;
}

void CudaQueue::begin_interval() {
    select();
    if (intervals_.size() >= max_pending_intervals) collect_events();
    intervals_.push_back({stage_, take_event(), take_event()});
    check(cudaEventRecord(intervals_.back().start, stream_), "recording an event");
}

void CudaQueue::end_interval(const std::string& what) {
    check(cudaEventRecord(intervals_.back().end, stream_), "recording an event");
    if (settings().synchronous) check(cudaStreamSynchronize(stream_), what);
}

void CudaQueue::collect_events() {
    finish();
    for (const Interval& interval : intervals_) {
        float time_ms = 0;
        check(cudaEventElapsedTime(&time_ms, interval.start, interval.end), "reading an event");
        stages_[interval.stage].time_ms += time_ms;
        ++stages_[interval.stage].launches;
        spare_events_.push_back(interval.start);
        spare_events_.push_back(interval.end);
    }
    intervals_.clear();
}

std::vector<StageTime> CudaQueue::take_timings() {
    collect_events();
    std::vector<StageTime> result;
    for (StageTime& stage : stages_) {
        if (stage.launches > 0) result.push_back(stage);
        stage.time_ms = 0;
        stage.launches = 0;
    }
    return result;
}

std::uint64_t CudaQueue::library_scan_bytes(std::uint32_t n) {
    select();
    std::size_t size_bytes = 0;
    check(cub_scan_bytes(n, &size_bytes), "asking CUB for the scratch of a scan");
    return size_bytes;
}

void CudaQueue::library_scan(Memory& counts, Memory& offsets, Memory& total, Memory& scratch, std::uint32_t n) {
    begin_interval();
    check(cub_scan(pointer_of(scratch), scratch.size_bytes(), pointer_as<std::uint32_t>(counts),
                   pointer_as<std::uint32_t>(offsets), pointer_as<std::uint64_t>(total), n, stream_),
          "scanning with CUB");
    end_interval("scanning with CUB");
}

std::uint64_t CudaQueue::library_sort_bytes(std::uint32_t n, std::uint32_t key_bits) {
    select();
    std::size_t size_bytes = 0;
    check(cub_sort_bytes(n, key_bits, &size_bytes), "asking CUB for the scratch of a sort");
    return size_bytes;
}

int CudaQueue::library_sort(const SortBuffers& buffers, std::uint32_t n, std::uint32_t key_bits) {
    std::uint32_t* const keys[2] = {pointer_as<std::uint32_t>(buffers.keys), pointer_as<std::uint32_t>(buffers.other_keys)};
    std::uint32_t* const values[2] = {pointer_as<std::uint32_t>(buffers.values),
                                      pointer_as<std::uint32_t>(buffers.other_values)};
    int selector = 0;
    begin_interval();
    check(cub_sort(pointer_of(buffers.scratch), buffers.scratch.size_bytes(), keys, values, n, key_bits, stream_,
                   &selector),
          "sorting with CUB");
    end_interval("sorting with CUB");
    return selector;
}

}  // namespace setka::backend
