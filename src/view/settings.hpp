// SPDX-License-Identifier: MIT
/// What is to be shown, and what is shown? Values that the window and the thread that renders hand each
/// other.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "setka/grid.hpp"
#include "setka/renderer.hpp"
#include "setka/scene.hpp"

namespace setka::view {

/// How a scene moves.
struct SceneMotion {
    double first = 0, last = 0;  ///< moments: seconds, or numbers of frames; equal where nothing moves
    enum class Unit { Seconds, Frames } unit = Unit::Seconds;
    /// What stands where at a moment; called by the thread that renders.
    std::function<SceneUpdate(double)> at;

    [[nodiscard]] bool is_still() const { return first == last; }
};

/// What one wishes to see. A change of any of it is another picture.
struct Settings {
    Float3 eye, target, up;
    float vertical_fov_degrees = 50;
    std::string device;  ///< an id; to begin with whatever Device::open takes
    double moment = 0;    ///< of the scene's motion
    float density = 8;
    View view = View::Shaded;
    GridStep step = GridStep::Dda;
    std::uint32_t samples_per_axis = 4;
    std::uint32_t width = 1280, height = 720;

    friend bool operator==(const Settings&, const Settings&) = default;
    [[nodiscard]] Camera camera() const { return {eye, target, up, vertical_fov_degrees}; }
    void look_through(const Camera& camera) {
        eye = camera.eye, target = camera.target, up = camera.up;
        vertical_fov_degrees = camera.vertical_fov_degrees;
    }
};

/// Whether something is still changing: pictures are small then, so that they come often.
enum class Motion { Still, Moving };

/// Milliseconds of the stages that led to a picture.
struct StageTimes {
    double upload = 0, build = 0, trace = 0, shade = 0;
};

/// What a picture was made with.
struct Facts {
    std::string device, device_name;
    float density = 0;
    double moment = 0;
    std::uint32_t triangles = 0, dims[3] = {0, 0, 0};
    std::uint64_t cells = 0, pairs = 0, structure_bytes = 0, device_bytes = 0;
};

/// One picture, and what there is to say of it.
struct Frame {
    std::uint64_t order = 0;  ///< of the settings that it answers
    Image image;              ///< sRGB alone; smaller than was asked for while something moves
    std::uint32_t passes_done = 0,
                  passes = 0;  ///< 0 done: a first picture of one sample, in the middle of each pixel
    RenderStatistics statistics;
    StageTimes times;
    Facts facts;
    std::string trouble;  ///< why the settings are not all in effect; empty if they are
};

}  // namespace setka::view
