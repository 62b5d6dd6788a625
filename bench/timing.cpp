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

/// All iterations at once, each with the median, which is then what Google Benchmark reports as the time of
/// one.
void report(benchmark::State& state, const std::string& label, const Work& work,
            const workload::Measurement& time) {
    while (state.KeepRunningBatch(state.max_iterations))
        state.SetIterationTime(time.wall_ms / 1000 * static_cast<double>(state.max_iterations));
    state.SetLabel(label);
    auto& counters = state.counters;
    counters[work.rate] = work.amount / (time.wall_ms / 1000);
    counters["repeats"] = time.repeats;
    counters["wall_ms"] = time.wall_ms;
    counters["wall_spread_ms"] = time.wall_spread_ms;
    if (work.bytes_moved == 0) return;
    counters["bytes_moved"] = static_cast<double>(work.bytes_moved);
    counters["GB/s"] = static_cast<double>(work.bytes_moved) / time.wall_ms / 1e6;
}

[[nodiscard]] std::uint32_t repeats_of(const benchmark::State& state) {
    return static_cast<std::uint32_t>(std::max(fewest_repeats, state.max_iterations));
}

}  // namespace

void time_work(benchmark::State& state, Queue& queue, const Work& work, const std::function<void()>& run,
               const std::function<void()>& prepare) {
    const Device& device = queue.device();
    device.reset_peak_memory();
    const workload::Measurement time = workload::measure(queue, repeats_of(state), run, prepare);
    const std::uint64_t scratch = device.peak_memory_bytes() - device.memory_in_use_bytes();
    report(state, device.info().name, work, time);
    auto& counters = state.counters;
    counters["device_ms"] = time.device_ms;
    counters["device_spread_ms"] = time.device_spread_ms;
    for (const StageTime& stage : time.stages) counters[stage_counter(stage.stage)] = stage.time_ms;
    counters["peak_scratch_bytes"] = static_cast<double>(scratch);
}

void time_host_work(benchmark::State& state, const std::string& label, const Work& work,
                    const std::function<void()>& run) {
    report(state, label, work, workload::measure(repeats_of(state), run));
}

void add_memory_counters(benchmark::State& state, std::uint64_t triangle_count, std::uint64_t table_bytes) {
    auto& counters = state.counters;
    const auto triangles = static_cast<double>(triangle_count);
    const double scratch = counters["peak_scratch_bytes"];
    counters["table_bytes"] = static_cast<double>(table_bytes);
    counters["table_bytes_per_triangle"] = static_cast<double>(table_bytes) / triangles;
    counters["peak_scratch_bytes_per_triangle"] = scratch / triangles;
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
