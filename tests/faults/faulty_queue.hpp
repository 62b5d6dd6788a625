// SPDX-License-Identifier: MIT
/// What if the n-th step of a piece of work fails? A queue in front of a real one, which counts what is asked
/// of it and fails where it is told to. It is made in tests alone; the library has no hook.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "backend/device.hpp"

namespace faults {

/// What a queue can be asked for that may fail.
enum class Step {
    Allocate,
    Wrap,
    Launch,
    Write,
    Read,    ///< when it is asked for, with waiting or without
    Arrive,  ///< a read that was asked for without waiting, when somebody waits for it
    Copy,
    Fill
};
inline constexpr Step all_steps[] = {Step::Allocate, Step::Wrap,   Step::Launch, Step::Write,
                                     Step::Read,     Step::Arrive, Step::Copy,   Step::Fill};

[[nodiscard]] const char* to_string(Step step) noexcept;

enum class Persistence {
    Once,    ///< only that step fails
    Onward,  ///< every later one of its kind as well
};

class FaultyQueue final : public setka::backend::Queue, public std::enable_shared_from_this<FaultyQueue> {
  public:
    FaultyQueue(setka::Device device, std::shared_ptr<setka::backend::Queue> real)
        : device_(std::move(device)), real_(std::move(real)) {}

    /// The number-th `step` from here on (1 is the next) fails: an allocation as if the device's budget were
    /// used up, by the library's own check; anything else as if the driver had failed.
    void fail(Step step, std::uint32_t number, Persistence persistence = Persistence::Once);
    /// Calls `action` just before the number-th `step` from here on, which then goes on.
    void before(Step step, std::uint32_t number, std::function<void()> action);
    /// From here on, calls `action` with the real queue instead of launching this kernel.
    using Launch = std::function<void(setka::backend::Queue& real, std::uint32_t group_count, std::uint32_t group_size,
                                      const setka::Arguments& arguments)>;
    void instead_of(setka::Kernel kernel, Launch action) { replaced_ = {kernel, std::move(action)}; }
    /// Nothing fails and nothing is called any more.
    void heal() {
        fault_.reset();
        replaced_.reset();
    }
    /// Whether the step that was to fail, or before which something was to be called, has come.
    [[nodiscard]] bool has_failed() const { return has_failed_; }
    /// The name of the buffer, or of the kernel, whose step failed last.
    [[nodiscard]] const std::string& failed_name() const { return failed_name_; }
    /// Kernels that were launched since the last fail() or before().
    [[nodiscard]] std::uint32_t launches() const { return launches_; }
    /// Bytes that went from the host to the device so far.
    [[nodiscard]] std::uint64_t written_bytes() const { return written_bytes_; }
    /// How often somebody waited for the device so far: to read, to finish, to take times.
    [[nodiscard]] std::uint32_t waits() const { return waits_; }
    /// Whether every kernel that was launched has been waited for.
    [[nodiscard]] bool is_idle() const { return waited_for_ == launched_; }

    [[nodiscard]] std::shared_ptr<setka::backend::Memory> allocate(std::uint64_t size_bytes,
                                                                   std::string_view name) override;
    [[nodiscard]] std::shared_ptr<setka::backend::Memory> wrap_host(void* data, std::uint64_t size_bytes,
                                                                    bool read_only,
                                                                    std::string_view name) override;
    void launch(setka::Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                const setka::Arguments& arguments) override;
    void write(setka::backend::Memory& target, std::uint64_t at, const void* source,
               std::uint64_t size_bytes) override;
    void read(setka::backend::Memory& source, void* target, std::uint64_t size_bytes) override;
    [[nodiscard]] std::unique_ptr<setka::backend::PendingRead> read_later(setka::backend::Memory& source, void* target,
                                                                          std::uint64_t size_bytes) override;
    void copy(setka::backend::Memory& source, std::uint64_t source_at, setka::backend::Memory& target,
              std::uint64_t target_at, std::uint64_t size_bytes) override;
    void fill(setka::backend::Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) override;
    void finish() override;
    void begin_stage(std::string_view stage) override { real_->begin_stage(stage); }
    [[nodiscard]] std::vector<setka::StageTime> take_timings() override {
        ++waits_;
        return real_->take_timings();
    }
    void stop_timings() override {
        ++waits_;
        real_->stop_timings();
    }
    [[nodiscard]] std::shared_ptr<setka::backend::Memory> launch_counts() override { return real_->launch_counts(); }
    [[nodiscard]] std::uint64_t library_scan_bytes(std::uint32_t n) override {
        return real_->library_scan_bytes(n);
    }
    void library_scan(setka::backend::Memory& counts, setka::backend::Memory& offsets,
                      setka::backend::Memory& total, setka::backend::Memory& scratch,
                      std::uint32_t n) override;
    [[nodiscard]] std::uint64_t library_sort_bytes(std::uint32_t n, std::uint32_t key_bits) override {
        return real_->library_sort_bytes(n, key_bits);
    }
    [[nodiscard]] int library_sort(const setka::backend::SortBuffers& buffers, std::uint32_t n,
                                   std::uint32_t key_bits) override;

  private:
    class PendingRead;
    struct Fault {
        Step step;
        std::uint32_t steps_left;
        Persistence persistence;
        std::function<void()> action;  ///< instead of a failure
    };

    /// Counts a step; true if it has to fail.
    [[nodiscard]] bool is_due(Step step, std::string_view name);
    /// The same, and throws as a driver's failure would.
    void fail_if_due(Step step, std::string_view name);

    setka::Device device_;
    std::shared_ptr<setka::backend::Queue> real_;
    std::optional<Fault> fault_;
    bool has_failed_ = false;
    std::uint32_t launches_ = 0;
    std::uint32_t waits_ = 0;
    std::optional<std::pair<setka::Kernel, Launch>> replaced_;
    std::uint64_t launched_ = 0, waited_for_ = 0;  ///< kernels, in all
    std::uint64_t written_bytes_ = 0;
    std::string failed_name_;
};

/// A queue on `device` whose steps can be made to fail.
struct FaultyPair {
    std::shared_ptr<FaultyQueue> faults;
    setka::Queue queue;
};
[[nodiscard]] FaultyPair make_faulty_queue(const setka::Device& device);

}  // namespace faults
