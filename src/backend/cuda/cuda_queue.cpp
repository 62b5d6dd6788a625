// SPDX-License-Identifier: MIT
#include "backend/cuda/cuda_queue.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <deque>

#include "backend/cuda/kernel_table.hpp"
#include "backend/pooled_memory.hpp"
#include "core/settings.hpp"

namespace setka::backend {

namespace {

/// Pinned memory for writes that the device has yet to make: the vertices of a million that move, with normals, without waiting.
constexpr std::size_t staging_bytes = std::size_t(32) << 20;
/// Transfers go in pieces: large enough for full speed, small enough that the host copies one while the device copies another.
constexpr std::size_t piece_bytes = std::size_t(8) << 20;
/// The least that is pinned for a read: pieces are powers of two from here on, so that few sizes serve all.
constexpr std::uint64_t least_landing_bytes = std::uint64_t(64) << 10;

using CudaMemory = PooledMemory<CudaBuffer>;

void* pointer_of(Memory& memory) { return static_cast<CudaMemory&>(memory).buffer.get(); }

template <typename T>
T* pointer_as(Memory& memory) {
    return static_cast<T*>(pointer_of(memory));
}

/// An event that only tells that the device has come so far.
CudaEvent make_event() {
    cudaEvent_t event = nullptr;
    check(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "making an event");
    return CudaEvent(event);
}

CudaPinned make_pinned(std::uint64_t size_bytes) {
    void* pinned = nullptr;
    check(cudaHostAlloc(&pinned, size_bytes, cudaHostAllocDefault),
          "allocating " + std::to_string(size_bytes) + " bytes of pinned host memory for transfers");
    return CudaPinned(static_cast<std::byte*>(pinned));
}

bool has_ended(const CudaEvent& event, const std::string& what) {
    const cudaError_t code = cudaEventQuery(event.get());
    if (code != cudaErrorNotReady) check(code, what);
    else (void)cudaGetLastError();  // it is no error, but kept as one
    return code != cudaErrorNotReady;
}

}  // namespace

/// The device writes pinned memory, from where wait() copies on, piece by piece.
class CudaPendingRead final : public PendingRead {
  public:
    CudaPendingRead(std::string what, void* target, std::shared_ptr<CudaLandings> landings)
        : what_(std::move(what)), target_(static_cast<std::byte*>(target)), landings_(std::move(landings)) {}
    ~CudaPendingRead() override {
        for (Piece& piece : pieces_) {
            check_noexcept(cudaEventSynchronize(piece.landing.written.get()), "cudaEventSynchronize");
            landings_->give(piece.landing_bytes, std::move(piece.landing));
        }
    }

    [[nodiscard]] const std::string& what() const noexcept { return what_; }
    [[nodiscard]] std::size_t pieces() const noexcept { return pieces_.size(); }

    /// Pinned memory for the next piece.
    [[nodiscard]] const CudaLanding& add_piece(std::uint64_t size_bytes) {
        const std::uint64_t landing_bytes = std::max(std::bit_ceil(size_bytes), least_landing_bytes);
        auto pooled = landings_->take(landing_bytes);
        pieces_.push_back({size_bytes, landing_bytes,
                           pooled ? std::move(pooled->handle) : CudaLanding{make_pinned(landing_bytes), make_event()}});
        return pieces_.back().landing;
    }
    void wait_for_oldest() {
        Piece& piece = pieces_.front();
        check(cudaEventSynchronize(piece.landing.written.get()), what_);
        std::memcpy(target_, piece.landing.memory.get(), piece.size_bytes);
        target_ += piece.size_bytes;
        landings_->give(piece.landing_bytes, std::move(piece.landing));
        pieces_.pop_front();
    }

    [[nodiscard]] bool is_ready() override {
        // A failure is something that wait() tells without waiting.
        const cudaError_t code = pieces_.empty() ? cudaSuccess : cudaEventQuery(pieces_.back().landing.written.get());
        if (code == cudaErrorNotReady) (void)cudaGetLastError();
        return code != cudaErrorNotReady;
    }
    void wait() override {
        while (!pieces_.empty()) wait_for_oldest();
    }

