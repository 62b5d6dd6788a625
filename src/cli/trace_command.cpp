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
#include "cli/options.hpp"
#include "cli/scene_input.hpp"
#include "cli/structure.hpp"
#include "cli/text.hpp"
#include "setka/error.hpp"
#include "setka/io.hpp"
#include "workload/measure.hpp"

namespace setka::cli {

namespace {

enum class Query { Closest, Any, Count, All };

[[nodiscard]] const char* name_of(Query query) {
    switch (query) {
        case Query::Closest:
            return "closest";
        case Query::Any:
            return "any";
        case Query::Count:
            return "count";
        case Query::All:
            break;
    }
    return "all";
}

struct Options {
    SceneInput input;
    DeviceSelection device;
    StructureChoice structure;
    TraceOptions trace;
    AllHitsOptions all_hits;
    std::string rays;
    std::string output;
    std::string offsets;
    Query query = Query::Closest;
    std::uint32_t repeats = 1;
    bool as_json = false;

    /// A ray may hit more than one thing.
    [[nodiscard]] bool is_multiple() const { return query == Query::Count || query == Query::All; }
};

/// What the trace found, and how long it took.
struct Result {
    std::uint64_t ray_count = 0;  ///< rays that hit something
    std::uint64_t hit_count = 0;
    workload::Measurement time;
};

/// One run of a query on rays that are on the device.
struct Run {
    Queue& queue;
    const Structure& structure;
    const Options& options;
    const Buffer<Ray>& rays;

    [[nodiscard]] Result closest() const {
        const auto device_hits = queue.make_buffer<Hit>(rays.size(), "hits");
        Result result;
        result.time =
            measure([&](const Tracer& tracer) { tracer.closest_hit(queue, structure, rays, device_hits); });
        const auto hits = queue.download(device_hits);
        result.hit_count = result.ray_count = static_cast<std::uint64_t>(
            std::ranges::count_if(hits, [](const Hit& hit) { return hit.primitive != SETKA_NO_HIT; }));
        if (!options.output.empty()) io::write_hits(options.output, hits);
        return result;
    }

    [[nodiscard]] Result any() const {
        const auto flags = queue.make_buffer<std::uint32_t>(rays.size(), "occlusion flags");
        Result result;
        result.time = measure([&](const Tracer& tracer) { tracer.any_hit(queue, structure, rays, flags); });
        const auto occluded = queue.download(flags);
        result.hit_count = result.ray_count = static_cast<std::uint64_t>(std::ranges::count(occluded, 1u));
        if (!options.output.empty()) io::write_occlusion(options.output, occluded);
        return result;
    }

    [[nodiscard]] Result count() const {
        const auto device_counts = queue.make_buffer<std::uint32_t>(rays.size(), "hit counts");
        Result result;
        result.time = measure([&](const Tracer& tracer) {
            tracer.count_hits(queue, structure, rays, device_counts, options.all_hits);
        });
        const auto counts = queue.download(device_counts);
        for (const std::uint32_t hits : counts) {
            result.ray_count += hits != 0;
            result.hit_count += hits;
        }
        if (!options.output.empty()) io::write_numbers(options.output, counts);
        return result;
    }

    [[nodiscard]] Result all() const {
        AllHits found;
        Result result;
        result.time = measure([&](const Tracer& tracer) {
            found = {};  // gives the memory back before it is asked for again
            found = tracer.all_hits(queue, structure, rays, options.all_hits);
        });
        const auto offsets = queue.download(found.offsets);
        for (std::size_t i = 0; i < rays.size(); ++i) result.ray_count += offsets[i + 1] > offsets[i];
        result.hit_count = offsets.back();
        if (!options.output.empty()) io::write_hits(options.output, queue.download(found.hits));
        if (!options.offsets.empty()) io::write_numbers(options.offsets, offsets);
        return result;
    }

