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
    [[nodiscard]] const RenderStatistics& statistics() const noexcept { return statistics_; }

  private:
    RenderOptions options_;
    RenderStatistics statistics_;
};

/// The rays of a pinhole camera through the pixel centres, row by row from the top: for tests and benchmarks of one's own.
[[nodiscard]] Buffer<Ray> camera_rays(Queue& queue, const Camera& camera, std::uint32_t width, std::uint32_t height,
                                      std::uint32_t samples_per_axis = 1);

}  // namespace setka
