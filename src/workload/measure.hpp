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
    double device_ms = 0;           ///< sum over all stages, of runs that are recorded
    std::vector<StageTime> stages;  ///< in order of first use
    double wall_spread_ms = 0;      ///< between the quartiles: half of the repeats lie in a range this wide
    double device_spread_ms = 0;
};

/// Runs `work` on the queue `repeats` times and waits after each. If more than once, a first run warms up and
/// does not count, and device times come from further runs, a quarter as many and three at least, since to record them takes time.
/// `prepare` runs before each and is not measured: for work that destroys its input.
[[nodiscard]] Measurement measure(Queue& queue, std::uint32_t repeats, const std::function<void()>& work,
                                  const std::function<void()>& prepare = {});

/// The same of work that is done when it returns: wall time only.
[[nodiscard]] Measurement measure(std::uint32_t repeats, const std::function<void()>& work);

/// 0 for an empty list, the mean of the middle two for an even count.
[[nodiscard]] double median(std::vector<double> values);

/// From the value a quarter of the way up to the one three quarters up, in order; 0 for an empty list.
[[nodiscard]] double quartile_distance(std::vector<double> values);

}  // namespace setka::workload
