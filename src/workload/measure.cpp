// SPDX-License-Identifier: MIT
/// How long did it take? See the header.
#include "workload/measure.hpp"

#include <algorithm>
#include <numeric>

namespace setka::workload {

Measurement measure(Queue& queue, std::uint32_t repeats, const std::function<void()>& work,
                    const std::function<void()>& prepare) {
    // What was enqueued before is not part of what comes next.
    const auto make_ready = [&] {
        if (prepare) prepare();
        queue.finish();
    };
    if (repeats > 1) {
        make_ready();
        work();
    }

    std::vector<double> wall_ms, device_ms;
    const auto time_wall = [&] {
        const Stopwatch watch;
        work();
        queue.finish();
        wall_ms.push_back(watch.elapsed_ms());
    };
    queue.stop_timings();
    for (std::uint32_t i = 0; i < repeats && repeats > 1; ++i) {
        make_ready();
        time_wall();
    }

    std::vector<std::vector<StageTime>> runs;
    const std::uint32_t recorded = std::min(repeats, std::max(3u, repeats / 4));
    for (std::uint32_t i = 0; i < recorded; ++i) {
        make_ready();
        (void)queue.take_timings();
        if (repeats == 1) time_wall();
        else work();
        runs.push_back(queue.take_timings());
        const auto add = [](double sum, const StageTime& stage) { return sum + stage.time_ms; };
        device_ms.push_back(std::accumulate(runs.back().begin(), runs.back().end(), 0.0, add));
    }
    queue.stop_timings();

    Measurement result{repeats, median(wall_ms), median(device_ms), runs.front(), quartile_distance(wall_ms),
                       quartile_distance(device_ms)};
    for (StageTime& stage : result.stages) {
        std::vector<double> times_ms;
        for (const auto& run : runs)
            for (const StageTime& other : run)
                if (other.stage == stage.stage) times_ms.push_back(other.time_ms);
        stage.time_ms = median(times_ms);
    }
    return result;
}

Measurement measure(std::uint32_t repeats, const std::function<void()>& work) {
    if (repeats > 1) work();
    std::vector<double> wall_ms;
    for (std::uint32_t i = 0; i < repeats; ++i) {
        const Stopwatch watch;
        work();
        wall_ms.push_back(watch.elapsed_ms());
    }
    Measurement result;
    result.repeats = repeats;
    result.wall_ms = median(wall_ms);
    result.wall_spread_ms = quartile_distance(wall_ms);
    return result;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 != 0 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

double quartile_distance(std::vector<double> values) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    return values[3 * (values.size() - 1) / 4] - values[(values.size() - 1) / 4];
}

}  // namespace setka::workload
