// SPDX-License-Identifier: MIT
/// What does a picture hold while it is on its way to the host? The memory that it goes to, and what has to be waited for.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "setka/renderer.hpp"

namespace setka {

/// Adds the time of a call to `total_ms`.
class Timer {
  public:
    explicit Timer(double& total_ms) : total_ms_(total_ms) {}
    ~Timer() {
        total_ms_ +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

  private:
    double& total_ms_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// How a picture comes to the host. Some drivers take longer for what is not waited for, a fifth of a frame.
enum class Fetch {
    Now,    ///< each part is waited for
    Later,  ///< nothing is
};

class PendingImage::Impl {
  public:
    /// `statistics` is what is known already.
    Impl(const RenderOptions& options, const RenderStatistics& statistics, Fetch fetch);

    /// Fetches these pixels to places `first` and following.
    void add_pixels(Queue& queue, std::uint32_t first, const Buffer<Float3>& linear, const Buffer<std::uint8_t>& codes);
    /// Fetches numbers that the statistics add up.
    void add_shadow_rays(Queue& queue, const Buffer<std::uint32_t>& numbers);

    [[nodiscard]] bool is_ready() const;
    /// Waits, and completes the statistics.
    [[nodiscard]] Image take();
    [[nodiscard]] RenderStatistics& statistics() noexcept { return statistics_; }

  private:
    struct Read {
        std::shared_ptr<backend::PendingRead> read;
        std::uint64_t size_bytes;
    };
    template <typename T>
    void add(Queue& queue, const Buffer<T>& source, std::span<T> target);

    Fetch fetch_;
    Image image_;
    std::deque<Read> reads_;  ///< into image_, so they go before it
    std::uint64_t on_the_way_bytes_ = 0;
    std::vector<Download<std::uint32_t>> shadow_rays_;
    RenderStatistics statistics_;
};

}  // namespace setka
