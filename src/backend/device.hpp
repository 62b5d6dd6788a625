// SPDX-License-Identifier: MIT
/// What must a backend do? The seam: a device with its memory, and an in-order queue with a dozen verbs. Nothing above this
/// file knows an API, and nothing below it knows an algorithm.
#pragma once

#include <atomic>
#include <concepts>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/arguments.hpp"
#include "core/kernels.hpp"
#include "setka/device.hpp"

namespace setka::backend {

/// One allocation. Its destructor gives the bytes back to the pool of the queue it came from.
class Memory {
  public:
    Memory(std::uint64_t size_bytes, std::string name) : size_bytes_(size_bytes), name_(std::move(name)) {}
    virtual ~Memory() = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    [[nodiscard]] std::uint64_t size_bytes() const noexcept { return size_bytes_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }

  private:
    std::uint64_t size_bytes_;
    std::string name_;
};

/// Two pairs of buffers, the first with the pairs to sort, and scratch of library_sort_bytes.
struct SortBuffers {
    Memory& keys;
    Memory& values;
    Memory& other_keys;
    Memory& other_values;
    Memory& scratch;
};

/// A read that is on its way to host memory. Whoever destroys it waits, so that the memory may go afterwards; it may outlive its queue.
class PendingRead {
  public:
    PendingRead() = default;
    virtual ~PendingRead() = default;
    PendingRead(const PendingRead&) = delete;
    PendingRead& operator=(const PendingRead&) = delete;

    /// Whether wait() would not have to.
    [[nodiscard]] virtual bool is_ready() = 0;
    /// Waits until the bytes are there. Throws what failed on the device until then.
    virtual void wait() = 0;
};

class Queue {
  public:
    virtual ~Queue() = default;
    [[nodiscard]] virtual std::shared_ptr<Memory> allocate(std::uint64_t size_bytes, std::string_view name) = 0;
    /// Host memory as a device allocation where the two are one, else nullptr.
    [[nodiscard]] virtual std::shared_ptr<Memory> wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                                            std::string_view name) = 0;
    virtual void launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                        const Arguments& arguments) = 0;
    /// Copies `source`, which may be changed when the call returns, to `target` from byte `at` on.
    virtual void write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) = 0;
    virtual void read(Memory& source, void* target, std::uint64_t size_bytes) = 0;
    /// The same without waiting: `target` has to stay until the result was waited for or destroyed. `source` need not.
    [[nodiscard]] virtual std::unique_ptr<PendingRead> read_later(Memory& source, void* target,
                                                                  std::uint64_t size_bytes) = 0;
    virtual void copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
                      std::uint64_t size_bytes) = 0;
    virtual void fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) = 0;
    virtual void finish() = 0;
    /// Launches from here on count towards this stage of the timing table.
    virtual void begin_stage(std::string_view stage) = 0;
    /// Launches are timed from the first call on until stop_timings(), and not before: see setka::Queue.
    [[nodiscard]] virtual std::vector<StageTime> take_timings() = 0;
    virtual void stop_timings() = 0;

    /// So many words for what the groups of a launch count together (device/trace/params.h): each launch finds them at 0 and leaves them so, and what
    /// it hits depends on that: a queue is of no use after a launch that its device broke off. They belong to the queue, and to no budget. nullptr
    /// where the device's kernels have teams of one, which count nothing.
    static constexpr std::size_t launch_count_words = SK_LAUNCH_COUNTS;
    [[nodiscard]] virtual std::shared_ptr<Memory> launch_counts() { return nullptr; }

    // A backend may answer scan and sort with a well-kept library (PrimitiveShape::Library); the results have one right answer.
    // One without a library never resolves its options to that shape, and these are not called.

    /// Bytes of scratch that library_scan needs, at least 1.
    [[nodiscard]] virtual std::uint64_t library_scan_bytes(std::uint32_t n);
    /// offsets[i] = sum of counts before i for i <= n, modulo 2^32; total (one u64) = the sum.
    virtual void library_scan(Memory& counts, Memory& offsets, Memory& total, Memory& scratch, std::uint32_t n);
    [[nodiscard]] virtual std::uint64_t library_sort_bytes(std::uint32_t n, std::uint32_t key_bits);
    /// Stable sort by the lowest key_bits; returns 0 if the result is in the first pair of buffers, 1 if in the second.
    [[nodiscard]] virtual int library_sort(const SortBuffers& buffers, std::uint32_t n, std::uint32_t key_bits);

    // Cancellation is above the API: whoever enqueues asks before, and waits afterwards if there is anything to wait for.

    void set_stop_token(std::stop_token token) noexcept { stop_token_ = std::move(token); }
    [[nodiscard]] const std::stop_token& stop_token() const noexcept { return stop_token_; }
    /// Throws Cancelled if a stop was requested; `next` says what is not done any more, or makes a sentence of it when that is needed.
    void check_stop(std::string_view next) const;
    template <std::invocable What>
    void check_stop(const What& next) const {
        if (stop_token_.stop_requested()) check_stop(std::string(next()));
    }
    /// Waits for what was enqueued if a stop can be requested, so that no more than one launch lies between request and answer.
    void wait_if_stoppable() {
        if (stop_token_.stop_possible()) finish();
    }

  private:
    std::stop_token stop_token_;
};