  private:
    template <typename Work>
    [[nodiscard]] workload::Measurement measure(const Work& work) const {
        const Tracer tracer(options.trace);
        return workload::measure(queue, options.repeats, [&] { work(tracer); });
    }
};

[[nodiscard]] Result trace(Queue& queue, const Structure& structure, const Options& options,
                           std::span<const Ray> rays) {
    const Buffer<Ray> device_rays = queue.upload(rays, "rays");
    const Run run{queue, structure, options, device_rays};
    switch (options.query) {
        case Query::Closest:
            return run.closest();
        case Query::Any:
            return run.any();
        case Query::Count:
            return run.count();
        case Query::All:
            break;
    }
    return run.all();
}

/// Options of one query that are given to another.
void check_options(const Options& options) {
    const auto refuse = [](const std::string& why) { throw Error(ErrorCategory::InvalidArgument, why); };
    if (!options.offsets.empty() && options.query != Query::All)
        refuse("--offsets " + options.offsets + " is for --all-hits only");
    if (options.query == Query::All && !options.output.empty() && options.offsets.empty())
        refuse("--all-hits to " + options.output +
               " needs --offsets OFFSETS.npy too, where each ray's hits begin");
    constexpr std::uint32_t unlimited = AllHitsOptions().max_hits;
    if (options.all_hits.max_hits != unlimited && !options.is_multiple())
        refuse("--max-hits " + std::to_string(options.all_hits.max_hits) +
               " is for --all-hits and --count only");
    if (options.is_multiple() && options.trace.step != GridStep::Dda)
        refuse("--step branch-free is for closest and any hits only; --all-hits and --count take dda");
    if (!options.offsets.empty() && options.offsets == options.output)
        refuse("--offsets " + options.offsets + " is the file of --output; another one is accepted");
}

[[nodiscard]] ExitCode run(const Options& options) {
    check_options(options);
    for (const std::string& file : {options.output, options.offsets})
        if (!file.empty()) check_writable(file);
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
        nlohmann::ordered_json json{
            {"device", device.info().id},
            {"device_name", device.info().name},
            {"triangles", device_scene.triangle_count()},
            {"structure", to_string(structure->kind())},
            {"query", name_of(options.query)},
            {"rays", rays.size()},
            {"hits", result.ray_count},
            {"repeats", time.repeats},
            {"wall_ms", time.wall_ms},
            {"device_ms", time.device_ms},
            {"mray_per_s_wall", mray / (time.wall_ms / 1000)},
        };
        if (options.is_multiple()) json["hits_of_all_rays"] = result.hit_count;
        fmt::print("{}\n", json.dump(2));
        return exit_ok;
    }
    fmt::print("rays         {}, {} hit ({} query)\n", grouped(rays.size()), grouped(result.ray_count),
               name_of(options.query));
    if (options.is_multiple()) fmt::print("hits         {}\n", grouped(result.hit_count));
    fmt::print("device       {} ({}), {}\n", device.info().id, device.info().name,
               to_string(structure->kind()));
    fmt::print("device time  {:.3f} ms{}\n", time.device_ms,
               time.repeats > 1 ? fmt::format(", median of {}", time.repeats) : "");
    fmt::print("wall time    {:.3f} ms, {:.3f} Mray/s\n", time.wall_ms, mray / (time.wall_ms / 1000));
    for (const std::string& file : {options.output, options.offsets})
        if (!file.empty()) fmt::print("wrote        {}\n", file);
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
    app->add_option(
           "-o,--output", options->output,
           "structured array of t, u, v, primitive, instance; with --any uint8 flags, with --count uint32")
        ->type_name("HITS.npy");
    const auto add_query = [&](const char* name, Query query, const char* description) {
        return app->add_flag_callback(
            name, [options, query] { options->query = query; }, description);
    };
    CLI::Option* any = add_query("--any", Query::Any, "only whether there is a hit");
    CLI::Option* count = add_query("--count", Query::Count, "only how many hits there are");
    CLI::Option* all =
        add_query("--all-hits", Query::All, "every hit of each ray, in order, one ray after another");
    any->excludes(count)->excludes(all);
    count->excludes(all);
    app->add_option("--offsets", options->offsets,
                    "with --all-hits: uint32 array of n + 1; ray i has the hits offsets[i] to offsets[i + 1]")
        ->type_name("OFFSETS.npy");
    add_integer(*app, "--max-hits", options->all_hits.max_hits, {1, 0xffffffffu},
                "with --all-hits or --count: the first so many of each ray; all where it is not given")
        ->default_str("");
    add_integer(*app, "--repeat", options->repeats, {1, 100000},
                "traces to take the median of; above 1, another one warms up");
    app->add_flag("--json", options->as_json, "print JSON");
    options->structure.add_to(*app);
    add_step_option(*app, options->trace.step);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
