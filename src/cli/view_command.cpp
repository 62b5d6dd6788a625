// SPDX-License-Identifier: MIT
/// How is a scene looked at in a window? By the viewer, where the build has it.
#include <memory>
#include <tuple>

#include "cli/camera_options.hpp"
#include "cli/command.hpp"
#include "cli/footage.hpp"
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
    std::string script, animation;
    PictureOptions picture;

    Options() { render.samples_per_axis = 4; }
};

#ifdef SETKA_HAS_VIEWER
/// One file, pattern or folder may move; several files are one scene, as for `render`.
[[nodiscard]] view::MovingScene load(const Options& options) {
    if (options.input.files.size() > 1) {
        if (!options.animation.empty())
            throw Error(ErrorCategory::InvalidArgument,
                        "--animation " + options.animation + ": accepted with one file, not with several");
        Scene scene = options.input.load();
        turn_up(scene, options.camera.up);
        return {std::move(scene), {}};
    }
    const auto footage = std::make_shared<const Footage>(options.input, options.animation, options.camera.up);
    const auto [first, last] = footage->span();
    using Unit = view::SceneMotion::Unit;
    return {footage->scene(),
            {first, last, footage->kind() == io::MotionKind::Sequence ? Unit::Frames : Unit::Seconds,
             [footage](double moment) { return footage->at(moment); }}};
}

[[nodiscard]] ExitCode run(const Options& options) {
    view::ViewerOptions viewer;
    viewer.scene_name = options.input.name();
    viewer.load = [&] { return load(options); };
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
    options->input.add_to(*app,
                          "mesh files, all in one scene; or one glTF file with animation, a folder or a pattern such as "
                          "cloth%03d.ply of frames");
    app->add_option("--animation", options->animation, "one of a glTF file, by name or number; else the first")
        ->type_name("NAME");
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
