// SPDX-License-Identifier: MIT
/// What does a ray hit? Closest hit and any hit over batches of rays, on any structure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "setka/structure.hpp"

namespace setka {

/// How a ray moves from a grid cell to the next. Both visit cells that give the same hits.
enum class GridStep {
    Dda,         ///< the smallest of three parameters (Amanatides & Woo 1987)
    BranchFree,  ///< signs of three cross products, no division (Maltsev & Mikhaylyuk 2012, section 3)
};

struct TraceOptions {
    GridStep step = GridStep::Dda;
    /// Instances are seen if their mask shares a bit with this one. SETKA_MASK_OPAQUE stands for opaque materials.
    std::uint32_t mask = 0x7fffffffu;
};

/// Traces rays. A hit is a function of the scene and the ray: the smallest t in [tmin, tmax], then the lowest scene triangle.
/// No structure, density, device or launch shape changes a bit of it.
class Tracer {
  public:
    explicit Tracer(const TraceOptions& options = {}) : options_(options) {}
    [[nodiscard]] const TraceOptions& options() const noexcept { return options_; }

    /// hits[i] = closest hit of rays[i] for i < rays.size(). Throws InvalidArgument if `hits` is shorter than `rays`.
    void closest_hit(Queue& queue, const Structure& structure, const Buffer<Ray>& rays, const Buffer<Hit>& hits) const;
    /// occluded[i] = 1 if rays[i] hits anything, else 0.
    void any_hit(Queue& queue, const Structure& structure, const Buffer<Ray>& rays,
                 const Buffer<std::uint32_t>& occluded) const;
    /// costs[i] = cells visited and triangles tested by closest_hit of rays[i].
    void closest_hit_cost(Queue& queue, const Structure& structure, const Buffer<Ray>& rays,
                          const Buffer<TraceCost>& costs) const;

    /// The same for rays on the host; these wait.
    [[nodiscard]] std::vector<Hit> closest_hit(Queue& queue, const Structure& structure, std::span<const Ray> rays) const;
    [[nodiscard]] std::vector<std::uint32_t> any_hit(Queue& queue, const Structure& structure,
                                                     std::span<const Ray> rays) const;

  private:
    TraceOptions options_;
};

}  // namespace setka
