// SPDX-License-Identifier: MIT
/// What does one device make of a scene, and how fast? See the header.
#include "cli/compare_run.hpp"

#include <optional>
#include <tuple>

#include "setka/renderer.hpp"

namespace setka::cli {

namespace {

template <typename T>
struct Batch {
    BatchTime time;
    std::vector<T> results;
};

/// Times `trace(rays, results)` and downloads the results.
template <typename T, typename Trace>
[[nodiscard]] Batch<T> trace_batch(Queue& queue, const Buffer<Ray>& rays, std::uint32_t repeats,
                                   const Trace& trace) {
    const auto results = queue.make_buffer<T>(rays.size(), "results");
    const auto time = workload::measure(queue, repeats, [&] { trace(rays, results); });
    return {{rays.size(), time}, queue.download(results)};
}

}  // namespace

double BatchTime::mray_per_s() const {
    const double time_ms = is_wall_time() ? time.wall_ms : time.device_ms;
    return rays == 0 || !(time_ms > 0) ? 0 : double(rays) / time_ms / 1000;
}

DeviceRun run_on_device(const Device& device, const Scene& scene, const workload::StandardView& view,
                        const CompareWork& work, const ReportPart& report) {
    const double part_count = 2 + 4 * double(work.steps.size());
    double parts_done = 0;
    const auto begin = [&](std::string_view part) { report(part, parts_done++ / part_count); };

    Queue queue = device.make_queue();
    begin("building");
    const DeviceScene lit(queue, scene);
    const auto builder = make_grid_builder(work.grid);
    std::optional<Grid> grid;
    DeviceRun run;
    run.build = workload::measure(queue, work.repeats, [&] {
        grid.reset();  // so that its memory is free for the next one
        grid = builder->build(queue, lit);
    });
    const Digest tables = grid->digest(queue);
    begin("making rays");
    const workload::StandardRays rays = workload::standard_rays(queue, *grid, view, work.rays_size);
    run.answers = {workload::download_tables(queue, *grid),
                   queue.download(rays.primary),
                   queue.download(rays.shadow),
                   queue.download(rays.diffuse),
                   {}};

    for (const GridStep step : work.steps) {
        const Tracer tracer({.step = step});
        const auto closest = [&](const auto& batch, const auto& hits) {
            tracer.closest_hit(queue, *grid, batch, hits);
        };
        const auto any = [&](const auto& batch, const auto& flags) {
            tracer.any_hit(queue, *grid, batch, flags);
        };
        begin("tracing primary rays");
        auto primary = trace_batch<Hit>(queue, rays.primary, work.repeats, closest);
        begin("tracing shadow rays");
        auto shadow = trace_batch<std::uint32_t>(queue, rays.shadow, work.repeats, any);
        begin("tracing diffuse rays");
        auto diffuse = trace_batch<Hit>(queue, rays.diffuse, work.repeats, closest);
        begin("rendering");
        RenderOptions options;
        std::tie(options.width, options.height) = work.image_size;
        options.trace = tracer.options();
        workload::Results results{std::move(primary.results), std::move(shadow.results),
                                  std::move(diffuse.results),
                                  Renderer(options).render(queue, lit, *grid, view.camera)};
        const workload::Fingerprint fingerprint = workload::fingerprint(tables, results);
        run.steps.push_back({step, primary.time, shadow.time, diffuse.time, fingerprint});
        run.answers.steps.emplace_back(step, std::move(results));
    }
    return run;
}

}  // namespace setka::cli
