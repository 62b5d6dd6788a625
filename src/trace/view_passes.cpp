// SPDX-License-Identifier: MIT
#include "trace/view_passes.hpp"

#include "core/launch.hpp"

namespace setka {

namespace {

TraceOptions for_camera(TraceOptions trace) {
    trace.mask = camera_mask(trace.mask);
    return trace;
}

}  // namespace

ViewPasses::ViewPasses(Queue& queue, const DeviceScene& scene, const Structure& structure,
                       const RenderOptions& options)
    : queue_(queue), structure_(structure), view_(options.view), tracer_(for_camera(options.trace)) {
    if (!is_measure(view_)) whitted_.emplace(queue, scene, structure, options.trace, options.max_depth);
}

std::uint32_t ViewPasses::floats_per_pixel(View view) {
    if (!is_measure(view)) return 3;
    return view == View::Depth ? 2 : 1;  // with a number of hits, or not
}

Buffer<float> ViewPasses::ray_colours(const SampleRays& samples, RayCounts& count) const {
    if (view_ == View::Shaded) return whitted_->colours(samples.rays, count);
    const auto points = whitted_->surfaces(samples.rays);
    auto colours = queue_.make_buffer<float>(3 * points.size(), "colours");
    queue_.impl().begin_stage("view");
    launch_items(queue_, Kernel::shade_normals, static_cast<std::uint32_t>(points.size()), points, colours);
    return colours;
}

void ViewPasses::add(const SampleRays& samples, const SampleSums::Part& sums, RayCounts& count) const {
    const auto [rays, pixels, done, each] = samples;
    if (!is_measure(view_)) {
        const auto colours = ray_colours(samples, count);
        queue_.impl().begin_stage("resolve");
        launch_items(queue_, Kernel::shade_add_colours, pixels, sums.first, done, each, colours, sums.before,
                     sums.after);
    } else if (view_ == View::Depth) {
        const auto hits = queue_.make_buffer<Hit>(rays.rays.size(), "hits");
        tracer_.closest_hit(queue_, structure_, rays, hits);
        queue_.impl().begin_stage("view");
        launch_items(queue_, Kernel::shade_add_depths, pixels, sums.first, done, each, hits, sums.before,
                     sums.after);
    } else {
        const auto costs = queue_.make_buffer<TraceCost>(rays.rays.size(), "trace costs");
        tracer_.closest_hit_cost(queue_, structure_, rays, costs);
        queue_.impl().begin_stage("view");
        launch_items(queue_, Kernel::shade_add_costs, pixels, sums.first, done, each,
                     std::uint32_t(view_ == View::Tests), costs, sums.before, sums.after);
    }
}

Buffer<Float3> ViewPasses::colours(std::uint32_t pixels, std::uint32_t done,
                                   const SampleSums::Part& sums) const {
    auto linear = queue_.make_buffer<Float3>(pixels, "pixels");
    queue_.impl().begin_stage("resolve");
    launch_items(queue_, Kernel::shade_mean_colour, pixels, sums.first, done, sums.before, linear);
    return linear;
}

Buffer<float> ViewPasses::values(std::uint32_t pixels, std::uint32_t done,
                                 const SampleSums::Part& sums) const {
    auto values = queue_.make_buffer<float>(pixels, "pixel values");
    queue_.impl().begin_stage("view");
    if (view_ == View::Depth)
        launch_items(queue_, Kernel::shade_mean_depth, pixels, sums.first, sums.before, values);
    else launch_items(queue_, Kernel::shade_mean_cost, pixels, sums.first, done, sums.before, values);
    return values;
}

}  // namespace setka
