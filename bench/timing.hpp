// SPDX-License-Identifier: MIT
/// How does a measurement become a row of Google Benchmark's report? As a median, whatever its counters would
/// average.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <functional>
#include <string>

#include "setka/device.hpp"

namespace setka::bench {

/// What one run does.
struct Work {
    const char* rate;               ///< the throughput's unit: "Mray/s"
    double amount = 0;              ///< how much of it one run does, such as millions of rays
    std::uint64_t bytes_moved = 0;  ///< the least that has to be read and written; README.md has the formulas
};

/// Times `run` on the queue until Google Benchmark has enough, and reports medians: wall time, device time,
/// each stage, throughput, and the scratch beyond what is alive in the end. `prepare` runs before each run
/// and is not timed.
void time_work(benchmark::State& state, Queue& queue, const Work& work, const std::function<void()>& run,
               const std::function<void()>& prepare = {});

/// The same of work that is done when `run` returns, on the host's threads: wall time and throughput, and
/// `bytes_moved` unless it is 0. `label` says on what.
void time_host_work(benchmark::State& state, const std::string& label, const Work& work,
                    const std::function<void()>& run);

/// The structure's bytes, and those of it and of the scratch that was counted before for each triangle.
void add_memory_counters(benchmark::State& state, std::uint64_t triangle_count, std::uint64_t table_bytes);

[[nodiscard]] constexpr double millions(std::uint64_t count) noexcept {
    return static_cast<double>(count) / 1e6;
}

/// Registers a benchmark that skips visibly, with the reason, where the device's memory does not suffice.
void add_benchmark(const std::string& name, std::function<void(benchmark::State&)> body);

}  // namespace setka::bench
