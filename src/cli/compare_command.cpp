// SPDX-License-Identifier: MIT
/// Do all devices compute the same bytes, and how fast is each? Every device builds, traces and renders; the
/// first is the reference of the others.
#include <algorithm>
#include <memory>

#include "cli/command.hpp"
#include "cli/compare_report.hpp"
#include "cli/compare_rows.hpp"
#include "cli/options.hpp"
#include "cli/primitive_shapes.hpp"
#include "cli/progress.hpp"
#include "cli/scene_input.hpp"
#include "setka/error.hpp"

namespace setka::cli {

namespace {

struct Options {
    SceneInput input;
    std::vector<RowChoice> devices;  ///< empty: default_rows()
    CompareWork work;
    bool inside = false;
    ProgressMode progress = ProgressMode::Auto;
    bool as_json = false;
};

/// A row and its device, which is held until it has been used.
struct OpenRow {
    CompareRow row;
    std::optional<Device> device;
};

/// Opens the device. That there is none of that name is the user's mistake; that it does not work is the
/// row's result.
[[nodiscard]] OpenRow open_row(const RowChoice& choice) {
    OpenRow opened;
    opened.row.label = choice.to_string();
    try {
        opened.device = Device::open(choice.selector, {.primitives = choice.primitives});
        opened.row.device = opened.device->info();
        opened.row.primitives = to_string(opened.device->options().primitives);
        opened.row.label = opened.row.device.id + '/' + opened.row.primitives;
    } catch (const Error& error) {
        if (error.category() == ErrorCategory::InvalidArgument)
            throw Error(error.category(), std::string("--devices: ") + error.what());
        opened.row.error = error.what();
    }
    return opened;
}

[[nodiscard]] std::vector<OpenRow> open_rows(std::vector<RowChoice> choices) {
    if (choices.empty()) choices = default_rows(enumerate_devices());
    if (choices.empty()) (void)Device::open();  // throws, and says why there is none
    std::vector<OpenRow> rows;
    for (const RowChoice& choice : choices) rows.push_back(open_row(choice));
    return rows;
}

/// Whether the scene or the options are to blame, rather than the device.
[[nodiscard]] bool is_about_input(const Error& error) {
    return error.category() == ErrorCategory::InvalidArgument ||
           error.category() == ErrorCategory::InvalidData;
}

/// A scene with lights, seen by the standard camera.
struct LitScene {
    Scene scene;
    workload::StandardView view;
};

[[nodiscard]] LitScene load(const Options& options) {
    LitScene lit{options.input.load(), {}};
    lit.scene.validate();
    lit.view = workload::standard_view(lit.scene.bounds(), options.work.viewpoint);
    if (lit.scene.point_lights.empty() && lit.scene.directional_lights.empty())
        add_default_lights(lit.scene, lit.view.camera);
    return lit;
}

/// Runs the rows one after the other. Only the reference's answers are kept, so that two fit in memory and no
/// more are needed.
[[nodiscard]] CompareReport compare(std::vector<OpenRow> rows, const LitScene& lit, const Options& options) {
    CompareReport report{options.input.name(), lit.scene.triangle_count(), {}, {}, {}, 0};
    workload::Answers reference;
    Progress progress(options.progress);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CompareRow& row = rows[i].row;
        const auto show = [&](std::string_view part, double share) {
            progress.update(row.label, share, std::string(part));
        };
        try {
            if (!row.error.empty()) continue;
            DeviceRun run = run_on_device(*rows[i].device, lit.scene, lit.view, options.work, show);
            row.build = std::move(run.build);
            row.steps = std::move(run.steps);
            if (!report.reference) {
                report.reference = i;
                report.grid = run.answers.tables.header;
                reference = std::move(run.answers);
                row.difference = first_difference(reference, reference);
            } else {
                row.difference = first_difference(reference, run.answers);
            }
        } catch (const Error& error) {
            if (!report.reference && is_about_input(error)) throw;
            row.error = error.what();
        }
        rows[i].device.reset();
    }
    for (OpenRow& opened : rows) report.rows.push_back(std::move(opened.row));
    return report;
}

[[nodiscard]] ExitCode run(Options options) {
    if (options.inside) options.work.viewpoint = workload::Viewpoint::Inside;
    const workload::Stopwatch watch;
    std::vector<OpenRow> rows =
        open_rows(options.devices);  // before a large scene is read: a wrong name is found at once
    const LitScene lit = load(options);
    CompareReport report = compare(std::move(rows), lit, options);
    report.wall_ms = watch.elapsed_ms();
    if (options.as_json) print_json(report, options.work);
    else print_text(report, options.work);
    return report.is_equal() ? exit_ok : exit_check_failed;
}

}  // namespace

Command add_compare_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand(
        "compare",
        "Compare devices: tables, rays, hits and pictures byte for byte, and times; exit 1 if any differs");
    options->input.add_to(*app);
    add_parsed(
        *app, "--devices", options->devices, parse_rows, "ID[/SHAPE],...",
        "two or more devices, the first is the reference; SHAPE says how scan, sort and bounds are done: " +
            primitive_shape_words() +
            ". Without this option: every device, CUDA devices as /library and as /portable; an OpenCL "
            "device "
            "that is alone as /serial and as /group");
    add_choice<std::vector<GridStep>>(*app, "--step", options->work.steps,
                                      {{"both", {GridStep::Dda, GridStep::BranchFree}},
                                       {"dda", {GridStep::Dda}},
                                       {"branch-free", {GridStep::BranchFree}}},
                                      "how a ray moves from cell to cell");
    add_integer(*app, "--size", options->work.rays_size, {1, 4096},
                "primary rays along each side of a square");
    app->add_flag("--inside", options->inside, "look from inside the scene's box");
    add_parsed(*app, "--image-size", options->work.image_size, parse_size, "WxH", "pixels of the picture",
               "320x180");
    add_integer(*app, "--repeat", options->work.repeats, {1, 100000},
                "runs to take the median time of; above 1, another one warms up");
    add_progress_option(*app, options->progress);
    app->add_flag("--json", options->as_json, "print JSON");
    add_grid_options(*app, options->work.grid);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
