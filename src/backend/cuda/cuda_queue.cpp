// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_queue.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "backend/cuda/kernel_table.hpp"
#include "backend/pooled_memory.hpp"
#include "core/settings.hpp"

namespace setka::backend {

namespace {

/// Pinned memory for transfers, one of two halves: large enough for full speed, small enough to have always.
constexpr std::size_t staging_bytes = std::size_t(8) << 20;

using CudaMemory = PooledMemory<CudaBuffer>;

void* pointer_of(Memory& memory) { return static_cast<CudaMemory&>(memory).buffer.get(); }

template <typename T>
T* pointer_as(Memory& memory) {
    return static_cast<T*>(pointer_of(memory));
}

}  // namespace

CudaQueue::CudaQueue(std::shared_ptr<CudaDevice> device, std::shared_ptr<CudaPool> pool)
    : device_(std::move(device)), pool_(std::move(pool)) {
    select();
    cudaStream_t stream = nullptr;
    check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "making a stream on " + device_->info().id);
    stream_.reset(stream);
    void* staging = nullptr;
    check(cudaHostAlloc(&staging, 2 * staging_bytes, cudaHostAllocDefault),
          "allocating " + std::to_string(2 * staging_bytes) + " bytes of pinned host memory for transfers");
    staging_.reset(static_cast<std::byte*>(staging));
    for (CudaEvent& staged : staged_) {
        cudaEvent_t event = nullptr;
        check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "making an event");
        staged.reset(event);
    }
}

CudaQueue::~CudaQueue() {
    check_noexcept(cudaSetDevice(device_->number()), "cudaSetDevice");
    check_noexcept(cudaStreamSynchronize(stream_.get()), "cudaStreamSynchronize");
}

void CudaQueue::select() const { check(cudaSetDevice(device_->number()), "selecting " + device_->info().id); }

std::shared_ptr<Memory> CudaQueue::allocate(std::uint64_t size_bytes, std::string_view name) {
    const std::string what = "allocating '" + std::string(name) + "' (" + std::to_string(size_bytes) + " bytes)";
    return allocate_pooled<CudaMemory>(device_, pool_, size_bytes, name, [&](std::uint64_t pooled_bytes) {
        select();
        void* pointer = nullptr;
        check(cudaMalloc(&pointer, pooled_bytes), what);
        return CudaBuffer(pointer);
    });
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
    timed(what, [&] {
        return cudaLaunchKernel(cuda_kernel(kernel), dim3(group_count), dim3(group_size), pointers.data(), 0,
                                stream_.get());
    });
    if (settings().log_launch) log_line(what + ", " + std::to_string(group_count) + " x " + std::to_string(group_size));
}

void CudaQueue::write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) {
    select();
    const auto* from = static_cast<const std::byte*>(source);
    auto* to = pointer_as<std::byte>(target) + at;
    for (std::size_t done = 0, half = 0; done < size_bytes; half ^= 1) {
        const std::size_t part = std::min<std::size_t>(staging_bytes, size_bytes - done);
        std::byte* staging = staging_.get() + half * staging_bytes;
        check(cudaEventSynchronize(staged_[half].get()), "writing '" + target.name() + "'");
        std::memcpy(staging, from + done, part);
        check(cudaMemcpyAsync(to + done, staging, part, cudaMemcpyHostToDevice, stream_.get()),
              "writing '" + target.name() + "'");
        check(cudaEventRecord(staged_[half].get(), stream_.get()), "writing '" + target.name() + "'");
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
        check(cudaMemcpyAsync(staging_.get() + half * staging_bytes, from + at, part_at(at), cudaMemcpyDeviceToHost,
                              stream_.get()),
              what);
        check(cudaEventRecord(staged_[half].get(), stream_.get()), what);
    };
    // While one half is copied out by the host, the device fills the other.
    if (size_bytes > 0) fetch(0, 0);
    for (std::size_t done = 0, half = 0; done < size_bytes; half ^= 1) {
        const std::size_t part = part_at(done);
        if (done + part < size_bytes) fetch(done + part, half ^ 1);
        check(cudaEventSynchronize(staged_[half].get()), what);
        std::memcpy(to + done, staging_.get() + half * staging_bytes, part);
        done += part;
    }
}

void CudaQueue::copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
                     std::uint64_t size_bytes) {
    select();
    check(cudaMemcpyAsync(pointer_as<std::byte>(target) + target_at, pointer_as<std::byte>(source) + source_at, size_bytes,
                          cudaMemcpyDeviceToDevice, stream_.get()),
          "copying '" + source.name() + "' to '" + target.name() + "'");
}

void CudaQueue::fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) {
    select();
    const std::string what = "filling '" + target.name() + "'";
    // cudaMemset repeats a byte; words go through pinned memory unless all their bytes are equal.
    if (pattern == (pattern & 0xffu) * 0x01010101u) {
        check(cudaMemsetAsync(pointer_of(target), static_cast<int>(pattern & 0xffu), size_bytes, stream_.get()), what);
        return;
    }
    const std::vector<std::uint32_t> words(size_bytes / sizeof(pattern), pattern);
    write(target, 0, words.data(), size_bytes);
}

void CudaQueue::finish() {
    select();
    check(cudaStreamSynchronize(stream_.get()), "waiting for " + device_->info().id);
}

std::vector<StageTime> CudaQueue::take_timings() {
    collect_events();
    return clock_.take_timings();
}

void CudaQueue::collect_events() {
    finish();
    clock_.collect([&](Span& span) {
        float time_ms = 0;
        check(cudaEventElapsedTime(&time_ms, span.start.get(), span.end.get()), "reading an event");
        spare_events_.push_back(std::move(span.start));
        spare_events_.push_back(std::move(span.end));
        return static_cast<double>(time_ms);
    });
}

CudaEvent CudaQueue::take_event() {
    if (!spare_events_.empty()) {
        CudaEvent event = std::move(spare_events_.back());
        spare_events_.pop_back();
        return event;
    }
    cudaEvent_t event = nullptr;
    check(cudaEventCreate(&event), "making an event");
    return CudaEvent(event);
}

template <typename Enqueue>
void CudaQueue::timed(const std::string& what, Enqueue enqueue) {
    select();
    Span span{take_event(), take_event()};
    check(cudaEventRecord(span.start.get(), stream_.get()), "recording an event");
    check(enqueue(), what);
    check(cudaEventRecord(span.end.get(), stream_.get()), "recording an event");
    clock_.add(std::move(span));
    if (settings().synchronous) check(cudaStreamSynchronize(stream_.get()), what);
    if (clock_.is_full()) collect_events();
}

std::uint64_t CudaQueue::library_scan_bytes(std::uint32_t n) {
    select();
    std::size_t size_bytes = 0;
    check(cub_scan_bytes(n, &size_bytes), "asking CUB for the scratch of a scan");
    return size_bytes;
}

void CudaQueue::library_scan(Memory& counts, Memory& offsets, Memory& total, Memory& scratch, std::uint32_t n) {
    timed("scanning with CUB", [&] {
        return cub_scan(pointer_of(scratch), scratch.size_bytes(), pointer_as<std::uint32_t>(counts),
                        pointer_as<std::uint32_t>(offsets), pointer_as<std::uint64_t>(total), n, stream_.get());
    });
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
    timed("sorting with CUB", [&] {
        return cub_sort(pointer_of(buffers.scratch), buffers.scratch.size_bytes(), keys, values, n, key_bits,
                        stream_.get(), &selector);
    });
    return selector;
}

}  // namespace setka::backend
