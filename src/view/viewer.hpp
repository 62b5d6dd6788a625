// SPDX-License-Identifier: MIT
/// How is a scene looked at in a window?
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "setka/scene.hpp"
#include "view/render_thread.hpp"

namespace setka::view {

/// A scene at its first moment, and how it moves.
struct MovingScene {
    Scene scene;
    SceneMotion motion;
};

struct ViewerOptions {
    std::string scene_name;
    std::function<MovingScene()> load;  ///< called once there is a window
    std::function<Camera(const Scene&, float aspect)> choose_camera;
    Settings settings;  ///< what to begin with; the camera is chosen
    RenderThreadOptions rendering;
    std::optional<std::string> script;  ///< a file of commands in place of a person
};

/// Opens the window, and returns when it is closed or the script ends. Throws Unsupported without a display,
/// InvalidData for a script that is not understood, and what loading, devices and builds throw before the
/// first picture.
void run_viewer(const ViewerOptions& options);

}  // namespace setka::view
