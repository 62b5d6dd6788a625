// SPDX-License-Identifier: MIT
/// What does a picture show, and from where? Options that `render`, `view` and `animate` share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>

#include "setka/renderer.hpp"
#include "setka/scene.hpp"

namespace setka::cli {

/// --eye, --target, --up, --fov, --inside and --ignore-camera.
struct CameraOptions {
    std::optional<Float3> eye, target;
    Float3 up{0, 1, 0};
    std::optional<float> fov_degrees;
    bool inside = false;
    bool ignore_camera = false;

    void add_to(CLI::App& app);
    /// True if the file's camera is not wanted.
    [[nodiscard]] bool is_own() const { return eye || target || inside || ignore_camera; }
    /// The camera that the options ask for, over the file's, over one that frames the bounds, which are asked
    /// for where they are needed.
    [[nodiscard]] Camera choose(const std::optional<Camera>& of_file, const std::function<Bounds()>& bounds,
                                float aspect) const;
};

/// --size, --samples, --depth and --view.
struct PictureOptions {
    std::pair<std::uint32_t, std::uint32_t> size{1280, 720};

    void add_to(CLI::App& app, RenderOptions& render);
    /// Puts the size into the options.
    void complete(RenderOptions& render) const;
};

}  // namespace setka::cli
