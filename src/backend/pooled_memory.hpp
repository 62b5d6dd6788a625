// SPDX-License-Identifier: MIT
/// How does a queue allocate? From its pool where that has the size, else from the driver, counted against
/// the budget.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "backend/device.hpp"
#include "backend/pool.hpp"
#include "core/settings.hpp"
#include "setka/error.hpp"

namespace setka::backend {

/// An allocation that goes back to its pool, and its bytes to the device's budget, with the last reference.
/// Without a device it is memory that somebody else counts.
template <typename Handle>
class PooledMemory : public Memory {
  public:
    using Memory::Memory;
    ~PooledMemory() override {
        if (!device_) return;
        device_->release(size_bytes());
        device_->remove_slack(pooled_bytes_ - size_bytes());
        pool_->give(pooled_bytes_, std::move(buffer));
    }

    Handle buffer;

    /// Takes `pooled_bytes` from `pool`, else from make_handle(pooled_bytes); `device` has reserved
    /// size_bytes() for it.
    template <typename MakeHandle>
    void fill_from(std::shared_ptr<Device> device, std::shared_ptr<Pool<Handle>> pool,
                   std::uint64_t pooled_bytes, MakeHandle make_handle) {
        // Neither what is larger than asked for nor unused allocations of other sizes must push the total over the budget.
        const std::uint64_t budget = device->options().memory_budget_bytes;
        const std::uint64_t held = device->in_use_bytes() + device->slack_bytes();
        auto pooled = pool->take(pooled_bytes);
        if (pooled && (pooled->size_bytes == pooled_bytes || held + (pooled->size_bytes - size_bytes()) <= budget)) {
            buffer = std::move(pooled->handle);
            pooled_bytes = pooled->size_bytes;
        } else {
            pooled.reset();
            if (held + pool->cached_bytes() > budget) pool->clear();
            buffer = make_or_trim(*device, pooled_bytes, make_handle);
        }
        device->add_slack(pooled_bytes - size_bytes());
        pooled_bytes_ = pooled_bytes;
        pool_ = std::move(pool);
        device_ = std::move(device);  // from here on the destructor releases
    }

  private:
    /// A new allocation of the driver. One that has none left gets back what is cached here and is asked once more: others may
    /// hold the device's memory.
    template <typename MakeHandle>
    static Handle make_or_trim(Device& device, std::uint64_t pooled_bytes, MakeHandle make_handle) {
        device.count_driver_allocation();
        try {
            return make_handle(pooled_bytes);
        } catch (const Error& error) {
            if (error.category() != ErrorCategory::OutOfMemory) throw;
        }
        device.trim();
        return make_handle(pooled_bytes);
    }

    std::uint64_t pooled_bytes_ = 0;
    std::shared_ptr<Device> device_;
    std::shared_ptr<Pool<Handle>> pool_;
};

/// A new PooledMem, a kind of PooledMemory<Handle>. make_handle(bytes) asks the driver, and throws if it has
/// nothing. Throws OutOfMemory, with nothing allocated, if the device's budget or its largest allocation
/// would be exceeded.
template <typename PooledMem, typename Handle, typename MakeHandle>
std::shared_ptr<Memory> allocate_pooled(const std::shared_ptr<Device>& device,
                                        const std::shared_ptr<Pool<Handle>>& pool, std::uint64_t size_bytes,
                                        std::string_view name, MakeHandle make_handle) {
    const DeviceInfo& info = device->info();
    if (size_bytes > info.max_allocation_bytes)
        throw Error(ErrorCategory::OutOfMemory, "buffer '" + std::string(name) + "' needs " +
                                                    std::to_string(size_bytes) + " bytes; " + info.name +
                                                    " allows " + std::to_string(info.max_allocation_bytes) +
                                                    " in one allocation");
    const std::uint64_t pooled_bytes =
        std::min(Pool<Handle>::pooled_size(size_bytes), info.max_allocation_bytes);
    auto memory = std::make_shared<PooledMem>(size_bytes, std::string(name));
    device->reserve(size_bytes, name);
    try {
        memory->fill_from(device, pool, pooled_bytes, make_handle);
    } catch (...) {
        device->release(size_bytes);
        throw;
    }
    if (settings().log_memory)
        log_line("allocated '" + std::string(name) + "', " + std::to_string(size_bytes) + " bytes");
    return memory;
}

}  // namespace setka::backend
