// SPDX-License-Identifier: MIT
/// How do the vendors' devices compare? Measures what was asked for, on results that were checked.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "bench/benchmarks.hpp"
#include "bench/short_display.hpp"
#include "setka/error.hpp"
#include "setka/version.hpp"

namespace {

using namespace setka::bench;

constexpr int exit_ok = 0, exit_mismatch = 1, exit_error = 2;

/// What a reader of the JSON needs to know of the run, in its "context".
void add_context(const Bench& bench) {
    benchmark::AddCustomContext("setka_version", setka::version());
    for (const Target& target : bench.targets) {
        const setka::DeviceInfo& info = target.info();
        if (!target.is_first_of_device()) continue;
        benchmark::AddCustomContext("device " + info.id, info.name);
        benchmark::AddCustomContext("driver " + info.id, info.driver);
        benchmark::AddCustomContext("platform " + info.id, info.platform);
    }
    add_embree_context(bench.embree);
    std::string densities;
    for (const float density : bench.options.densities) {
        if (!densities.empty()) densities += ',';
        densities += to_string(density);
    }
    benchmark::AddCustomContext("density", densities);
    benchmark::AddCustomContext("picture_size", std::to_string(bench.options.size));
    benchmark::AddCustomContext("golden_rows", std::to_string(bench.validator.golden().size()));
}

int run(int argc, char** argv) {
    const Options options = take_options(argc, argv);
    benchmark::Initialize(&argc, argv, print_help);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return exit_error;
    Validator validator(options);
    const std::vector<EmbreeQuality> embree =
        find_embree(options.devices);  // it knows best what ails its names
    Bench bench{
        options,   find_targets(options.devices),     embree, choose_scenes(options, validator.golden()),
        validator, SceneLoader(options.scene_folder), {}};
    add_context(bench);
    register_primitives(bench);
    register_scenes(bench);
    ShortDisplay display(*benchmark::CreateDefaultDisplayReporter());
    const std::size_t count = benchmark::RunSpecifiedBenchmarks(&display);
    benchmark::Shutdown();
    return count > 0 ? exit_ok : exit_error;  // Google Benchmark has said that nothing matches
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Mismatch& mismatch) {
        std::fprintf(stderr, "setka_bench: wrong result: %s\n", mismatch.what());
        return exit_mismatch;
    } catch (const std::bad_alloc&) {
        std::fputs("setka_bench: out of host memory\n", stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "setka_bench: %s\n", error.what());
    }
    return exit_error;
}
