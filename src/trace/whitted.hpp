// SPDX-License-Identifier: MIT
/// What colours do the rays of one batch bring back? Whitted's recursion, level by level, on the device.
#pragma once

#include <cstdint>
#include <vector>

#include "device/shade/layout.h"
#include "setka/tracer.hpp"

namespace setka {

/// How many rays were traced. Those towards lights are counted on the device, and added up here when somebody
/// asks: shading waits for no number that it does not need.
struct RayCounts {
    std::uint64_t secondary = 0;
    std::uint64_t shadow = 0;
    std::vector<Buffer<std::uint32_t>>
        pending_shadow;  ///< of each level of rays one, with a number for each light

    void add(RayCounts other);
    /// Waits, and moves pending_shadow to shadow.
    void collect(Queue& queue);
};

/// The query mask for what the camera sees: without the opaque bit, which would let it see what the other
/// bits hide, unless opaque things are all that is asked for.
[[nodiscard]] std::uint32_t camera_mask(std::uint32_t mask);

/// The passes over a batch, with the tables that all batches share.
///
/// Shadows of transparent things: a shadow ray first asks for everything that the camera sees. What is not
/// free is asked again for opaque things alone (SETKA_MASK_OPAQUE), and gets part of the light
/// (SK_SHADOW_TRANSMISSION) where there is none. The second question knows no user bits, so an opaque thing
/// hidden from the camera still darkens what lies behind glass; only there.
class WhittedPasses {
  public:
    WhittedPasses(Queue& queue, const DeviceScene& scene, const Structure& structure,
                  const TraceOptions& trace, std::uint32_t max_depth);

    /// Three floats a ray. `count` is raised by the rays that are traced for it. Waits only for the number of
    /// rays that go on, where some material lets them.
    [[nodiscard]] Buffer<float> colours(RayBatch batch, RayCounts& count) const;
    /// The surfaces that rays meet first.
    [[nodiscard]] Buffer<SkSurfacePoint> surfaces(const RayBatch& batch) const;

  private:
    struct Level;

    [[nodiscard]] Buffer<SkSurfacePoint> surfaces(const RayBatch& batch,
                                                  const Buffer<float>& colours) const;
    void add_lights(const RayBatch& batch, const Buffer<SkSurfacePoint>& points,
                    const Buffer<float>& colours, RayCounts& count) const;
    [[nodiscard]] Buffer<float> gather(std::vector<Level> levels) const;

    Queue& queue_;
    const DeviceScene& scene_;
    const Structure& structure_;
    Tracer tracer_;         // what the camera sees
    Tracer opaque_tracer_;  // what is opaque
    std::uint32_t max_depth_;
    float offset_;
    SkBackground background_;
    std::vector<SkLight> lights_;
    bool has_transparent_;
    bool has_onward_;  // some surface mirrors, or lets rays through
    Buffer<SkMaterial> materials_;
};

}  // namespace setka
