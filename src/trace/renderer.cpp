// SPDX-License-Identifier: MIT
/// How does a picture come about? In batches of pixels that fit the device, each traced, shaded, averaged and
/// encoded there.
#include "setka/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <string>

#include "core/launch.hpp"
#include "setka/error.hpp"
#include "trace/pinhole.hpp"
#include "trace/shading_tables.hpp"
#include "trace/whitted.hpp"

namespace setka {

namespace {

/// Primary rays of a batch, samples included, unless one pixel has more: enough to fill a GPU, 200 bytes each
/// on the way.
constexpr std::uint64_t batch_rays = 1u << 20;

/// One picture in the making: what every view needs.
class Picture {
  public:
    Picture(Queue& queue, const RenderOptions& options, const Camera& camera)
        : queue_(queue),
          options_(options),
          camera_(make_pinhole(camera, options.width, options.height, options.samples_per_axis)),
          samples_(options.samples_per_axis * options.samples_per_axis) {
        const auto thresholds = make_srgb_thresholds();
        thresholds_ = queue.upload(std::span<const float>(thresholds), "sRGB thresholds");
        image_.width = options.width;
        image_.height = options.height;
        image_.linear.resize(pixel_count());
        image_.srgb.resize(3 * pixel_count());
    }

    [[nodiscard]] std::uint64_t pixel_count() const {
        return std::uint64_t(options_.width) * options_.height;
    }
    [[nodiscard]] std::uint32_t samples() const { return samples_; }
    [[nodiscard]] Queue& queue() const { return queue_; }
    [[nodiscard]] Image take() { return std::move(image_); }

    /// Calls work(first pixel, pixels) for the whole picture. What does not fit the device's memory is tried
    /// again in halves, down to one pixel: batches do not show in the picture, since no pixel depends on
    /// another.
    template <typename Work>
    void for_each_batch(const Work& work) const {
        for_each_batch(batch_rays / samples_, work, options_.progress);
    }

    /// The same in batches of at most `size` pixels.
    template <typename Work>
    void for_each_batch(std::uint64_t size, const Work& work,
                        const std::function<void(double)>& progress = {}) const {
        const std::uint64_t all = pixel_count();
        size = std::clamp<std::uint64_t>(size, 1, all);
        for (std::uint64_t first = 0; first < all;) {
            const std::uint64_t count = std::min(size, all - first);
            try {
                work(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count));
            } catch (const Error& error) {
                if (error.category() != ErrorCategory::OutOfMemory || count == 1) throw;
                size = (count + 1) / 2;
                continue;
            }
            first += count;
            if (progress) progress(double(first) / double(all));
        }
    }

    [[nodiscard]] Buffer<Ray> rays(std::uint32_t first, std::uint32_t count) const {
        auto rays = queue_.make_buffer<Ray>(std::size_t(count) * samples_, "rays");
        queue_.impl().begin_stage("camera rays");
        launch_items(queue_, Kernel::shade_camera_rays, count * samples_, camera_, first, rays);
        return rays;
    }

    /// Averages the samples' colours of `count` pixels and stores them.
    void store_colours(std::uint32_t first, std::uint32_t count, const Buffer<float>& colours) {
        const auto linear = queue_.make_buffer<Float3>(count, "pixels");
        queue_.impl().begin_stage("resolve");
        launch_items(queue_, Kernel::shade_resolve, count, samples_, colours, linear);
        store(first, count, linear);
    }

    /// Stores `count` finished pixels.
    void store(std::uint32_t first, std::uint32_t count, const Buffer<Float3>& linear) {
        const auto codes = queue_.make_buffer<std::uint8_t>(std::size_t(count) * 3, "sRGB codes");
        launch_items(queue_, Kernel::shade_encode, count * 3, linear, thresholds_, codes);
        queue_.download(linear, std::span(image_.linear).subspan(first, count));
        queue_.download(codes,
                        std::span(image_.srgb).subspan(std::size_t(first) * 3, std::size_t(count) * 3));
    }

