// SPDX-License-Identifier: MIT
/// How does a picture come about? In passes over its pixels, in batches of rays that fit the device; sums of
/// samples become colours and codes there when a picture is asked for.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/launch.hpp"
#include "setka/error.hpp"
#include "setka/renderer.hpp"
#include "trace/pending_image.hpp"
#include "trace/pinhole.hpp"
#include "trace/shading_tables.hpp"
#include "trace/view_passes.hpp"

namespace setka {

namespace {

/// Rays of a batch, unless one pixel has more: a picture of 1920 x 1080 pixels is one batch. Some 200 bytes
/// each on the way.
constexpr std::uint64_t batch_rays = 1u << 21;
/// Batches whose shadow rays wait to be counted.
constexpr std::size_t most_pending_counts = 64;

/// A structure built of the scene shares its table; one that was loaded has its own, which must be the same:
/// hits name triangles within instances, and shading looks them up in the scene.
void check_instances(Queue& queue, const DeviceScene& scene, const WorldGeometry& geometry) {
    if (geometry.instances.memory() == scene.instances().memory()) return;
    const auto mine = queue.download(geometry.instance_starts),
               other = queue.download(scene.instance_starts());
    const auto [a, b] = std::ranges::mismatch(mine, other);
    const auto refuse = [](std::ptrdiff_t instance, const char* why) {
        throw Error(ErrorCategory::InvalidArgument, "structure and scene part at instance " + std::to_string(instance) +
                                                        ", which " + why +
                                                        "; the structure must be built of the scene as it is");
    };
    if (a != mine.end() || b != other.end()) refuse(a - mine.begin(), "starts at another triangle");
    const auto built = queue.download(geometry.instances), now = queue.download(scene.instances());
    const auto [c, d] = std::ranges::mismatch(built, now, [](const ::SetkaInstance& x, const ::SetkaInstance& y) {
        return std::ranges::equal(x.matrix, y.matrix);
    });
    if (c != built.end() || d != now.end()) refuse(c - built.begin(), "is placed elsewhere");
}

void check_structure(Queue& queue, const DeviceScene& scene, const WorldGeometry& geometry) {
    scene.check_committed();
    if (geometry.triangle_count != scene.triangle_count() ||
        geometry.instance_count != scene.instance_count())
        throw Error(ErrorCategory::InvalidArgument,
                    "structure has " + std::to_string(geometry.triangle_count) + " triangles in " +
                        std::to_string(geometry.instance_count) + " instances, scene has " +
                        std::to_string(scene.triangle_count()) + " in " +
                        std::to_string(scene.instance_count()) +
                        "; the structure must be built of the scene");
    check_instances(queue, scene, geometry);
}

}  // namespace

class ProgressiveRender::Impl {
  public:
    Impl(Queue& queue, const DeviceScene& scene, const Structure& structure, const Camera& camera,
         const RenderOptions& options)
        : queue_(queue),
          scene_(scene),
          structure_(structure),
          options_(options),
          pixels_(std::uint64_t(options.width) * options.height),
          passes_(options.samples_per_axis * options.samples_per_axis),
          sums_(queue, pixels_, ViewPasses::floats_per_pixel(options.view), passes_) {
        const Timer timer(statistics_.wall_ms);
        thresholds_ = queue_.upload(std::span<const float>(srgb_thresholds()), "sRGB thresholds");
        begin(camera);
    }

    void restart(const Camera& camera) {
        statistics_ = {};
        const Timer timer(statistics_.wall_ms);
        begin(camera);
    }

    /// Adds `samples` to each pixel, no more than are left.
    void add(std::uint32_t samples) {
        samples = std::min(samples, passes_ - done_);
        if (samples == 0) return;
        check_same_scene();
        const Timer timer(statistics_.wall_ms);
        RayCounts counts;
        const auto work = [&](std::uint32_t first, std::uint32_t count) {
            RayCounts traced;
            sums_.add(first, count, [&](const SampleSums::Part& part) {
                view_->add({rays(first, count, samples), count, done_, samples}, part, traced);
            });
            counts.add(std::move(traced));
            if (counts.pending_shadow.size() > most_pending_counts) counts.collect(queue_);
            if (options_.progress)
                options_.progress((double(done_) + samples * (double(first + count) / double(pixels_))) /
                                  passes_);
        };
        for_each_batch(add_batch_, batch_rays / samples, work);
        sums_.end_pass();
        done_ += samples;
        counts_.add(std::move(counts));
        if (counts_.pending_shadow.size() > most_pending_counts) counts_.collect(queue_);
    }

