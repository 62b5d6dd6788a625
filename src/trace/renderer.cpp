// SPDX-License-Identifier: MIT
/// How is a picture rendered in one call? As a progressive one of which all passes are asked for at once.
#include "setka/renderer.hpp"

#include "trace/pinhole.hpp"

namespace setka {

void check_options(const RenderOptions& options) {
    check_picture(options.width, options.height, options.samples_per_axis);
    check_range("max_depth", options.max_depth, 0, 16);
    check_range("view", static_cast<std::uint32_t>(options.view), 0, static_cast<std::uint32_t>(View::Tests));
    check_range("pixels", static_cast<std::uint32_t>(options.pixels), 0,
                static_cast<std::uint32_t>(Pixels::Srgb));
}

Renderer::Renderer(const RenderOptions& options) : options_(options) { check_options(options); }

Image Renderer::render(Queue& queue, const DeviceScene& scene, const Structure& structure,
                       const Camera& camera) {
    statistics_ = {};
    ProgressiveRender picture(queue, scene, structure, camera, options_);
    picture.finish();
    Image image = picture.image();
    statistics_ = picture.statistics();
    return image;
}

PendingImage Renderer::render_later(Queue& queue, const DeviceScene& scene, const Structure& structure,
                                    const Camera& camera) const {
    ProgressiveRender picture(queue, scene, structure, camera, options_);
    picture.finish();
    return picture.image_later();
}

}  // namespace setka