  private:
    Queue& queue_;
    const RenderOptions& options_;
    SkCamera camera_;
    std::uint32_t samples_;
    Buffer<float> thresholds_;
    Image image_;
};

void render_shaded(Picture& picture, const WhittedPasses& passes, RenderStatistics& statistics) {
    picture.for_each_batch([&](std::uint32_t first, std::uint32_t count) {
        RayCounts traced;
        picture.store_colours(first, count, passes.colours(picture.rays(first, count), traced));
        statistics.secondary_rays += traced.secondary;
        statistics.shadow_rays += traced.shadow;
    });
}

void render_normals(Picture& picture, const WhittedPasses& passes) {
    Queue& queue = picture.queue();
    picture.for_each_batch([&](std::uint32_t first, std::uint32_t count) {
        const auto points = passes.surfaces(picture.rays(first, count));
        const auto colours = queue.make_buffer<float>(3 * points.size(), "colours");
        queue.impl().begin_stage("view");
        launch_items(queue, Kernel::shade_normals, static_cast<std::uint32_t>(points.size()), points,
                     colours);
        picture.store_colours(first, count, colours);
    });
}

/// One number a pixel: what the picture's scale, and so every colour, depends on.
std::vector<float> measure(Picture& picture, const Structure& structure, const Tracer& tracer, View view) {
    Queue& queue = picture.queue();
    std::vector<float> all(picture.pixel_count());
    picture.for_each_batch([&](std::uint32_t first, std::uint32_t count) {
        const auto rays = picture.rays(first, count);
        const auto values = queue.make_buffer<float>(count, "pixel values");
        if (view == View::Depth) {
            const auto hits = queue.make_buffer<Hit>(rays.size(), "hits");
            tracer.closest_hit(queue, structure, rays, hits);
            queue.impl().begin_stage("view");
            launch_items(queue, Kernel::shade_depth, count, picture.samples(), hits, values);
        } else {
            const auto costs = queue.make_buffer<TraceCost>(rays.size(), "trace costs");
            tracer.closest_hit_cost(queue, structure, rays, costs);
            queue.impl().begin_stage("view");
            launch_items(queue, Kernel::shade_cost, count, picture.samples(),
                         std::uint32_t(view == View::Tests), costs, values);
        }
        queue.download(values, std::span(all).subspan(first, count));
    });
    return all;
}

void render_measure(Picture& picture, const Structure& structure, const Tracer& tracer, View view,
                    RenderStatistics& statistics) {
    Queue& queue = picture.queue();
    const std::vector<float> values = measure(picture, structure, tracer, view);
    float maximum = std::max(0.0f, *std::max_element(values.begin(), values.end()));
    if (view != View::Depth) {
        double sum = 0;
        for (const float value : values) sum += value;
        statistics.heat_mean = sum / double(values.size());
        statistics.heat_maximum = static_cast<std::uint32_t>(std::min(std::ceil(maximum), 4294967040.0f));
        maximum = static_cast<float>(statistics.heat_maximum);
    }
    const std::vector<float> knots = view == View::Depth ? make_depth_ramp() : make_heat_ramp();
    const auto ramp = queue.upload(std::span(knots), "colour ramp");
    // One value a pixel, whatever the number of samples.
    picture.for_each_batch(batch_rays, [&](std::uint32_t first, std::uint32_t count) {
        const auto part = queue.upload(std::span(values).subspan(first, count), "pixel values");
        const auto linear = queue.make_buffer<Float3>(count, "pixels");
        queue.impl().begin_stage("view");
        launch_items(queue, Kernel::shade_ramp, count, part, maximum, ramp,
                     static_cast<std::uint32_t>(knots.size() / 3), linear);
        picture.store(first, count, linear);
    });
}

/// A structure built of the scene shares its table; one that was loaded has its own, which must be the same: hits name triangles
/// within instances, and shading looks them up in the scene.
void check_instances(Queue& queue, const DeviceScene& scene, const WorldGeometry& geometry) {
    if (geometry.instance_starts.memory() == scene.instance_starts().memory()) return;
    const auto mine = queue.download(geometry.instance_starts), other = queue.download(scene.instance_starts());
    const auto [a, b] = std::ranges::mismatch(mine, other);
    if (a == mine.end() && b == other.end()) return;
    throw Error(ErrorCategory::InvalidArgument,
                "structure and scene part at instance " + std::to_string(a - mine.begin()) +
                    ", which starts at another triangle; the structure must be built of the scene");
}

}  // namespace

Renderer::Renderer(const RenderOptions& options) : options_(options) {
    check_picture(options.width, options.height, options.samples_per_axis);
    check_range("max_depth", options.max_depth, 0, 16);
    check_range("view", static_cast<std::uint32_t>(options.view), 0, static_cast<std::uint32_t>(View::Tests));
}

Image Renderer::render(Queue& queue, const DeviceScene& scene, const Structure& structure,
                       const Camera& camera) {
    const auto start = std::chrono::steady_clock::now();
    scene.check_committed();
    const WorldGeometry& geometry = structure.geometry();
    if (geometry.triangle_count != scene.triangle_count() ||
        geometry.instance_count != scene.instance_count())
        throw Error(ErrorCategory::InvalidArgument,
                    "structure has " + std::to_string(geometry.triangle_count) + " triangles in " +
                        std::to_string(geometry.instance_count) + " instances, scene has " +
                        std::to_string(scene.triangle_count()) + " in " +
                        std::to_string(scene.instance_count()) +
                        "; the structure must be built of the scene");
    check_instances(queue, scene, geometry);
    statistics_ = {};
    Picture picture(queue, options_, camera);
    statistics_.primary_rays = picture.pixel_count() * picture.samples();

    if (options_.view == View::Shaded || options_.view == View::Normals) {
        const WhittedPasses passes(queue, scene, structure, options_.trace, options_.max_depth);
        if (options_.view == View::Shaded) render_shaded(picture, passes, statistics_);
        else render_normals(picture, passes);
    } else {
        TraceOptions trace = options_.trace;
        trace.mask = camera_mask(trace.mask);
        render_measure(picture, structure, Tracer(trace), options_.view, statistics_);
    }
    statistics_.wall_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return picture.take();
}

}  // namespace setka
