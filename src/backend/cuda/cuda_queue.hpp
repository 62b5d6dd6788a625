// SPDX-License-Identifier: MIT
/// What does a queue mean in CUDA? A stream with its pool of buffers, pinned memory for transfers, and events for timing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backend/cuda/cuda_device.hpp"

namespace setka::backend {

class CudaQueue final : public Queue {
  public:
    CudaQueue(std::shared_ptr<CudaDevice> device, std::shared_ptr<CudaPool> pool);
    ~CudaQueue() override;

    [[nodiscard]] std::shared_ptr<Memory> allocate(std::uint64_t size_bytes, std::string_view name) override;
    [[nodiscard]] std::shared_ptr<Memory> wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                                    std::string_view name) override;
    void launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                const Arguments& arguments) override;
    void write(Memory& target, const void* source, std::uint64_t size_bytes) override;
    void read(Memory& source, void* target, std::uint64_t size_bytes) override;
    void copy(Memory& source, Memory& target, std::uint64_t size_bytes) override;
    void fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) override;
    void finish() override;
    void begin_stage(std::string_view stage) override;
    [[nodiscard]] std::vector<StageTime> take_timings() override;
    [[nodiscard]] std::uint64_t library_scan_bytes(std::uint32_t n) override;
    void library_scan(Memory& counts, Memory& offsets, Memory& total, Memory& scratch, std::uint32_t n) override;
    [[nodiscard]] std::uint64_t library_sort_bytes(std::uint32_t n, std::uint32_t key_bits) override;
    [[nodiscard]] int library_sort(const SortBuffers& buffers, std::uint32_t n, std::uint32_t key_bits) override;

  private:
    struct Interval {
        std::size_t stage;
        cudaEvent_t start, end;
    };

    void destroy() noexcept;
    void select() const;
    [[nodiscard]] cudaEvent_t take_event();
    void begin_interval();
    void end_interval(const std::string& what);
    void collect_events();

    std::shared_ptr<CudaDevice> device_;
    std::shared_ptr<CudaPool> pool_;
    cudaStream_t stream_ = nullptr;
    std::byte* staging_ = nullptr;  ///< pinned, two halves
    cudaEvent_t staged_[2] = {};    ///< when the half was last read or written by the device
    std::vector<StageTime> stages_;
    std::size_t stage_ = 0;
    std::vector<Interval> intervals_;
    std::vector<cudaEvent_t> spare_events_;
};

}  // namespace setka::backend