    void finish() { add(passes_); }

    [[nodiscard]] std::unique_ptr<PendingImage::Impl> fetch(Fetch fetch) {
        if (done_ == 0)
            throw Error(ErrorCategory::InvalidArgument,
                        "a picture of 0 passes was asked for; at least one must have been added");
        RenderStatistics statistics = statistics_;
        statistics.primary_rays = pixels_ * done_;
        statistics.secondary_rays = counts_.secondary;
        statistics.shadow_rays = counts_.shadow;
        auto pending = std::make_unique<PendingImage::Impl>(options_, statistics, fetch);
        const Timer timer(pending->statistics().wall_ms);
        if (ViewPasses::is_measure(options_.view)) store_measures(*pending);
        else store_colours(*pending);
        for (const auto& numbers : counts_.pending_shadow) pending->add_shadow_rays(queue_, numbers);
        return pending;
    }

    /// A picture that was asked for last has come, with these numbers.
    void note(const RenderStatistics& statistics) {
        statistics_ = statistics;
        counts_.shadow = statistics.shadow_rays;
        counts_.pending_shadow.clear();
    }

    [[nodiscard]] std::uint32_t passes() const { return passes_; }
    [[nodiscard]] std::uint32_t passes_done() const { return done_; }
    [[nodiscard]] const RenderStatistics& statistics() const { return statistics_; }

  private:
    void begin(const Camera& camera) {
        done_ = 0;
        counts_ = {};
        sums_.clear();
        pinhole_ = make_pinhole(camera, options_.width, options_.height, options_.samples_per_axis);
        check_structure(queue_, scene_, structure_.geometry());
        instances_ = scene_.instances();
        view_.emplace(queue_, scene_, structure_, options_);
    }

    /// Throws if instances have changed since begin(): hits, materials and shading tables would be of different moments. A
    /// table that somebody holds is never written, so that one that is still there is what it was.
    void check_same_scene() const {
        scene_.check_committed();
        if (scene_.instances().memory() != instances_.memory())
            throw Error(ErrorCategory::InvalidArgument,
                        "scene was edited after the first pass; restart() has to come first, with a structure that was built of it");
    }

    /// Calls work(first pixel, pixels) for the whole picture, with at most `size` at a time. What does not
    /// fit the device's memory is tried again in halves, down to one pixel, and later batches are no larger:
    /// they do not show in the picture, since no pixel depends on another. `known` is what was found to fit
    /// before.
    template <typename Work>
    void for_each_batch(std::uint64_t& known, std::uint64_t size, const Work& work) const {
        size = std::clamp<std::uint64_t>(std::min(known, size), 1, pixels_);
        for (std::uint64_t first = 0; first < pixels_;) {
            const std::uint64_t count = std::min(size, pixels_ - first);
            try {
                work(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count));
            } catch (const Error& error) {
                if (error.category() != ErrorCategory::OutOfMemory || count == 1) throw;
                known = size = (count + 1) / 2;
                continue;
            }
            first += count;
        }
    }

    /// The next `samples` of each pixel.
    [[nodiscard]] RayBatch rays(std::uint32_t first, std::uint32_t count, std::uint32_t samples) {
        auto made = queue_.make_buffer<Ray>(std::size_t(count) * samples, "rays");
        queue_.impl().begin_stage("camera rays");
        launch_items(queue_, Kernel::shade_camera_rays, count * samples, pinhole_, first, done_, samples,
                     made);
        return {made, {}, options_.width * samples};
    }

    void store_colours(PendingImage::Impl& image) {
        for_each_batch(store_batch_, batch_rays, [&](std::uint32_t first, std::uint32_t count) {
            sums_.read(first, count, [&](const SampleSums::Part& part) {
                store(first, count, view_->colours(count, done_, part), image);
            });
        });
    }

