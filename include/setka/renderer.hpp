// SPDX-License-Identifier: MIT
/// What does the scene look like? Whitted ray tracing (1980) as passes over batches of rays that stay on the device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "setka/image.hpp"
#include "setka/tracer.hpp"

namespace setka {

/// What a pixel shows.
enum class View {
    Shaded,
    Normals,  ///< shading normal, (n + 1) / 2
    Depth,    ///< t over the farthest t of the picture, near is bright
    Steps,    ///< grid cells and larger empty cubes visited by the primary ray, as a heat map with the legend in RenderStatistics
    Tests,    ///< triangles tested by the primary ray, likewise
};

/// Which pixels an Image holds. A window, or an 8-bit file, needs no linear ones, which are four times as many bytes to fetch.
enum class Pixels {
    LinearAndSrgb,
    Srgb,  ///< Image::linear is empty
};

struct RenderOptions {
    std::uint32_t width = 1280;          ///< 1 to 16384
    std::uint32_t height = 720;          ///< 1 to 16384
    std::uint32_t samples_per_axis = 1;  ///< 1 to 16: n * n primary rays a pixel, on a regular grid
    std::uint32_t max_depth = 6;         ///< 0 to 16: mirror and refraction rays after the primary one
    View view = View::Shaded;
    TraceOptions trace{};
    Pixels pixels = Pixels::LinearAndSrgb;
    /// Called after each batch with the share that is done, 0 to 1.
    std::function<void(double)> progress{};
};

/// What a render cost.
struct RenderStatistics {
    std::uint64_t primary_rays = 0;
    std::uint64_t secondary_rays = 0;  ///< mirror and refraction
    std::uint64_t shadow_rays = 0;
    double wall_ms = 0;  ///< in the calls that render
    std::uint32_t heat_maximum = 0;  ///< Steps and Tests: the value of the hottest colour
    double heat_mean = 0;            ///< Steps and Tests: mean over the pixels
};

/// A picture on its way to the host: what ProgressiveRender::image_later() and Renderer::render_later() return. It may outlive all that it
/// was made of, and belongs to the queue's thread as long as the queue is there. Destroying or replacing one that was not fetched waits for the
/// device to come that far.
class PendingImage {
  public:
    PendingImage() noexcept;  ///< of nothing: get() throws
    ~PendingImage();
    PendingImage(PendingImage&&) noexcept;
    PendingImage& operator=(PendingImage&&) noexcept;

    /// Whether get() would return at once, or throw.
    [[nodiscard]] bool is_ready() const;
    /// Waits for the picture, and gives it away. Errors of asynchronous work surface here. A stop that is requested when it is on its way changes
    /// nothing. Throws InvalidArgument if it has been called before.
    [[nodiscard]] Image get();
    /// What the picture cost, once get() has returned it; its wall_ms has the calls that rendered and get(). Before, nothing.
    [[nodiscard]] const RenderStatistics& statistics() const noexcept;

  private:
    friend class ProgressiveRender;
    class Impl;
    explicit PendingImage(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
    RenderStatistics statistics_;
};

/// A picture that grows pass by pass, each of which adds one sample to every pixel: for windows, and for renders that may be stopped
/// early. The picture is valid after any pass, and after all of them has the bits that Renderer::render gives it.
///
/// A pass that throws, as one that is cancelled does, leaves the picture as it was before: image() and further passes work as soon
/// as the queue does.
class ProgressiveRender {
  public:
    /// `scene`, of which `structure` was built, and `structure` have to outlive this. Throws InvalidArgument for options out of
    /// range, InvalidData for a degenerate camera.
    ProgressiveRender(Queue& queue, const DeviceScene& scene, const Structure& structure, const Camera& camera,
                      const RenderOptions& options = {});
    ~ProgressiveRender();
    ProgressiveRender(ProgressiveRender&&) noexcept;
    ProgressiveRender& operator=(ProgressiveRender&&) noexcept;

    /// Begins anew with this camera and what the scene's materials and lights are now; memory is kept.
    void restart(const Camera& camera);

    /// samples_per_axis squared.
    [[nodiscard]] std::uint32_t passes() const noexcept;
    [[nodiscard]] std::uint32_t passes_done() const noexcept;
    /// Adds the next sample of each pixel, in rows of the regular grid from the top; nothing if all are there. A pass that fits
    /// into one batch, and in which no ray goes on, is enqueued without waiting.
    void add_pass();
    /// Adds all that are left: several samples at a time where a picture's pixels are too few to fill a device.
    void finish();

    /// The mean of the samples that are there; waits. Throws InvalidArgument before the first pass.
    [[nodiscard]] Image image();
    /// The same without waiting: what PendingImage::get() brings later is not changed by passes, edits of the scene, or anything else that
    /// comes after this call, and all that the picture was made of may be freed. Waits, but for what it needs only, where the view is one of depth or
    /// cost, whose colours depend on all pixels, and where the picture has more than 128 MiB.
    [[nodiscard]] PendingImage image_later();
    /// What was done since the start, as of the last image(); of heat, what that image shows.
    [[nodiscard]] const RenderStatistics& statistics() const noexcept;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Whole pictures, each in one call.
class Renderer {
  public:
    /// Throws InvalidArgument for options out of range.
    explicit Renderer(const RenderOptions& options = {});
    /// Renders `scene`, of which `structure` was built, and waits. Throws InvalidData for a degenerate camera.
    [[nodiscard]] Image render(Queue& queue, const DeviceScene& scene, const Structure& structure, const Camera& camera);
    /// The same without waiting for the picture: the next frame may be edited, built and rendered while the device works on this one, and
    /// `scene` and `structure` may be freed as soon as the call returns.
    /// What has to be known on the way is waited for: the number of rays that go on, for each level, where some material mirrors or lets light
    /// through; whether a structure that was loaded fits the scene; sums that do not fit the device's memory; and what image_later() waits for.
    /// A scene without such materials, on a structure that was built of it, waits for nothing in a shaded picture of up to 8 million pixels
    /// and 64 batches of two million rays.
    [[nodiscard]] PendingImage render_later(Queue& queue, const DeviceScene& scene, const Structure& structure,
                                            const Camera& camera) const;
    /// Of the last render().
    [[nodiscard]] const RenderStatistics& statistics() const noexcept { return statistics_; }

  private:
    RenderOptions options_;
    RenderStatistics statistics_;
};

/// The rays of a pinhole camera through the pixel centres, row by row from the top: for tests and benchmarks of one's own.
[[nodiscard]] Buffer<Ray> camera_rays(Queue& queue, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                      std::uint32_t samples_per_axis = 1);

}  // namespace setka
