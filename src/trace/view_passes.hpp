// SPDX-License-Identifier: MIT
/// What does a view add up for its pixels, and how do the sums become colours? One answer for each view.
#pragma once

#include <cstdint>
#include <optional>

#include "setka/renderer.hpp"
#include "trace/sample_sums.hpp"
#include "trace/whitted.hpp"

namespace setka {

/// The samples that a pass adds to some pixels: their rays, pixel by pixel.
struct SampleRays {
    RayBatch rays;
    std::uint32_t pixels = 0;
    std::uint32_t done = 0;     ///< samples of each pixel that were added before
    std::uint32_t samples = 0;  ///< of each pixel here
};

/// The work of one view on one scene. What it was made of has to outlive it.
class ViewPasses {
  public:
    ViewPasses(Queue& queue, const DeviceScene& scene, const Structure& structure,
               const RenderOptions& options);

    /// How many numbers a view adds up for each pixel.
    [[nodiscard]] static std::uint32_t floats_per_pixel(View view);
    /// Whether colours depend on a scale that the whole picture has in common.
    [[nodiscard]] static bool is_measure(View view) { return view != View::Shaded && view != View::Normals; }

    /// Traces the rays and adds what they find to the pixels' sums. `count` is raised by the rays beyond the
    /// primary ones.
    void add(const SampleRays& samples, const SampleSums::Part& sums, RayCounts& count) const;
    /// Mean colours of pixels with `done` samples: only where the view is no measure.
    [[nodiscard]] Buffer<Float3> colours(std::uint32_t pixels, std::uint32_t done,
                                         const SampleSums::Part& sums) const;
    /// Mean values of pixels with `done` samples, below 0 where there is none: only where the view is a
    /// measure.
    [[nodiscard]] Buffer<float> values(std::uint32_t pixels, std::uint32_t done,
                                       const SampleSums::Part& sums) const;

  private:
    [[nodiscard]] Buffer<float> ray_colours(const SampleRays& samples, RayCounts& count) const;

    Queue& queue_;
    const Structure& structure_;
    View view_;
    std::optional<WhittedPasses> whitted_;  // views of surfaces
    Tracer tracer_;                         // measures
};

}  // namespace setka
