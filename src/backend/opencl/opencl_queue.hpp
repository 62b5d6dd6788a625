// SPDX-License-Identifier: MIT
/// What does a queue mean in OpenCL? An in-order command queue, or another one with profiling when times are wanted, its kernel objects, its pool
/// of buffers, and host memory for writes that are on their way.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backend/opencl/opencl_device.hpp"
#include "backend/stage_clock.hpp"
#include "backend/staging_ring.hpp"

namespace setka::backend {

class OpenClQueue final : public Queue {
  public:
    OpenClQueue(std::shared_ptr<OpenClDevice> device, std::shared_ptr<OpenClPool> pool);
    ~OpenClQueue() override;

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

  private:
    void collect_events();
    /// Everything that was enqueued is done: staged writes that failed tell so now.
    void note_idle();
    void write_staged(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes);
    /// Reads few bytes into memory that the device reaches by itself. Throws cl::Error.
    void read_few(const cl::Buffer& source, void* target, std::uint64_t size_bytes);

    std::shared_ptr<OpenClDevice> device_;
    std::shared_ptr<OpenClPool> pool_;
    cl::CommandQueue untimed_, timed_;  ///< whether it profiles belongs to a command queue; the second is made when it is first needed
    cl::CommandQueue queue_;            ///< where commands go: one of the two. The other has nothing to do
    std::vector<cl::Kernel> kernels_;
    StageClock<cl::Event> clock_;
    std::unique_ptr<std::byte[]> staging_;  ///< made when it is first needed
    StagingRing<cl::Event> staged_;
    cl::Buffer answer_;  ///< for read_few(), made when it is first needed; mapped for good
    void* answer_bytes_ = nullptr;
    std::shared_ptr<Memory> launch_counts_;
    bool is_idle_ = true;  ///< nothing was enqueued since something waited for all there was
};

}  // namespace setka::backend
