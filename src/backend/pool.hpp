// SPDX-License-Identifier: MIT
/// What happens to allocations that are given back? They wait, by size, for the next request of the same queue.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "core/settings.hpp"

namespace setka::backend {

/// Allocations of one queue that are not in use. They are reused in that queue's order only, so no command can still be using
/// one when the next gets it. Destroying a Handle returns the memory to the driver.
template <typename Handle>
class Pool {
  public:
    /// Keeps no more than `most_cached_bytes`: what is given back beyond them makes it forget the rest.
    explicit Pool(std::uint64_t most_cached_bytes = ~std::uint64_t(0)) : most_cached_bytes_(most_cached_bytes) {}

    /// Sizes of pooled allocations: sixteenths of a power of two, so that similar requests share and little is wasted.
    [[nodiscard]] static std::uint64_t pooled_size(std::uint64_t size_bytes) {
        if (!settings().pooling) return size_bytes;
        const std::uint64_t step = std::max<std::uint64_t>(256, std::bit_ceil(size_bytes) / 16);
        return (size_bytes + step - 1) / step * step;
    }

    /// An allocation and how large it is.
    struct Pooled {
        Handle handle;
        std::uint64_t size_bytes;
    };

    /// The smallest that is at least as large, unless it is larger by more than a quarter: tables of moving scenes have another size
    /// in each frame, and need no memory of their own for each.
    [[nodiscard]] std::optional<Pooled> take(std::uint64_t size_bytes) {
        if (!settings().pooling) return std::nullopt;  // what was given back stays apart, as a checker's quarantine
        const std::scoped_lock lock(mutex_);
        const auto it = free_.lower_bound(size_bytes);
        if (it == free_.end() || it->first - size_bytes > size_bytes / 4) return std::nullopt;
        std::optional<Pooled> pooled(Pooled{std::move(it->second), it->first});
        cached_bytes_ -= it->first;
        free_.erase(it);
        return pooled;
    }

    void give(std::uint64_t size_bytes, Handle handle) noexcept {
        const std::scoped_lock lock(mutex_);
        if (size_bytes > most_cached_bytes_ - std::min(cached_bytes_, most_cached_bytes_)) {
            free_.clear();
            cached_bytes_ = 0;
        }
        if (size_bytes > most_cached_bytes_) return;
        try {
            free_.emplace(size_bytes, std::move(handle));
            cached_bytes_ += size_bytes;
        } catch (const std::bad_alloc&) {
            // Then the driver gets it back now.
        }
    }

    void clear() noexcept {
        const std::scoped_lock lock(mutex_);
        free_.clear();
        cached_bytes_ = 0;
    }

    [[nodiscard]] std::uint64_t cached_bytes() const noexcept {
        const std::scoped_lock lock(mutex_);
        return cached_bytes_;
    }

  private:
    mutable std::mutex mutex_;
    std::uint64_t most_cached_bytes_;
    std::multimap<std::uint64_t, Handle> free_;
    std::uint64_t cached_bytes_ = 0;
};

/// The pools of a device's queues, as long as they live.
template <typename Handle>
class PoolList {
  public:
    template <typename... Limits>
    [[nodiscard]] std::shared_ptr<Pool<Handle>> make_pool(Limits... limits) {
        auto pool = std::make_shared<Pool<Handle>>(limits...);
        const std::scoped_lock lock(mutex_);
        std::erase_if(pools_, [](const auto& weak) { return weak.expired(); });
        pools_.push_back(pool);
        return pool;
    }

    /// Gives back everything that is cached in any of them.
    void clear() {
        const std::scoped_lock lock(mutex_);
        for (const auto& weak : pools_)
            if (const auto pool = weak.lock()) pool->clear();
    }

  private:
    std::mutex mutex_;
    std::vector<std::weak_ptr<Pool<Handle>>> pools_;
};

}  // namespace setka::backend
