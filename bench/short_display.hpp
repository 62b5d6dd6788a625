// SPDX-License-Identifier: MIT
/// What does a person want to see of two dozen counters? On the console only throughput and device time;
/// files hold all.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace setka::bench {

class ShortDisplay final : public benchmark::BenchmarkReporter {
  public:
    /// `inner` is what --benchmark_format asks for; only a console's rows are shortened.
    explicit ShortDisplay(benchmark::BenchmarkReporter& inner)
        : inner_(inner), is_console_(dynamic_cast<benchmark::ConsoleReporter*>(&inner) != nullptr) {}

    bool ReportContext(const Context& context) override { return inner_.ReportContext(context); }
    void ReportRuns(const std::vector<Run>& runs) override {
        std::vector<Run> shortened = runs;
        for (Run& run : shortened)
            if (is_console_)
                std::erase_if(run.counters, [](const auto& counter) {
                    const std::string& name = counter.first;
                    return name != "device_ms" && (name == "GB/s" || !name.ends_with("/s"));
                });
        inner_.ReportRuns(shortened);
    }
    void Finalize() override { inner_.Finalize(); }

  private:
    benchmark::BenchmarkReporter& inner_;
    bool is_console_;
};

}  // namespace setka::bench