    void store_measures(PendingImage::Impl& image) {
        std::vector<float> values(pixels_);
        for_each_batch(store_batch_, batch_rays, [&](std::uint32_t first, std::uint32_t count) {
            sums_.read(first, count, [&](const SampleSums::Part& part) {
                queue_.download(view_->values(count, done_, part), std::span(values).subspan(first, count));
            });
        });
        const float maximum = scale_of(values, image.statistics());
        const std::vector<float> knots = options_.view == View::Depth ? make_depth_ramp() : make_heat_ramp();
        const auto ramp = queue_.upload(std::span(knots), "colour ramp");
        for_each_batch(store_batch_, batch_rays, [&](std::uint32_t first, std::uint32_t count) {
            const auto part = queue_.upload(std::span(values).subspan(first, count), "pixel values");
            const auto linear = queue_.make_buffer<Float3>(count, "pixels");
            queue_.impl().begin_stage("view");
            launch_items(queue_, Kernel::shade_ramp, count, part, maximum, ramp,
                         static_cast<std::uint32_t>(knots.size() / 3), linear);
            store(first, count, linear, image);
        });
    }

    /// What the end of the ramp stands for.
    [[nodiscard]] float scale_of(const std::vector<float>& values, RenderStatistics& statistics) const {
        const float maximum = std::max(0.0f, *std::max_element(values.begin(), values.end()));
        if (options_.view == View::Depth) return maximum;
        double sum = 0;
        for (const float value : values) sum += value;
        statistics.heat_mean = sum / double(values.size());
        statistics.heat_maximum = static_cast<std::uint32_t>(std::min(std::ceil(maximum), 4294967040.0f));
        return static_cast<float>(statistics.heat_maximum);
    }

    /// Encodes `count` finished pixels, which go to the picture.
    void store(std::uint32_t first, std::uint32_t count, const Buffer<Float3>& linear, PendingImage::Impl& image) {
        const auto codes = queue_.make_buffer<std::uint8_t>(std::size_t(count) * 3, "sRGB codes");
        launch_items(queue_, Kernel::shade_encode, count * 3, linear, thresholds_, codes);
        image.add_pixels(queue_, first, linear, codes);
    }

    Queue queue_;
    const DeviceScene& scene_;
    const Structure& structure_;
    RenderOptions options_;
    std::uint64_t pixels_;
    std::uint32_t passes_;
    std::uint32_t done_ = 0;
    std::uint64_t add_batch_ = batch_rays, store_batch_ = batch_rays;  // pixels, as far as is known to fit
    SkCamera pinhole_{};
    Buffer<::SetkaInstance> instances_;  ///< of the scene when the picture was begun
    std::optional<ViewPasses> view_;
    SampleSums sums_;
    Buffer<float> thresholds_;
    RayCounts counts_;
    RenderStatistics statistics_;
};

ProgressiveRender::ProgressiveRender(Queue& queue, const DeviceScene& scene, const Structure& structure,
                                     const Camera& camera, const RenderOptions& options)
    : impl_((check_options(options), std::make_unique<Impl>(queue, scene, structure, camera, options))) {}
ProgressiveRender::~ProgressiveRender() = default;
ProgressiveRender::ProgressiveRender(ProgressiveRender&&) noexcept = default;
ProgressiveRender& ProgressiveRender::operator=(ProgressiveRender&&) noexcept = default;

void ProgressiveRender::restart(const Camera& camera) { impl_->restart(camera); }
std::uint32_t ProgressiveRender::passes() const noexcept { return impl_->passes(); }
std::uint32_t ProgressiveRender::passes_done() const noexcept { return impl_->passes_done(); }
void ProgressiveRender::add_pass() { impl_->add(1); }
void ProgressiveRender::finish() { impl_->finish(); }
Image ProgressiveRender::image() {
    PendingImage pending(impl_->fetch(Fetch::Now));
    Image image = pending.get();
    impl_->note(pending.statistics());
    return image;
}
PendingImage ProgressiveRender::image_later() { return PendingImage(impl_->fetch(Fetch::Later)); }
const RenderStatistics& ProgressiveRender::statistics() const noexcept { return impl_->statistics(); }

}  // namespace setka
