// SPDX-License-Identifier: MIT
/// What does a queue mean in CUDA? A stream with its pool of buffers, pinned memory for transfers, and events for timing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backend/cuda/cuda_device.hpp"
#include "backend/stage_clock.hpp"

namespace setka::backend {

/// Owners of a stream, an event and pinned host memory.
struct CudaDestroy {
    void operator()(cudaStream_t stream) const noexcept { check_noexcept(cudaStreamDestroy(stream), "cudaStreamDestroy"); }
    void operator()(cudaEvent_t event) const noexcept { check_noexcept(cudaEventDestroy(event), "cudaEventDestroy"); }
    void operator()(std::byte* pinned) const noexcept { check_noexcept(cudaFreeHost(pinned), "cudaFreeHost"); }
};
using CudaStream = std::unique_ptr<CUstream_st, CudaDestroy>;
using CudaEvent = std::unique_ptr<CUevent_st, CudaDestroy>;
using CudaPinned = std::unique_ptr<std::byte, CudaDestroy>;

class CudaQueue final : public Queue {
  public:
    CudaQueue(std::shared_ptr<CudaDevice> device, std::shared_ptr<CudaPool> pool);
    ~CudaQueue() override;

    [[nodiscard]] std::shared_ptr<Memory> allocate(std::uint64_t size_bytes, std::string_view name) override;
    [[nodiscard]] std::shared_ptr<Memory> wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                                    std::string_view name) override;
    void launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                const Arguments& arguments) override;
    void write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) override;
    void read(Memory& source, void* target, std::uint64_t size_bytes) override;
    void copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
              std::uint64_t size_bytes) override;
    void fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) override;
    void finish() override;
    void begin_stage(std::string_view stage) override { clock_.begin_stage(stage); }
    [[nodiscard]] std::vector<StageTime> take_timings() override;
    [[nodiscard]] std::uint64_t library_scan_bytes(std::uint32_t n) override;
    void library_scan(Memory& counts, Memory& offsets, Memory& total, Memory& scratch, std::uint32_t n) override;
    [[nodiscard]] std::uint64_t library_sort_bytes(std::uint32_t n, std::uint32_t key_bits) override;
    [[nodiscard]] int library_sort(const SortBuffers& buffers, std::uint32_t n, std::uint32_t key_bits) override;

  private:
    /// What lies between two events of the stream.
    struct Span {
        CudaEvent start, end;
    };

    void select() const;
    [[nodiscard]] CudaEvent take_event();
    /// Calls enqueue(), which returns a code, between two events that time it.
    template <typename Enqueue>
    void timed(const std::string& what, Enqueue enqueue);
    void collect_events();

    std::shared_ptr<CudaDevice> device_;
    std::shared_ptr<CudaPool> pool_;
    CudaStream stream_;
    CudaPinned staging_;   ///< pinned, two halves
    CudaEvent staged_[2];  ///< when the half was last read or written by the device
    StageClock<Span> clock_;
    std::vector<CudaEvent> spare_events_;
};

}  // namespace setka::backend
