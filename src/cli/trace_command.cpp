// SPDX-License-Identifier: MIT
/// What do the user's own rays hit, and how fast is that? The way to compare setka with another tracer on the
/// same rays.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "cli/command.hpp"
#include "cli/grid_statistics.hpp"
#include "cli/text.hpp"
#include "workload/measure.hpp"
#include "cli/options.hpp"
#include "cli/scene_input.hpp"
#include "cli/structure.hpp"
#include "setka/io.hpp"

namespace setka::cli {

namespace {

struct Options {
    SceneInput input;
    DeviceSelection device;
    StructureChoice structure;
    TraceOptions trace;
    std::string rays;
    std::string output;
    bool any_hit = false;
    std::uint32_t repeats = 1;
    bool as_json = false;
};

/// What the trace found, and how long it took.
struct Result {
    std::uint64_t hit_count = 0;
    workload::Measurement time;
};

[[nodiscard]] Result trace(Queue& queue, const Structure& structure, const Options& options,
                           std::span<const Ray> rays) {
    const Tracer tracer(options.trace);
    const Buffer<Ray> device_rays = queue.upload(rays, "rays");
    Result result;
    if (options.any_hit) {
        const auto flags = queue.make_buffer<std::uint32_t>(rays.size(), "occlusion flags");
        result.time =
            workload::measure(queue, options.repeats, [&] { tracer.any_hit(queue, structure, device_rays, flags); });
        const auto occluded = queue.download(flags);
        result.hit_count = static_cast<std::uint64_t>(std::ranges::count(occluded, 1u));
        if (!options.output.empty()) io::write_occlusion(options.output, occluded);
    } else {
        const auto device_hits = queue.make_buffer<Hit>(rays.size(), "hits");
        result.time = workload::measure(queue, options.repeats,
                              [&] { tracer.closest_hit(queue, structure, device_rays, device_hits); });
        const auto hits = queue.download(device_hits);
        result.hit_count = static_cast<std::uint64_t>(
            std::ranges::count_if(hits, [](const Hit& hit) { return hit.primitive != SETKA_NO_HIT; }));
        if (!options.output.empty()) io::write_hits(options.output, hits);
    }
    return result;
}

[[nodiscard]] ExitCode run(const Options& options) {
    if (!options.output.empty()) check_writable(options.output);
    const std::vector<Ray> rays = io::read_rays(options.rays);
    const Scene scene = options.input.load();
    const Device device = options.device.open();
    Queue queue = device.make_queue();
    const DeviceScene device_scene(queue, scene);
    const auto structure = options.structure.build(queue, device_scene);
    const Result result = trace(queue, *structure, options, rays);

    const workload::Measurement& time = result.time;
    const double mray = share(rays.size(), 1000000);
    if (options.as_json) {
        const nlohmann::ordered_json json{
            {"device", device.info().id},
            {"device_name", device.info().name},
            {"triangles", device_scene.triangle_count()},
            {"structure", to_string(structure->kind())},
            {"query", options.any_hit ? "any" : "closest"},
            {"rays", rays.size()},
            {"hits", result.hit_count},
            {"repeats", time.repeats},
            {"wall_ms", time.wall_ms},
            {"device_ms", time.device_ms},
            {"mray_per_s_wall", mray / (time.wall_ms / 1000)},
        };
        fmt::print("{}\n", json.dump(2));
        return exit_ok;
    }
    fmt::print("rays         {}, {} hit ({} query)\n", grouped(rays.size()), grouped(result.hit_count),
               options.any_hit ? "any-hit" : "closest-hit");
    fmt::print("device       {} ({}), {}\n", device.info().id, device.info().name,
               to_string(structure->kind()));
    fmt::print("device time  {:.3f} ms{}\n", time.device_ms,
               time.repeats > 1 ? fmt::format(", median of {}", time.repeats) : "");
    fmt::print("wall time    {:.3f} ms, {:.3f} Mray/s\n", time.wall_ms, mray / (time.wall_ms / 1000));
    if (!options.output.empty()) fmt::print("wrote        {}\n", options.output);
    return exit_ok;
}

}  // namespace

Command add_trace_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand("trace", "Trace rays from a NumPy file and write what they hit");
    options->input.add_to(*app);
    app->add_option("--rays", options->rays, "float32 array of n x 8: origin, tmin, direction, tmax")
        ->type_name("RAYS.npy")
        ->required();
    app->add_option("-o,--output", options->output,
                    "structured array of t, u, v, primitive, instance; with --any uint8 flags")
        ->type_name("HITS.npy");
    app->add_flag("--any", options->any_hit, "only whether there is a hit");
    add_integer(*app, "--repeat", options->repeats, {1, 100000},
                "traces to take the median of; above 1, another one warms up");
    app->add_flag("--json", options->as_json, "print JSON");
    options->structure.add_to(*app);
    add_step_option(*app, options->trace.step);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
