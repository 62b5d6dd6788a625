// SPDX-License-Identifier: MIT
/// Can a project that uses the installed package cancel work, and have a picture in passes?
#include <cstdio>
#include <stop_token>

#include "setka/setka.hpp"

int main() {
    setka::Queue queue = setka::Device::open().make_queue();
    std::stop_source stop;
    queue.set_stop_token(stop.get_token());
    stop.request_stop();
    try {
        (void)queue.make_buffer<float>(1000, "not made");
        std::puts("not cancelled");
        return 1;
    } catch (const setka::Error& error) {
        if (error.category() != setka::ErrorCategory::Cancelled) throw;
        std::puts(error.what());
    }
    queue.set_stop_token({});
    const setka::Scene torus = setka::make_scene("torus");
    const setka::DeviceScene scene(queue, torus);
    const setka::Grid grid = setka::make_grid_builder()->build(queue, scene);
    setka::RenderOptions options;
    options.width = 16;
    options.height = 9;
    options.samples_per_axis = 2;
    setka::ProgressiveRender picture(queue, scene, grid, setka::frame(torus.bounds(), 16.0f / 9), options);
    picture.add_pass();
    return picture.passes_done() == 1 && picture.image().srgb.size() == 16u * 9 * 3 ? 0 : 1;
}
