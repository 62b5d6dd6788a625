// SPDX-License-Identifier: MIT
/// How long did it take? Wall time and device time of work that is repeated, as medians.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include "setka/device.hpp"

namespace setka::workload {

class Stopwatch {
  public:
    [[nodiscard]] double elapsed_ms() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Medians over the repeats.
struct Measurement {
    std::uint32_t repeats = 0;
    double wall_ms = 0;
    double device_ms = 0;           ///< sum over all stages
    std::vector<StageTime> stages;  ///< in order of first use
};

/// Runs `work` on the queue `repeats` times and waits after each. If more than once, a first run warms up and
/// does not count.
[[nodiscard]] Measurement measure(Queue& queue, std::uint32_t repeats, const std::function<void()>& work);

/// 0 for an empty list, the mean of the middle two for an even count.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace setka::workload
