// SPDX-License-Identifier: MIT
/// What does a ray hit? Closest hit, any hit, all hits and their number over batches of rays, on any structure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "setka/structure.hpp"

namespace setka {

/// How a ray moves from a grid cell to the next. Both visit cells that give the same hits.
enum class GridStep {
    Dda,         ///< the smallest of three parameters (Amanatides & Woo 1987), past empty space in larger steps
    BranchFree,  ///< signs of three cross products, no division (Maltsev & Mikhaylyuk 2012, section 3)
};

struct TraceOptions {
    /// Of closest and any hit. All hits need the parameters at which cells are left, and so always take the DDA step.
    GridStep step = GridStep::Dda;
    /// Instances are seen if their mask shares a bit with this one. SETKA_MASK_OPAQUE stands for opaque materials.
    std::uint32_t mask = 0x7fffffffu;
};

/// Rays on the device, and what each of them passes through. A buffer of rays is a batch that skips nothing.
struct RayBatch {
    RayBatch(Buffer<Ray> all_rays, Buffer<Primitive> skipped = {},  // NOLINT(google-explicit-constructor)
             std::uint32_t rays_in_row = 0)
        : rays(std::move(all_rays)), skip(std::move(skipped)), row_length(rays_in_row) {}

    Buffer<Ray> rays;
    /// Empty, or one for each ray: rays[i] is traced as if the scene had no triangle skip[i], and nothing else is left out.
    /// For rays that start on a triangle. What names no triangle, as {SETKA_NO_HIT, SETKA_NO_HIT}, skips nothing.
    Buffer<Primitive> skip;
    /// Of rays of a picture, row by row: how many a row has, width * samples_per_axis² for camera_rays(). The DDA step
    /// then traces closest and any hits of small tiles of the picture together, which is faster where neighbours go much the same way. Rays that are left out
    /// may stay in place, with tmin > tmax. 0, or any other number: nothing but the time depends on it.
    std::uint32_t row_length = 0;
};

struct AllHitsOptions {
    /// A ray's list ends after so many hits, the first along it; its count is then this number.
    std::uint32_t max_hits = std::numeric_limits<std::uint32_t>::max();
};

/// Every hit of every ray, on the device: ray i has hits[offsets[i]] up to, not including, hits[offsets[i + 1]].
struct AllHits {
    Buffer<std::uint32_t> offsets;  ///< one more than rays; the last is the number of hits
    Buffer<Hit> hits;
};

/// The same on the host.
struct HitLists {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Hit> hits;

    [[nodiscard]] std::size_t ray_count() const noexcept { return offsets.size() - 1; }
    /// The hits of ray i, in order.
    [[nodiscard]] std::span<const Hit> operator[](std::size_t i) const noexcept {
        return std::span(hits).subspan(offsets[i], offsets[i + 1] - offsets[i]);
    }
};

/// Traces rays. A hit is a function of the scene and the ray: the first along the ray with t in [tmin, tmax], of several at one
/// place that of the lowest scene triangle. No structure, density, device or launch shape changes a bit of it.
///
/// Along the ray means by a parameter of which t is a rounding (src/README.md, "All hits"). For a ray that starts near the scene t
/// tells as much; from a distance of many times the scene's size, where t of different places may be equal, the nearer one is
/// still the first.
class Tracer {
  public:
    explicit Tracer(const TraceOptions& options = {}) : options_(options) {}
    [[nodiscard]] const TraceOptions& options() const noexcept { return options_; }

    /// hits[i] = closest hit of rays[i] for i < rays.size(). Throws InvalidArgument if `hits` is shorter than the rays, as the
    /// others do for what they write; or if some, but too few, primitives are to be skipped.
    void closest_hit(Queue& queue, const Structure& structure, const RayBatch& batch, const Buffer<Hit>& hits) const;
    /// occluded[i] = 1 if rays[i] hits anything, else 0.
    void any_hit(Queue& queue, const Structure& structure, const RayBatch& batch,
                 const Buffer<std::uint32_t>& occluded) const;
    /// costs[i] = places visited and triangles tested by closest_hit of rays[i]: cells one by one with the branch-free step,
    /// cells and larger empty cubes of them with the DDA step.
    void closest_hit_cost(Queue& queue, const Structure& structure, const RayBatch& batch,
                          const Buffer<TraceCost>& costs) const;
    /// counts[i] = how many triangles rays[i] hits, or max_hits if there are more.
    void count_hits(Queue& queue, const Structure& structure, const RayBatch& batch,
                    const Buffer<std::uint32_t>& counts, const AllHitsOptions& options = {}) const;
    /// Every triangle that a ray hits, once, in order: ascending in t, of hits at one place by scene triangle. The first is
    /// closest_hit's. The rays are traced twice, and the call waits for the number of hits in between. Throws OutOfMemory, with
    /// the exact numbers, if the hits are more than 2^32 - 1 or do not fit the device: batches may be split at any ray.
    [[nodiscard]] AllHits all_hits(Queue& queue, const Structure& structure, const RayBatch& batch,
                                   const AllHitsOptions& options = {}) const;

    /// The same for rays on the host; these wait. `skip` is empty or has one element for each ray.
    [[nodiscard]] std::vector<Hit> closest_hit(Queue& queue, const Structure& structure, std::span<const Ray> rays,
                                               std::span<const Primitive> skip = {}) const;
    [[nodiscard]] std::vector<std::uint32_t> any_hit(Queue& queue, const Structure& structure,
                                                     std::span<const Ray> rays,
                                                     std::span<const Primitive> skip = {}) const;
    [[nodiscard]] std::vector<std::uint32_t> count_hits(Queue& queue, const Structure& structure,
                                                        std::span<const Ray> rays, const AllHitsOptions& options = {},
                                                        std::span<const Primitive> skip = {}) const;
    [[nodiscard]] HitLists all_hits(Queue& queue, const Structure& structure, std::span<const Ray> rays,
                                    const AllHitsOptions& options = {}, std::span<const Primitive> skip = {}) const;

  private:
    TraceOptions options_;
};

}  // namespace setka