class Device : public std::enable_shared_from_this<Device> {
  public:
    virtual ~Device() = default;
    [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;
    [[nodiscard]] virtual const DeviceOptions& options() const noexcept = 0;
    [[nodiscard]] virtual std::shared_ptr<Queue> make_queue() = 0;
    virtual void trim() = 0;
    /// SK_WIDTH of its kernels: how many rays a work-item traces side by side.
    [[nodiscard]] virtual std::uint32_t width() const noexcept { return 1; }
    /// SK_TEAM of its kernels: the size of the groups in which team kernels run, or 1 if they may have any.
    [[nodiscard]] virtual std::uint32_t team_size() const noexcept { return 1; }

    /// SK_DOUBLE of its kernels: whether they know doubles.
    [[nodiscard]] virtual bool has_doubles() const noexcept { return false; }

    /// What the probe found; set once, before the device is handed out.
    [[nodiscard]] const ParityReport& parity() const noexcept { return parity_; }
    void set_parity(ParityReport report) {
        parity_ = std::move(report);
        is_probed_ = true;
    }

    /// Counts bytes against the budget; throws OutOfMemory, with nothing counted, if they do not fit. The probe's own bytes
    /// always do: no budget keeps a device from being checked.
    void reserve(std::uint64_t size_bytes, std::string_view name);
    void release(std::uint64_t size_bytes) noexcept { in_use_bytes_ -= size_bytes; }
    [[nodiscard]] std::uint64_t in_use_bytes() const noexcept { return in_use_bytes_; }
    [[nodiscard]] std::uint64_t peak_bytes() const noexcept { return peak_bytes_; }
    /// Bytes of allocations that are larger than what was asked for.
    void add_slack(std::uint64_t size_bytes) noexcept { slack_bytes_ += size_bytes; }
    void remove_slack(std::uint64_t size_bytes) noexcept { slack_bytes_ -= size_bytes; }
    [[nodiscard]] std::uint64_t slack_bytes() const noexcept { return slack_bytes_; }
    void count_driver_allocation() noexcept { ++driver_allocations_; }
    [[nodiscard]] std::uint64_t driver_allocations() const noexcept { return driver_allocations_; }
    void reset_peak() noexcept { peak_bytes_ = in_use_bytes_.load(); }

  private:
    ParityReport parity_;
    bool is_probed_ = false;
    std::atomic<std::uint64_t> in_use_bytes_{0};
    std::atomic<std::uint64_t> peak_bytes_{0};
    std::atomic<std::uint64_t> slack_bytes_{0};
    std::atomic<std::uint64_t> driver_allocations_{0};
};

}  // namespace setka::backend
