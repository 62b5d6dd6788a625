// SPDX-License-Identifier: MIT
/// What does a queue mean in CUDA? A stream with its pool of buffers, pinned memory for transfers, and events that tell when.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backend/cuda/cuda_device.hpp"
#include "backend/stage_clock.hpp"
#include "backend/staging_ring.hpp"

namespace setka::backend {

/// Pinned memory that waits for the next read: two pictures of 3840 x 2160 pixels, linear and coded. To pin memory takes longer than to
/// fill it.
constexpr std::uint64_t most_cached_landing_bytes = std::uint64_t(256) << 20;

class CudaPendingRead;

class CudaQueue final : public Queue {
  public:
    CudaQueue(std::shared_ptr<CudaDevice> device, std::shared_ptr<CudaPool> pool, std::shared_ptr<CudaLandings> landings);
    ~CudaQueue() override;

    [[nodiscard]] std::shared_ptr<Memory> allocate(std::uint64_t size_bytes, std::string_view name) override;
    [[nodiscard]] std::shared_ptr<Memory> wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                                    std::string_view name) override;
    void launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                const Arguments& arguments) override;
    void write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) override;
    void read(Memory& source, void* target, std::uint64_t size_bytes) override;
    [[nodiscard]] std::unique_ptr<PendingRead> read_later(Memory& source, void* target,
                                                          std::uint64_t size_bytes) override;
    void copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
              std::uint64_t size_bytes) override;
    void fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) override;
    void finish() override;
    void begin_stage(std::string_view stage) override { clock_.begin_stage(stage); }
    [[nodiscard]] std::vector<StageTime> take_timings() override;
    void stop_timings() override;
    [[nodiscard]] std::shared_ptr<Memory> launch_counts() override { return launch_counts_; }
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
    /// Enqueues the copy of `source` from byte `at` on to pinned memory that `pending` empties.
    void read_piece(Memory& source, std::uint64_t at, std::uint64_t size_bytes, CudaPendingRead& pending);
    /// Calls enqueue(), which returns a code, between two events that time it if times are wanted. what() says what that is.
    template <typename What, typename Enqueue>
    void timed(const What& what, Enqueue enqueue);
    void collect_events();
    /// Its time in milliseconds; its events serve again.
    [[nodiscard]] double time_of(Span& span);

    std::shared_ptr<CudaDevice> device_;
    std::shared_ptr<CudaPool> pool_;
    std::shared_ptr<CudaLandings> landings_;
    CudaStream stream_;
    CudaPinned staging_;  ///< of writes
    StagingRing<CudaEvent> staged_;
    StageClock<Span> clock_;
    std::vector<CudaEvent> spare_events_;
    std::shared_ptr<Memory> launch_counts_;
};

}  // namespace setka::backend
