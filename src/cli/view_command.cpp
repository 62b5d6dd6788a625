// SPDX-License-Identifier: MIT
/// How is a scene looked at in a window? By the viewer, where the build has it.
#include <memory>
#include <tuple>

#include "cli/camera_options.hpp"
#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/scene_input.hpp"
#include "setka/error.hpp"
#ifdef SETKA_HAS_VIEWER
#include "view/viewer.hpp"
#endif

namespace setka::cli {

namespace {

struct Options {
    SceneInput input;
    DeviceSelection device;
    GridOptions grid;
    CameraOptions camera;
    RenderOptions render;
    std::string script;
    PictureOptions picture;

    Options() { render.samples_per_axis = 4; }
};

#ifdef SETKA_HAS_VIEWER
[[nodiscard]] ExitCode run(const Options& options) {
    view::ViewerOptions viewer;
    viewer.scene_name = options.input.name();
    viewer.load = [&] {
        Scene scene = options.input.load();
        turn_up(scene, options.camera.up);
        return scene;
    };
    viewer.choose_camera = [&](const Scene& scene, float aspect) {
        return options.camera.choose(
            scene.camera, [&] { return scene.bounds(); }, aspect);
    };
    viewer.settings.device = options.device.selector;
    viewer.settings.density = options.grid.density;
    viewer.settings.view = options.render.view;
    viewer.settings.step = options.render.trace.step;
    viewer.settings.samples_per_axis = options.render.samples_per_axis;
    std::tie(viewer.settings.width, viewer.settings.height) = options.picture.size;
    viewer.rendering = {options.device.options, options.grid, options.render.max_depth};
    if (!options.script.empty()) viewer.script = options.script;
    view::run_viewer(viewer);
    return exit_ok;
}
#else
[[nodiscard]] ExitCode run(const Options&) {
    throw Error(
        ErrorCategory::Unsupported,
        "this build has no viewer; install libglfw3-dev, libgl-dev and libimgui-dev and configure with "
        "-DSETKA_VIEWER=ON");
}
#endif

}  // namespace

Command add_view_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app = program.add_subcommand("view", "Look at a scene in a window");
    options->input.add_to(*app);
    options->picture.add_to(*app, options->render);
    app->add_option("--script", options->script, "commands, one a line, in place of a person; see the README")
        ->type_name("FILE");
    options->camera.add_to(*app);
    add_grid_options(*app, options->grid);
    add_step_option(*app, options->render.trace.step);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
