// SPDX-License-Identifier: MIT
/// What does a picture show, and from where? See the header.
#include "cli/camera_options.hpp"

#include <tuple>

#include "cli/options.hpp"
#include "cli/scene_input.hpp"
#include "trace/names.hpp"

namespace setka::cli {

Camera CameraOptions::choose(const std::optional<Camera>& of_file, const std::function<Bounds()>& bounds,
                             float aspect) const {
    const auto fov_or = [&](float other) { return fov_degrees.value_or(other); };
    Camera camera;
    if (of_file && !is_own()) {
        camera = *of_file;
        camera.vertical_fov_degrees = fov_or(camera.vertical_fov_degrees);
    } else if (inside) {
        camera = frame_inside(bounds(), fov_or(65));
    } else {
        camera = frame(bounds(), aspect, fov_or(50));
    }
    if (eye) camera.eye = turn_up(*eye, up);
    if (target) camera.target = turn_up(*target, up);
    // Straight up or down, +y is no direction in the picture.
    if (is_own() && camera.eye.x == camera.target.x && camera.eye.z == camera.target.z)
        camera.up = {0, 0, -1};
    return camera;
}

void CameraOptions::add_to(CLI::App& app) {
    const std::string group = "Camera";
    const auto point = [](const std::string& option, const std::string& text) {
        return std::optional(parse_point(option, text));
    };
    add_parsed(app, "--eye", eye, point, "X,Y,Z", "where the camera is")->group(group);
    add_parsed(app, "--target", target, point, "X,Y,Z", "what the camera looks at")->group(group);
    add_parsed(app, "--up", up, parse_axis, "AXIS", "which way is up: x, y, z, -x, -y, -z or X,Y,Z", "y")
        ->group(group);
    const auto angle = [](const std::string& option, const std::string& text) {
        return std::optional(static_cast<float>(parse_number(option, text, {1, 170})));
    };
    add_parsed(app, "--fov", fov_degrees, angle, "DEGREES", "vertical field of view")->group(group);
    app.add_flag("--inside", inside, "look around inside the scene's box")->group(group);
    app.add_flag("--ignore-camera", ignore_camera, "frame the scene even if the file has a camera")
        ->group(group);
}

void PictureOptions::add_to(CLI::App& app, RenderOptions& render) {
    add_parsed(app, "--size", size, parse_size, "WxH", "pixels", "1280x720");
    add_integer(app, "--samples", render.samples_per_axis, {1, 16}, "samples a pixel, along each axis");
    add_integer(app, "--depth", render.max_depth, {0, 16}, "mirror and refraction rays after the first");
    add_choice(app, "--view", render.view, view_names(),
               "what a pixel shows; steps and tests are heat maps of the work a ray makes");
}

void PictureOptions::complete(RenderOptions& render) const { std::tie(render.width, render.height) = size; }

}  // namespace setka::cli
