// SPDX-License-Identifier: MIT
/// How does a mesh file become a picture?
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

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
    std::pair<std::uint32_t, std::uint32_t> size{1280, 720};
    std::optional<Float3> eye, target;
    Float3 up{0, 1, 0};
    std::optional<float> fov_degrees;
    bool inside = false;
    bool ignore_camera = false;
    ProgressMode progress = ProgressMode::Auto;
    bool as_json = false;
};

/// The camera that the options ask for, over the file's, over one that frames the scene.
[[nodiscard]] Camera choose_camera(const Scene& scene, const Options& options) {
    const bool is_own = options.eye || options.target || options.inside || options.ignore_camera;
    const auto fov_or = [&](float other) { return options.fov_degrees.value_or(other); };
    Camera camera;
    if (scene.camera && !is_own) {
        camera = *scene.camera;
        camera.vertical_fov_degrees = fov_or(camera.vertical_fov_degrees);
    } else if (options.inside) {
        camera = frame_inside(scene.bounds(), fov_or(65));
    } else {
        const float aspect = float(options.render.width) / float(options.render.height);
        camera = frame(scene.bounds(), aspect, fov_or(50));
    }
    if (options.eye) camera.eye = turn_up(*options.eye, options.up);
    if (options.target) camera.target = turn_up(*options.target, options.up);
    // Straight up or down, +y is no direction in the picture.
    if (is_own && camera.eye.x == camera.target.x && camera.eye.z == camera.target.z) camera.up = {0, 0, -1};
    return camera;
}

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
    std::tie(options.render.width, options.render.height) = options.size;
    io::check_image_writable(options.output);
    Progress progress(options.progress);
    options.render.progress = [&](double share) { progress.update("rendering", share); };
    Times times;

    progress.update("loading", 0);
    const workload::Stopwatch load_watch;
    Scene scene = options.input.load();
    turn_up(scene, options.up);
    scene.validate();
    const Camera camera = choose_camera(scene, options);
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

void add_camera_options(CLI::App& app, Options& options) {
    const std::string group = "Camera";
    const auto point = [](const std::string& option, const std::string& text) {
        return std::optional(parse_point(option, text));
    };
    add_parsed(app, "--eye", options.eye, point, "X,Y,Z", "where the camera is")->group(group);
    add_parsed(app, "--target", options.target, point, "X,Y,Z", "what the camera looks at")->group(group);
    add_parsed(app, "--up", options.up, parse_axis, "AXIS", "which way is up: x, y, z, -x, -y, -z or X,Y,Z",
               "y")
        ->group(group);
    const auto angle = [](const std::string& option, const std::string& text) {
        return std::optional(static_cast<float>(parse_number(option, text, {1, 170})));
    };
    add_parsed(app, "--fov", options.fov_degrees, angle, "DEGREES", "vertical field of view")->group(group);
    app.add_flag("--inside", options.inside, "look around inside the scene's box")->group(group);
    app.add_flag("--ignore-camera", options.ignore_camera, "frame the scene even if the file has a camera")
        ->group(group);
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
    add_parsed(*app, "--size", options->size, parse_size, "WxH", "pixels", "1280x720");
    add_integer(*app, "--samples", options->render.samples_per_axis, {1, 16},
                "samples a pixel, along each axis");
    add_integer(*app, "--depth", options->render.max_depth, {0, 16},
                "mirror and refraction rays after the first");
    add_choice<View>(*app, "--view", options->render.view,
                     {{"shaded", View::Shaded},
                      {"normals", View::Normals},
                      {"depth", View::Depth},
                      {"steps", View::Steps},
                      {"tests", View::Tests}},
                     "what a pixel shows; steps and tests are heat maps of the work a ray makes");
    add_progress_option(*app, options->progress);
    app->add_flag("--json", options->as_json, "print JSON");
    add_camera_options(*app, *options);
    options->structure.add_to(*app);
    add_step_option(*app, options->render.trace.step);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
