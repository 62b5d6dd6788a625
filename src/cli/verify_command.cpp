// SPDX-License-Identifier: MIT
/// Does the grid return what brute force returns, bit for bit? Both stepping rules and both queries, over
/// rays that are chosen to find mistakes.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/text.hpp"
#include "workload/measure.hpp"
#include "cli/interrupt.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "workload/random_rays.hpp"
#include "cli/scene_input.hpp"

namespace setka::cli {

namespace {

constexpr std::uint64_t batch_rays = std::uint64_t{1} << 18;
constexpr std::size_t most_shown = 10;

struct Options {
    SceneInput input;
    DeviceSelection device;
    GridOptions grid;
    std::uint64_t rays = 100000;
    std::uint64_t seed = 1;
    ProgressMode progress = ProgressMode::Auto;
    bool as_json = false;
};

struct KindTally {
    std::uint64_t rays = 0, hits = 0, mismatches = 0;
};

/// What was compared, by kind of ray, and the first disagreements in words.
struct Tally {
    std::array<KindTally, workload::ray_kind_count> kinds;
    std::uint64_t mismatches = 0;
    std::vector<std::string> shown;

    void add_mismatch(std::uint64_t index, const std::string& text) {
        ++mismatches;
        ++kinds[std::size_t(workload::RandomRays::kind(index))].mismatches;
        if (shown.size() < most_shown) shown.push_back(text);
    }
};

[[nodiscard]] std::string describe(const Hit& hit) {
    constexpr Hit miss{std::numeric_limits<float>::infinity(), 0, 0, SETKA_NO_HIT, SETKA_NO_HIT};
    if (std::memcmp(&hit, &miss, sizeof(Hit)) == 0) return "no hit";
    return fmt::format("t {:.9g}, u {:.9g}, v {:.9g}, primitive {}, instance {}", hit.t, hit.u, hit.v,
                       hit.primitive, hit.instance);
}

[[nodiscard]] std::string describe(std::uint64_t index, const Ray& ray) {
    return fmt::format(
        "ray {} ({}): origin {:.9g},{:.9g},{:.9g} direction {:.9g},{:.9g},{:.9g} t {:.9g} to {:.9g}", index,
        to_string(workload::RandomRays::kind(index)), ray.origin[0], ray.origin[1], ray.origin[2], ray.direction[0],
        ray.direction[1], ray.direction[2], ray.tmin, ray.tmax);
}

/// A stepping rule with its name.
struct NamedTracer {
    const char* name;
    Tracer tracer;
};

[[nodiscard]] std::array<NamedTracer, 2> grid_tracers() {
    return {
        {{"dda", Tracer({.step = GridStep::Dda})}, {"branch-free", Tracer({.step = GridStep::BranchFree})}}};
}

/// Traces one batch every way and tallies what differs.
void compare(Queue& queue, const Grid& grid, const BruteForce& brute_force, std::uint64_t first,
             const std::vector<Ray>& rays, Tally& tally) {
    const Buffer<Ray> device_rays = queue.upload(std::span(rays), "rays");
    const auto device_hits = queue.make_buffer<Hit>(rays.size(), "hits");
    const auto device_flags = queue.make_buffer<std::uint32_t>(rays.size(), "occlusion flags");
    Tracer().closest_hit(queue, brute_force, device_rays, device_hits);
    const std::vector<Hit> expected = queue.download(device_hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        KindTally& kind = tally.kinds[std::size_t(workload::RandomRays::kind(first + i))];
        ++kind.rays;
        kind.hits += expected[i].primitive != SETKA_NO_HIT;
    }
    for (const auto& [name, tracer] : grid_tracers()) {
        tracer.closest_hit(queue, grid, device_rays, device_hits);
        const std::vector<Hit> hits = queue.download(device_hits);
        tracer.any_hit(queue, grid, device_rays, device_flags);
        const std::vector<std::uint32_t> flags = queue.download(device_flags);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (std::memcmp(&hits[i], &expected[i], sizeof(Hit)) != 0)
                tally.add_mismatch(
                    first + i, fmt::format("{}; brute force: {}; grid, {}: {}", describe(first + i, rays[i]),
                                           describe(expected[i]), name, describe(hits[i])));
            if (flags[i] != (expected[i].primitive != SETKA_NO_HIT ? 1u : 0u))
                tally.add_mismatch(first + i, fmt::format("{}; brute force: {}; grid, {}, any hit: {}",
                                                          describe(first + i, rays[i]), describe(expected[i]),
                                                          name, flags[i]));
        }
    }
}

void print_json(const Options& options, const Device& device, const Grid& grid, const Tally& tally,
                double wall_ms) {
    nlohmann::ordered_json kinds;
    for (std::size_t i = 0; i < workload::ray_kind_count; ++i) {
        const KindTally& kind = tally.kinds[i];
        kinds[to_string(workload::RayKind(i))] = {
            {"rays", kind.rays}, {"hits", kind.hits}, {"mismatches", kind.mismatches}};
    }
    const nlohmann::ordered_json json{
        {"device", device.info().id},
        {"device_name", device.info().name},
        {"triangles", grid.header().triangle_count},
        {"density", options.grid.density},
        {"dims", grid.header().dims},
        {"seed", options.seed},
        {"rays", options.rays},
        {"kinds", kinds},
        {"mismatches", tally.mismatches},
        {"first_mismatches", tally.shown},
        {"wall_ms", wall_ms},
    };
    fmt::print("{}\n", json.dump(2));
}

void print_text(const Options& options, const Device& device, const Grid& grid, const Tally& tally,
                double wall_ms) {
    const SetkaGridHeader& header = grid.header();
    fmt::print("{}: {} triangles, density {:g}, grid {} x {} x {}, {} ({})\n", options.input.name(),
               grouped(header.triangle_count), options.grid.density, header.dims[0], header.dims[1],
               header.dims[2], device.info().id, device.info().name);
    for (std::size_t i = 0; i < workload::ray_kind_count; ++i) {
        const KindTally& kind = tally.kinds[i];
        fmt::print("{:<13} {:>11} rays, {:>11} hits, {} mismatches\n", to_string(workload::RayKind(i)),
                   grouped(kind.rays), grouped(kind.hits), grouped(kind.mismatches));
    }
    for (const std::string& text : tally.shown) fmt::print("{}\n", text);
    if (tally.mismatches > tally.shown.size())
        fmt::print("and {} more\n", grouped(tally.mismatches - tally.shown.size()));
    fmt::print("{}: {} rays, {} mismatches, closest and any hit, both steps, in {:.1f} s ({} rays/s)\n",
               tally.mismatches == 0 ? "equal" : "DIFFERENT", grouped(options.rays),
               grouped(tally.mismatches), wall_ms / 1000,
               grouped(static_cast<std::uint64_t>(double(options.rays) / (wall_ms / 1000))));
}

[[nodiscard]] ExitCode run(const Options& options) {
    const Scene scene = options.input.load();
    const Device device = options.device.open();
    Queue queue = make_interruptible_queue(device);
    const DeviceScene device_scene(queue, scene);
    const Grid grid = make_grid_builder(options.grid)->build(queue, device_scene);
    const BruteForce brute_force = BruteForce::build(queue, device_scene);
    const workload::RandomRays make_ray(scene, grid.header(), options.seed);

    Tally tally;
    Progress progress(options.progress);
    const workload::Stopwatch watch;
    std::vector<Ray> rays;
    for (std::uint64_t first = 0; first < options.rays; first += batch_rays) {
        rays.clear();
        for (std::uint64_t i = first; i < std::min(first + batch_rays, options.rays); ++i)
            rays.push_back(make_ray(i));
        compare(queue, grid, brute_force, first, rays, tally);
        const double done = static_cast<double>(first + rays.size());
        progress.update("verifying", done / static_cast<double>(options.rays),
                        fmt::format("{:.0f} rays/s, {} mismatches", done / (watch.elapsed_ms() / 1000),
                                    grouped(tally.mismatches)));
    }
    progress.clear();
    const double wall_ms = watch.elapsed_ms();
    if (options.as_json) print_json(options, device, grid, tally, wall_ms);
    else print_text(options, device, grid, tally, wall_ms);
    return tally.mismatches == 0 ? exit_ok : exit_check_failed;
}

}  // namespace

Command add_verify_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand(
        "verify", "Compare the grid's hits with brute force, bit for bit; exit 1 if any differs");
    options->input.add_to(*app);
    add_integer(*app, "--rays", options->rays, {1, std::uint64_t{1} << 40},
                "rays, a third each random, axis-aligned and edge-aimed");
    add_integer(*app, "--seed", options->seed, {0, ~std::uint64_t{0}}, "which rays");
    add_progress_option(*app, options->progress);
    app->add_flag("--json", options->as_json, "print JSON");
    add_grid_options(*app, options->grid);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