  private:
    struct Piece {
        std::uint64_t size_bytes, landing_bytes;
        CudaLanding landing;
    };

    std::string what_;
    std::byte* target_;  ///< of the oldest piece
    std::shared_ptr<CudaLandings> landings_;
    std::deque<Piece> pieces_;
};

CudaQueue::CudaQueue(std::shared_ptr<CudaDevice> device, std::shared_ptr<CudaPool> pool, std::shared_ptr<CudaLandings> landings)
    : device_(std::move(device)), pool_(std::move(pool)), landings_(std::move(landings)), staged_(staging_bytes) {
    select();
    cudaStream_t stream = nullptr;
    check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "making a stream on " + device_->info().id);
    stream_.reset(stream);
    staging_ = make_pinned(staging_bytes);
    auto counts = std::make_shared<CudaMemory>(launch_count_words * sizeof(std::uint32_t), "launch counts");
    void* pointer = nullptr;
    check(cudaMalloc(&pointer, counts->size_bytes()), "making a queue on " + device_->info().id);
    counts->buffer.reset(pointer);
    fill(*counts, 0, counts->size_bytes());
    launch_counts_ = std::move(counts);
}

CudaQueue::~CudaQueue() {
    check_noexcept(cudaSetDevice(device_->number()), "cudaSetDevice");
    check_noexcept(cudaStreamSynchronize(stream_.get()), "cudaStreamSynchronize");
}

void CudaQueue::select() const {
    check(cudaSetDevice(device_->number()), [&] { return "selecting " + device_->info().id; });
}

std::shared_ptr<Memory> CudaQueue::allocate(std::uint64_t size_bytes, std::string_view name) {
    const auto what = [&] { return "allocating '" + std::string(name) + "' (" + std::to_string(size_bytes) + " bytes)"; };
    return allocate_pooled<CudaMemory>(device_, pool_, size_bytes, name, [&](std::uint64_t pooled_bytes) {
        select();
        void* pointer = nullptr;
        check(cudaMalloc(&pointer, pooled_bytes), what);
        return CudaBuffer(pointer);
    });
}

std::shared_ptr<Memory> CudaQueue::wrap_host(void*, std::uint64_t, bool, std::string_view) { return nullptr; }

void CudaQueue::launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size, const Arguments& arguments) {
    const auto what = [&] { return std::string("launching ") + to_string(kernel); };
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
    if (settings().log_launch) log_line(what() + ", " + std::to_string(group_count) + " x " + std::to_string(group_size));
}

void CudaQueue::write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) {
    select();
    const std::string what = "writing '" + target.name() + "'";
    const auto* from = static_cast<const std::byte*>(source);
    auto* to = pointer_as<std::byte>(target) + at;
    const auto has_read = [&](const CudaEvent& event) { return has_ended(event, what); };
    const auto wait = [&](const CudaEvent& oldest) { check(cudaEventSynchronize(oldest.get()), what); };
    for (std::size_t done = 0, part = 0; done < size_bytes; done += part) {
        part = std::min<std::size_t>(piece_bytes, size_bytes - done);
        staged_.use(part, has_read, wait, [&](std::size_t place) {
            CudaEvent event = make_event();
            std::memcpy(staging_.get() + place, from + done, part);
            check(cudaMemcpyAsync(to + done, staging_.get() + place, part, cudaMemcpyHostToDevice, stream_.get()), what);
            check(cudaEventRecord(event.get(), stream_.get()), what);
            return event;
        });
    }
}

void CudaQueue::read_piece(Memory& source, std::uint64_t at, std::uint64_t size_bytes, CudaPendingRead& pending) {
    const CudaLanding& landing = pending.add_piece(size_bytes);
    check(cudaMemcpyAsync(landing.memory.get(), pointer_as<const std::byte>(source) + at, size_bytes,
                          cudaMemcpyDeviceToHost, stream_.get()),
          pending.what());
    check(cudaEventRecord(landing.written.get(), stream_.get()), pending.what());
}

