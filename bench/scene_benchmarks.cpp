// SPDX-License-Identifier: MIT
/// How fast are grids built and rays traced? Build, trace by ray kind, query and step, and a frame of a
/// dynamic scene.
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/benchmarks.hpp"
#include "bench/moving_scene.hpp"
#include "bench/subject.hpp"
#include "bench/timing.hpp"
#include "workload/measure.hpp"

namespace setka::bench {

namespace {

/// Each triangle's indices and vertices are read, and the tables are written.
[[nodiscard]] std::uint64_t build_bytes(const Subject& subject) {
    constexpr std::uint64_t triangle_bytes = sizeof(Triangle) + 3 * sizeof(Float3);
    return triangle_bytes * subject.grid().header().triangle_count + subject.grid().size_bytes();
}

/// Each ray is read and its result is written; tables and triangles may come from a cache.
[[nodiscard]] std::uint64_t trace_bytes(const Subject& subject, const TraceCase& what) {
    const std::uint64_t result = what.query == Query::Closest ? sizeof(Hit) : sizeof(std::uint32_t);
    return (subject.rays().*what.rays).size() * (sizeof(Ray) + result);
}

void add_grid_counters(benchmark::State& state, const Subject& subject) {
    const SetkaGridHeader& header = subject.grid().header();
    state.counters["triangles"] = header.triangle_count;
    state.counters["cells"] = header.cell_count;
    state.counters["pairs"] = header.reference_count;
    add_memory_counters(state, header.triangle_count, subject.grid().size_bytes());
}

void time_build(benchmark::State& state, Subject& subject) {
    const Work work{"Mtri/s", millions(subject.grid().header().triangle_count), build_bytes(subject)};
    time_work(state, subject.queue(), work, [&] { subject.rebuild(); });
    add_grid_counters(state, subject);
}

void time_trace(benchmark::State& state, Subject& subject, const TraceCase& what, GridStep step) {
    const std::size_t count = (subject.rays().*what.rays).size();
    if (count == 0) return state.SkipWithError("no primary ray hits the scene, so there are no such rays");
    const Work work{"Mray/s", millions(count), trace_bytes(subject, what)};
    time_work(state, subject.queue(), work, [&] { subject.trace(what, step); });
    state.counters["rays"] = static_cast<double>(count);
    if (what.query == Query::Any) return;
    const MeanCost& cost = subject.cost(what, step);
    state.counters["cells_per_ray"] = cost.cells;
    state.counters["tests_per_ray"] = cost.tests;
}

/// The grid anew, then primary and shadow rays: what a moving scene needs, less the upload of what moved.
void time_frame(benchmark::State& state, Subject& subject) {
    const TraceCase& primary = trace_cases[0];
    const TraceCase& shadow = trace_cases[1];
    const Work work{"frame/s", 1,
                    build_bytes(subject) + trace_bytes(subject, primary) + trace_bytes(subject, shadow)};
    time_work(state, subject.queue(), work, [&] {
        subject.rebuild();
        subject.trace(primary, GridStep::Dda);
        subject.trace(shadow, GridStep::Dda);
    });
    add_grid_counters(state, subject);
    state.counters["rays"] =
        static_cast<double>(subject.rays().primary.size() + subject.rays().shadow.size());
}

/// A frame in which everything moves: edits, build and picture.
void time_moving(benchmark::State& state, MovingScene& scene, Motion motion) {
    std::vector<double> upload, build, picture;
    time_work(state, scene.queue(), {"frame/s", 1, 0}, [&] {
        const FrameParts parts = scene.frame(motion);
        upload.push_back(parts.upload_ms);
        build.push_back(parts.build_ms);
        picture.push_back(parts.picture_ms);
    });
    auto& counters = state.counters;
    counters["part_upload_ms"] = workload::median(upload);
    counters["part_build_ms"] = workload::median(build);
    counters["part_picture_ms"] = workload::median(picture);
    counters["triangles"] = scene.triangle_count();
    counters["rays"] = static_cast<double>(scene.statistics().primary_rays + scene.statistics().shadow_rays);
}

/// The benchmarks of one scene on one target at one density.
class Registrar {
  public:
    Registrar(Bench& bench, Target& target, const SceneCase& scene, float density)
        : bench_(bench), target_(target), scene_(scene), density_(density) {}

    void add(const std::string& name, const std::function<void(benchmark::State&, Subject&)>& body) const {
        add_benchmark(name + '/' + scene_.to_string() + suffix(),
                      [self = *this, body](benchmark::State& state) { body(state, self.subject()); });
    }

  private:
    [[nodiscard]] std::string suffix() const {
        if (bench_.options.densities.size() == 1) return "";
        return std::string("/density:") + to_string(density_);
    }
    [[nodiscard]] Subject& subject() const {
        auto& subject = bench_.slot.get<Subject>(target_.name() + ' ' + scene_.to_string(), [this] {
            return std::make_unique<Subject>(target_, scene_, bench_.loader.load(scene_), bench_.options,
                                             bench_.validator);
        });
        subject.use_density(density_);
        return subject;
    }

    Bench& bench_;
    Target& target_;
    const SceneCase& scene_;
    float density_;
};

void register_moving(Bench& bench, Target& target, const SceneCase& scene) {
    for (const auto& [name, motion] : {std::pair("moving/", Motion::Instances), std::pair("deforming/", Motion::Vertices)})
        add_benchmark(name + target.name() + '/' + scene.to_string(), [&, motion = motion](benchmark::State& state) {
            auto& subject = bench.slot.get<MovingScene>("moving " + target.name() + ' ' + scene.to_string(), [&] {
                return std::make_unique<MovingScene>(target, scene, bench.loader.load(scene), bench.options);
            });
            time_moving(state, subject, motion);
        });
}

void register_scene(Bench& bench, Target& target, const SceneCase& scene, float density) {
    const Registrar registrar(bench, target, scene, density);
    registrar.add("build/" + target.name(), time_build);
    registrar.add("frame/" + target.name(), time_frame);
    if (!target.is_first_of_device()) return;
    for (const TraceCase& what : trace_cases)
        for (const GridStep step : bench.options.steps)
            registrar.add(std::string("trace/") + what.name + '/' + to_string(step) + '/' + target.info().id,
                          [&what, step](benchmark::State& state, Subject& subject) {
                              time_trace(state, subject, what, step);
                          });
}

}  // namespace

void register_scenes(Bench& bench) {
    for (const SceneCase& scene : bench.scenes) {
        for (Target& target : bench.targets)
            for (const float density : bench.options.densities) register_scene(bench, target, scene, density);
        for (Target& target : bench.targets) register_moving(bench, target, scene);
        register_embree(bench, scene);
    }
}

}  // namespace setka::bench
