// SPDX-License-Identifier: MIT
/// How does a measurement become a row of Google Benchmark's report? See the header.
#include "bench/timing.hpp"

#include <algorithm>
#include <string>

#include "setka/error.hpp"
#include "workload/measure.hpp"

namespace setka::bench {

namespace {

/// However long one run takes: a median of fewer says little.
constexpr benchmark::IterationCount fewest_repeats = 5;

[[nodiscard]] std::string stage_counter(std::string stage) {
    std::ranges::replace(stage, ' ', '_');
    return "stage_" + stage + "_ms";
}

}  // namespace

void time_work(benchmark::State& state, Queue& queue, const Work& work, const std::function<void()>& run,
               const std::function<void()>& prepare) {
    const Device& device = queue.device();
    device.reset_peak_memory();
    const auto repeats = static_cast<std::uint32_t>(std::max(fewest_repeats, state.max_iterations));
    const workload::Measurement time = workload::measure(queue, repeats, run, prepare);
    const std::uint64_t scratch = device.peak_memory_bytes() - device.memory_in_use_bytes();

    // All iterations at once, each with the median, which is then what Google Benchmark reports as the time
    // of one.
    while (state.KeepRunningBatch(state.max_iterations))
        state.SetIterationTime(time.wall_ms / 1000 * static_cast<double>(state.max_iterations));
    state.SetLabel(device.info().name);
    auto& counters = state.counters;
    counters[work.rate] = work.amount / (time.wall_ms / 1000);
    counters["GB/s"] = static_cast<double>(work.bytes_moved) / time.wall_ms / 1e6;
    counters["repeats"] = time.repeats;
    counters["wall_ms"] = time.wall_ms;
    counters["wall_spread_ms"] = time.wall_spread_ms;
    counters["device_ms"] = time.device_ms;
    counters["device_spread_ms"] = time.device_spread_ms;
    for (const StageTime& stage : time.stages) counters[stage_counter(stage.stage)] = stage.time_ms;
    counters["bytes_moved"] = static_cast<double>(work.bytes_moved);
    counters["peak_scratch_bytes"] = static_cast<double>(scratch);
}

void add_benchmark(const std::string& name, std::function<void(benchmark::State&)> body) {
    const auto guarded = [body = std::move(body)](benchmark::State& state) {
        try {
            body(state);
        } catch (const Error& error) {
            if (error.category() != ErrorCategory::OutOfMemory) throw;
            state.SkipWithError(error.what());
        }
    };
    benchmark::RegisterBenchmark(name.c_str(), guarded)->UseManualTime()->Unit(benchmark::kMillisecond);
}

}  // namespace setka::bench
