// SPDX-License-Identifier: MIT
/// How fast does Embree build and trace what setka does? The same rows, under its own name.
#include <functional>
#include <iterator>
#include <memory>
#include <string>

#include "bench/benchmarks.hpp"
#include "bench/embree/embree_subject.hpp"
#include "bench/timing.hpp"
#include "setka/error.hpp"

namespace setka::bench {

namespace {

constexpr EmbreeQuality qualities[] = {EmbreeQuality::Low, EmbreeQuality::Medium};

[[nodiscard]] std::string label(std::size_t thread_count) {
    return "Embree " RTC_VERSION_STRING ", " + std::to_string(thread_count) + " threads";
}

/// What the tree's bytes and the scratch are after the runs that were timed.
void add_counters(benchmark::State& state, EmbreeSubject& subject) {
    EmbreeScene& scene = subject.scene();
    const MemoryMonitor& memory = scene.memory();
    state.counters["triangles"] = static_cast<double>(scene.triangle_count());
    state.counters["peak_scratch_bytes"] = static_cast<double>(memory.peak_bytes() - memory.in_use_bytes());
    add_memory_counters(state, scene.triangle_count(), memory.in_use_bytes());
}

void time_build(benchmark::State& state, EmbreeSubject& subject) {
    EmbreeScene& scene = subject.scene();
    scene.memory().reset_peak();
    time_host_work(state, label(subject.thread_count()), {"Mtri/s", millions(scene.triangle_count())},
                   [&] { scene.rebuild(); });
    add_counters(state, subject);
}

/// The same frame as setka's.
void time_frame(benchmark::State& state, EmbreeSubject& subject) {
    const TraceCase& primary = trace_cases[0];
    const TraceCase& shadow = trace_cases[1];
    subject.scene().memory().reset_peak();
    time_host_work(state, label(subject.thread_count()), {"frame/s", 1}, [&] {
        subject.scene().rebuild();
        subject.trace(primary);
        subject.trace(shadow);
    });
    add_counters(state, subject);
    state.counters["rays"] = static_cast<double>(subject.ray_count(primary) + subject.ray_count(shadow));
}

void time_trace(benchmark::State& state, EmbreeSubject& subject, const TraceCase& what) {
    const std::size_t count = subject.ray_count(what);
    if (count == 0) return state.SkipWithError("no primary ray hits the scene, so there are no such rays");
    const std::uint64_t result = what.query == Query::Closest ? sizeof(Hit) : sizeof(std::uint32_t);
    time_host_work(state, label(subject.thread_count()),
                   {"Mray/s", millions(count), count * (sizeof(Ray) + result)}, [&] { subject.trace(what); });
    state.counters["rays"] = static_cast<double>(count);
    state.counters["disagreeing_rays"] = static_cast<double>(subject.disagreements(what));
}

void add(Bench& bench, const SceneCase& scene, EmbreeQuality quality, const std::string& name,
         const std::function<void(benchmark::State&, EmbreeSubject&)>& body) {
    add_benchmark(name + '/' + scene.to_string(), [&bench, &scene, quality, body](benchmark::State& state) {
        const LoadedScene& loaded = bench.loader.load(scene);
        auto& subject = bench.slot.get<EmbreeSubject>("embree " + scene.to_string(), [&] {
            return std::make_unique<EmbreeSubject>(bench.targets.front(), scene, loaded, bench.options,
                                                   bench.validator);
        });
        subject.use(quality, loaded);
        body(state, subject);
    });
}

}  // namespace

std::vector<EmbreeQuality> find_embree(const std::vector<std::string>& names) {
    if (names.empty()) return {std::begin(qualities), std::end(qualities)};
    std::vector<EmbreeQuality> wanted;
    for (const std::string& name : names) {
        if (!is_embree(name)) continue;
        const std::size_t before = wanted.size();
        for (const EmbreeQuality quality : qualities)
            if (name == "embree" || name == std::string("embree/") + to_string(quality))
                wanted.push_back(quality);
        if (wanted.size() == before)
            throw Error(ErrorCategory::InvalidArgument,
                        "device '" + name + "' is not here; accepted: embree, embree/low, embree/medium");
    }
    return wanted;
}

void add_embree_context(const std::vector<EmbreeQuality>& wanted) {
    for (const EmbreeQuality quality : wanted)
        benchmark::AddCustomContext(
            std::string("device embree-") + to_string(quality),
            "Embree " RTC_VERSION_STRING ", quality " + std::string(to_string(quality)));
}

void register_embree(Bench& bench, const SceneCase& scene) {
    for (const EmbreeQuality quality : bench.embree) {
        const std::string name = to_string(quality);
        add(bench, scene, quality, "build/embree/" + name, time_build);
        add(bench, scene, quality, "frame/embree/" + name, time_frame);
        for (const TraceCase& what : trace_cases) {
            const char* const told = coherence(what) == Coherence::Coherent ? "coherent" : "incoherent";
            add(bench, scene, quality, std::string("trace/") + what.name + '/' + told + "/embree-" + name,
                [&what](benchmark::State& state, EmbreeSubject& subject) {
                    time_trace(state, subject, what);
                });
        }
    }
}

}  // namespace setka::bench
