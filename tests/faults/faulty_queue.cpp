// SPDX-License-Identifier: MIT
/// How is a failure made? See the header.
#include "faults/faulty_queue.hpp"

#include <algorithm>

#include "setka/error.hpp"

namespace faults {

using setka::backend::Memory;

const char* to_string(Step step) noexcept {
    switch (step) {
        case Step::Allocate:
            return "allocation";
        case Step::Wrap:
            return "wrapping";
        case Step::Launch:
            return "launch";
        case Step::Write:
            return "write";
        case Step::Read:
            return "read";
        case Step::Arrive:
            return "arrival";
        case Step::Copy:
            return "copy";
        case Step::Fill:
            return "fill";
    }
    return "unknown";
}

void FaultyQueue::fail(Step step, std::uint32_t number, Persistence persistence) {
    fault_ = {step, number, persistence, {}};
    has_failed_ = false;
    launches_ = 0;
}

void FaultyQueue::before(Step step, std::uint32_t number, std::function<void()> action) {
    fail(step, number);
    fault_->action = std::move(action);
}

bool FaultyQueue::is_due(Step step, std::string_view name) {
    if (!fault_ || fault_->step != step) return false;
    if (fault_->steps_left > 0) --fault_->steps_left;
    if (fault_->steps_left > 0) return false;
    has_failed_ = true;
    failed_name_ = name;
    const std::function<void()> action = fault_->action;
    if (fault_->persistence == Persistence::Once) fault_.reset();
    if (action) action();
    return !action;
}

void FaultyQueue::fail_if_due(Step step, std::string_view name) {
    if (is_due(step, name))
        throw setka::Error(setka::ErrorCategory::DeviceFailed,
                           std::string(to_string(step)) + " of '" + std::string(name) + "' was made to fail");
}

std::shared_ptr<Memory> FaultyQueue::allocate(std::uint64_t size_bytes, std::string_view name) {
    if (!is_due(Step::Allocate, name)) return real_->allocate(size_bytes, name);
    // Something else takes all that the budget leaves, so that what fails is the real allocation, with its
    // own error.
    setka::backend::Device& device = *device_.impl();
    const std::uint64_t rest = device.options().memory_budget_bytes - device.in_use_bytes();
    device.reserve(rest, "everything else");
    try {
        auto memory = real_->allocate(size_bytes, name);
        device.release(rest);
        return memory;  // the budget is not kept: the test says so, since nothing fails
    } catch (...) {
        device.release(rest);
        throw;
    }
}

std::shared_ptr<Memory> FaultyQueue::wrap_host(void* data, std::uint64_t size_bytes, bool read_only,
                                               std::string_view name) {
    fail_if_due(Step::Wrap, name);
    return real_->wrap_host(data, size_bytes, read_only, name);
}

void FaultyQueue::launch(setka::Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                         const setka::Arguments& arguments) {
    fail_if_due(Step::Launch, to_string(kernel));
    ++launched_;
    ++launches_;
    if (replaced_ && replaced_->first == kernel)
        replaced_->second(*real_, group_count, group_size, arguments);
    else
        real_->launch(kernel, group_count, group_size, arguments);
}

void FaultyQueue::write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) {
    fail_if_due(Step::Write, target.name());
    real_->write(target, at, source, size_bytes);
    written_bytes_ += size_bytes;
}

void FaultyQueue::read(Memory& source, void* target, std::uint64_t size_bytes) {
    fail_if_due(Step::Read, source.name());
    ++waits_;
    real_->read(source, target, size_bytes);
    waited_for_ = launched_;
}

/// Asks the queue, while there is one, whether it is to fail.
class FaultyQueue::PendingRead final : public setka::backend::PendingRead {
  public:
    PendingRead(std::weak_ptr<FaultyQueue> queue, std::string name,
                std::unique_ptr<setka::backend::PendingRead> real, std::uint64_t launched)
        : queue_(std::move(queue)), name_(std::move(name)), real_(std::move(real)), launched_(launched) {}

    [[nodiscard]] bool is_ready() override { return real_->is_ready(); }
    void wait() override {
        const auto queue = queue_.lock();
        if (queue) {
            ++queue->waits_;
            queue->fail_if_due(Step::Arrive, name_);
        }
        real_->wait();
        if (queue) queue->waited_for_ = std::max(queue->waited_for_, launched_);
    }

  private:
    std::weak_ptr<FaultyQueue> queue_;
    std::string name_;
    std::unique_ptr<setka::backend::PendingRead> real_;
    std::uint64_t launched_;  ///< before the read
};

std::unique_ptr<setka::backend::PendingRead> FaultyQueue::read_later(Memory& source, void* target,
                                                                     std::uint64_t size_bytes) {
    fail_if_due(Step::Read, source.name());
    return std::make_unique<PendingRead>(weak_from_this(), source.name(),
                                         real_->read_later(source, target, size_bytes), launched_);
}

void FaultyQueue::copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
                       std::uint64_t size_bytes) {
    fail_if_due(Step::Copy, source.name());
    real_->copy(source, source_at, target, target_at, size_bytes);
}

void FaultyQueue::fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) {
    fail_if_due(Step::Fill, target.name());
    real_->fill(target, pattern, size_bytes);
}

void FaultyQueue::finish() {
    ++waits_;
    real_->finish();
    waited_for_ = launched_;
}

void FaultyQueue::library_scan(Memory& counts, Memory& offsets, Memory& total, Memory& scratch,
                               std::uint32_t n) {
    fail_if_due(Step::Launch, "library scan");
    ++launched_;
    ++launches_;
    real_->library_scan(counts, offsets, total, scratch, n);
}

int FaultyQueue::library_sort(const setka::backend::SortBuffers& buffers, std::uint32_t n,
                              std::uint32_t key_bits) {
    fail_if_due(Step::Launch, "library sort");
    ++launched_;
    ++launches_;
    return real_->library_sort(buffers, n, key_bits);
}

FaultyPair make_faulty_queue(const setka::Device& device) {
    auto faults = std::make_shared<FaultyQueue>(device, device.impl()->make_queue());
    return {faults, setka::Queue(device, faults)};
}

}  // namespace faults
