// SPDX-License-Identifier: MIT
/// What grid does a scene get, how large is it, and how long does it take to build?
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command.hpp"
#include "cli/grid_statistics.hpp"
#include "cli/interrupt.hpp"
#include "cli/text.hpp"
#include "workload/measure.hpp"
#include "cli/options.hpp"
#include "cli/scene_input.hpp"
#include "core/file.hpp"
#include "setka/save.hpp"

namespace setka::cli {

namespace {

struct Options {
    SceneInput input;
    DeviceSelection device;
    GridOptions grid;
    std::uint32_t repeats = 1;
    std::string save_file;
    bool as_json = false;
};

/// Everything that is reported about one build.
struct Report {
    std::string device;
    std::uint64_t scene_bytes = 0;
    std::uint64_t planned_peak_bytes = 0;
    std::uint64_t peak_bytes = 0;  ///< measured, without the scene
    workload::Measurement time;
    GridStatistics statistics;
    Digest digest;
    std::string saved_file;  ///< empty if none was asked for
    std::uint64_t saved_bytes = 0;
};

void print_json(const Grid& grid, const Report& report) {
    const SetkaGridHeader& header = grid.header();
    nlohmann::ordered_json sections, stages;
    for (const Section& section : grid.sections()) sections[section.name] = section.size_bytes;
    for (const StageTime& stage : report.time.stages)
        stages.push_back({{"stage", stage.stage}, {"time_ms", stage.time_ms}, {"launches", stage.launches}});
    nlohmann::ordered_json json{
        {"device", report.device},
        {"triangles", header.triangle_count},
        {"instances", header.instance_count},
        {"dims", header.dims},
        {"cell_size", header.cell_size},
        {"cells", header.cell_count},
        {"pairs", header.reference_count},
        {"pairs_per_triangle", share(header.reference_count, header.triangle_count)},
        {"empty_share", share(report.statistics.empty_cells, header.cell_count)},
        {"longest_list", report.statistics.longest_list},
        {"table_bytes", grid.size_bytes()},
        {"sections", sections},
        {"scene_bytes", report.scene_bytes},
        {"planned_peak_bytes", report.planned_peak_bytes},
        {"peak_bytes", report.peak_bytes},
        {"repeats", report.time.repeats},
        {"wall_ms", report.time.wall_ms},
        {"device_ms", report.time.device_ms},
        {"stages", stages},
        {"digest", report.digest.to_string()},
    };
    if (!report.saved_file.empty()) json["saved"] = {{"file", report.saved_file}, {"bytes", report.saved_bytes}};
    fmt::print("{}\n", json.dump(2));
}

void print_text(const std::string& name, const Grid& grid, const Report& report) {
    const SetkaGridHeader& header = grid.header();
    const double mtri_per_s = share(header.triangle_count, 1000) / report.time.wall_ms;
    fmt::print("scene            {}: {} triangles, {} instance{}\n", name, grouped(header.triangle_count),
               grouped(header.instance_count), header.instance_count == 1 ? "" : "s");
    fmt::print("device           {}\n", report.device);
    fmt::print("resolution       {} x {} x {}, cell size {:g}\n", header.dims[0], header.dims[1],
               header.dims[2], header.cell_size);
    fmt::print("cells            {}, {:.1f}% empty\n", grouped(header.cell_count),
               100 * share(report.statistics.empty_cells, header.cell_count));
    fmt::print("pairs            {}, {:.3f} a triangle, longest list {}\n", grouped(header.reference_count),
               share(header.reference_count, header.triangle_count), grouped(report.statistics.longest_list));
    fmt::print("tables           {}", as_bytes(grid.size_bytes()));
    const char* separator = ": ";
    for (const Section& section : grid.sections()) {
        fmt::print("{}{} {}", separator, section.name, as_bytes(section.size_bytes));
        separator = ", ";
    }
    fmt::print("\nmemory           scene {}, build peak {} (planned {})\n", as_bytes(report.scene_bytes),
               as_bytes(report.peak_bytes), as_bytes(report.planned_peak_bytes));
    for (const StageTime& stage : report.time.stages)
        fmt::print("  {:<14} {:9.3f} ms, {} launches\n", stage.stage, stage.time_ms, stage.launches);
    fmt::print("device time      {:.3f} ms{}\n", report.time.device_ms,
               report.time.repeats > 1 ? fmt::format(", median of {}", report.time.repeats) : "");
    fmt::print("wall time        {:.3f} ms, {:.2f} Mtri/s\n", report.time.wall_ms, mtri_per_s);
    fmt::print("digest           {}\n", report.digest.to_string());
    if (!report.saved_file.empty()) fmt::print("saved            {}: {}\n", report.saved_file, as_bytes(report.saved_bytes));
}

[[nodiscard]] ExitCode run(const Options& options) {
    if (!options.save_file.empty()) {
        const detail::PendingFile made_and_removed(options.save_file);  // a bad name is refused before the work
    }
    const Scene scene = options.input.load();
    const Device device = options.device.open();
    // Builds to take a median of are timed as the library does them where no stop can be requested.
    Queue queue = options.repeats == 1 ? make_interruptible_queue(device) : device.make_queue();
    const DeviceScene device_scene(queue, scene);
    const auto builder = make_grid_builder(options.grid);

    Report report;
    report.device = fmt::format("{} ({})", device.info().id, device.info().name);
    queue.finish();
    report.scene_bytes = device.memory_in_use_bytes();
    device.reset_peak_memory();
    std::optional<Grid> grid;
    report.time = workload::measure(queue, options.repeats, [&] {
        grid.reset();  // so that its memory is free for the next one
        GridPlan plan = builder->plan(queue, device_scene);
        report.planned_peak_bytes = plan.peak_bytes();
        grid = builder->build(queue, std::move(plan));
    });
    report.peak_bytes = device.peak_memory_bytes() - report.scene_bytes;
    report.statistics = grid_statistics(queue, *grid);
    report.digest = grid->digest(queue);
    if (!options.save_file.empty()) {
        save(queue, *grid, options.save_file);
        report.saved_file = options.save_file;
        report.saved_bytes = std::filesystem::file_size(options.save_file);
    }
    if (options.as_json) print_json(*grid, report);
    else print_text(options.input.name(), *grid, report);
    return exit_ok;
}

}  // namespace

Command add_build_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand("build", "Build a grid and print its figures");
    options->input.add_to(*app);
    add_integer(*app, "--repeat", options->repeats, {1, 100000},
                "builds to take the median of; above 1, another one warms up");
    app->add_option("--save", options->save_file, "write the grid to this file; the library loads it, 'setka validate' checks it")
        ->type_name("FILE");
    app->add_flag("--json", options->as_json, "print JSON");
    add_grid_options(*app, options->grid);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