void CudaQueue::read(Memory& source, void* target, std::uint64_t size_bytes) {
    select();
    CudaPendingRead pending("reading '" + source.name() + "'", target, landings_);
    // While the host copies one piece, the device fills another; a large table never needs more pinned memory than two.
    for (std::uint64_t at = 0; at < size_bytes; at += piece_bytes) {
        read_piece(source, at, std::min<std::uint64_t>(piece_bytes, size_bytes - at), pending);
        if (pending.pieces() == 2) pending.wait_for_oldest();
    }
    pending.wait();
}

std::unique_ptr<PendingRead> CudaQueue::read_later(Memory& source, void* target, std::uint64_t size_bytes) {
    select();
    auto pending = std::make_unique<CudaPendingRead>("reading '" + source.name() + "'", target, landings_);
    for (std::uint64_t at = 0; at < size_bytes; at += piece_bytes)
        read_piece(source, at, std::min<std::uint64_t>(piece_bytes, size_bytes - at), *pending);
    return pending;
}

void CudaQueue::copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
                     std::uint64_t size_bytes) {
    select();
    check(cudaMemcpyAsync(pointer_as<std::byte>(target) + target_at, pointer_as<std::byte>(source) + source_at, size_bytes,
                          cudaMemcpyDeviceToDevice, stream_.get()),
          [&] { return "copying '" + source.name() + "' to '" + target.name() + "'"; });
}

void CudaQueue::fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) {
    select();
    const auto what = [&] { return "filling '" + target.name() + "'"; };
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
    check(cudaStreamSynchronize(stream_.get()), [&] { return "waiting for " + device_->info().id; });
}

std::vector<StageTime> CudaQueue::take_timings() {
    collect_events();
    clock_.start();
    return clock_.take_timings();
}

void CudaQueue::stop_timings() {
    if (!clock_.is_running()) return;
    (void)take_timings();
    clock_.stop();
}

void CudaQueue::collect_events() {
    finish();
    clock_.collect([&](Span& span) { return time_of(span); });
}

double CudaQueue::time_of(Span& span) {
    float time_ms = 0;
    check(cudaEventElapsedTime(&time_ms, span.start.get(), span.end.get()), "reading an event");
    spare_events_.push_back(std::move(span.start));
    spare_events_.push_back(std::move(span.end));
    return static_cast<double>(time_ms);
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

template <typename What, typename Enqueue>
void CudaQueue::timed(const What& what, Enqueue enqueue) {
    select();
    if (clock_.is_running()) {
        const auto record = [&](const CudaEvent& event) {
            check(cudaEventRecord(event.get(), stream_.get()), [] { return "recording an event"; });
        };
        Span span{take_event(), take_event()};
        record(span.start);
        check(enqueue(), what);
        record(span.end);
        clock_.add(std::move(span));
    } else {
        check(enqueue(), what);
    }
    if (settings().synchronous) check(cudaStreamSynchronize(stream_.get()), what);
    if (clock_.is_full())
        clock_.collect_older([](Span& last) { check(cudaEventSynchronize(last.end.get()), "waiting for an event"); },
                             [&](Span& old) { return time_of(old); });
}

std::uint64_t CudaQueue::library_scan_bytes(std::uint32_t n) {
    select();
    std::size_t size_bytes = 0;
    check(cub_scan_bytes(n, &size_bytes), "asking CUB for the scratch of a scan");
    return size_bytes;
}

void CudaQueue::library_scan(Memory& counts, Memory& offsets, Memory& total, Memory& scratch, std::uint32_t n) {
    timed([] { return "scanning with CUB"; }, [&] {
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
    timed([] { return "sorting with CUB"; }, [&] {
        return cub_sort(pointer_of(buffers.scratch), buffers.scratch.size_bytes(), keys, values, n, key_bits,
                        stream_.get(), &selector);
    });
    return selector;
}

}  // namespace setka::backend
