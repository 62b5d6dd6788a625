// SPDX-License-Identifier: MIT
/// How does a mesh file become a picture?
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/camera_options.hpp"
#include "cli/command.hpp"
#include "cli/text.hpp"
#include "workload/measure.hpp"
#include "cli/interrupt.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/scene_input.hpp"
#include "cli/structure.hpp"
#include "setka/error.hpp"
#include "setka/io.hpp"
#include "setka/renderer.hpp"

namespace setka::cli {

namespace {

struct Options {
    SceneInput input;
    DeviceSelection device;
    StructureChoice structure;
    RenderOptions render;
    std::string output;
    PictureOptions picture;
    CameraOptions camera;
    ProgressMode progress = ProgressMode::Auto;
    bool as_json = false;
};

struct Times {
    double load_ms = 0, build_ms = 0, render_ms = 0;
};

void print_json(const Options& options, const Device& device, const DeviceScene& scene,
                const Structure& structure, const RenderStatistics& statistics, const Times& times) {
    nlohmann::ordered_json json{
        {"output", options.output},
        {"width", options.render.width},
        {"height", options.render.height},
        {"device", device.info().id},
        {"device_name", device.info().name},
        {"triangles", scene.triangle_count()},
        {"structure", to_string(structure.kind())},
        {"structure_bytes", structure.size_bytes()},
        {"primary_rays", statistics.primary_rays},
        {"secondary_rays", statistics.secondary_rays},
        {"shadow_rays", statistics.shadow_rays},
        {"load_ms", times.load_ms},
        {"build_ms", times.build_ms},
        {"render_ms", times.render_ms},
    };
    if (options.render.view == View::Steps || options.render.view == View::Tests) {
        json["heat_maximum"] = statistics.heat_maximum;
        json["heat_mean"] = statistics.heat_mean;
    }
    fmt::print("{}\n", json.dump(2));
}

void print_text(const Options& options, const Device& device, const DeviceScene& scene,
                const RenderStatistics& statistics, const Times& times) {
    fmt::print("{}: {} x {}, {} triangles on {} ({})\n", options.output, options.render.width,
               options.render.height, grouped(scene.triangle_count()), device.info().id, device.info().name);
    fmt::print("rays: {} primary, {} mirror and refraction, {} shadow\n", grouped(statistics.primary_rays),
               grouped(statistics.secondary_rays), grouped(statistics.shadow_rays));
    fmt::print("seconds: {:.2f} to load, {:.2f} to build, {:.2f} to render\n", times.load_ms / 1000,
               times.build_ms / 1000, times.render_ms / 1000);
    if (options.render.view == View::Steps || options.render.view == View::Tests)
        fmt::print("{} a ray: mean {:.2f}, hottest colour {}\n",
                   options.render.view == View::Steps ? "cells" : "triangle tests", statistics.heat_mean,
                   statistics.heat_maximum);
}

enum class Ending { Complete, Interrupted };

struct Rendered {
    Image image;
    Ending ending = Ending::Complete;
};

/// Adds passes until all are there, or until an interrupt after at least one: what there is then is a picture too.
[[nodiscard]] Rendered add_passes(Queue& queue, ProgressiveRender& picture) {
    try {
        while (picture.passes_done() < picture.passes()) picture.add_pass();
        Image image = picture.image();
        end_interruptible_work();
        return {std::move(image), Ending::Complete};
    } catch (const Error& error) {
        if (error.category() != ErrorCategory::Cancelled || picture.passes_done() == 0) throw;
    }
    queue.set_stop_token({});  // a second interrupt ends the program
    return {picture.image(), Ending::Interrupted};
}

[[nodiscard]] ExitCode run(Options options) {
    options.picture.complete(options.render);
    io::check_image_writable(options.output);
    Progress progress(options.progress);
    options.render.progress = [&](double share) { progress.update("rendering", share); };
    Times times;

    progress.update("loading", 0);
    const workload::Stopwatch load_watch;
    Scene scene = options.input.load();
    turn_up(scene, options.camera.up);
    scene.validate();
    const float aspect = float(options.render.width) / float(options.render.height);
    const Camera camera = options.camera.choose(scene.camera, [&] { return scene.bounds(); }, aspect);
    if (scene.point_lights.empty() && scene.directional_lights.empty()) add_default_lights(scene, camera);
    times.load_ms = load_watch.elapsed_ms();

    const Device device = options.device.open();
    Queue queue = make_interruptible_queue(device);
    progress.update("building", 0);
    const workload::Stopwatch build_watch;
    const DeviceScene device_scene(queue, scene);
    scene = {};
    const auto structure = options.structure.build(queue, device_scene);
    queue.finish();
    times.build_ms = build_watch.elapsed_ms();

    const workload::Stopwatch render_watch;
    ProgressiveRender picture(queue, device_scene, *structure, camera, options.render);
    const auto [image, ending] = add_passes(queue, picture);
    times.render_ms = render_watch.elapsed_ms();
    io::write_image(options.output, image);
    progress.clear();
    if (ending == Ending::Interrupted) {
        fmt::print(stderr, "setka: interrupted; {} has {} of {} samples a pixel\n", options.output,
                   picture.passes_done(), picture.passes());
        return exit_interrupted;
    }
    if (options.as_json) print_json(options, device, device_scene, *structure, picture.statistics(), times);
    else print_text(options, device, device_scene, picture.statistics(), times);
    return exit_ok;
}

}  // namespace

Command add_render_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand("render", "Render a picture");
    options->input.add_to(*app);
    app->add_option("-o,--output", options->output,
                    "picture to write: PNG, JPEG, TIFF, BMP, TGA, PPM, EXR, HDR or PFM")
        ->type_name("FILE")
        ->required();
    options->picture.add_to(*app, options->render);
    add_progress_option(*app, options->progress);
    app->add_flag("--json", options->as_json, "print JSON");
    options->camera.add_to(*app);
    options->structure.add_to(*app);
    add_step_option(*app, options->render.trace.step);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
