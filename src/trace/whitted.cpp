// SPDX-License-Identifier: MIT
/// In which order do the shading passes run? Down the levels until no ray goes on, then up again with the
/// colours. Buffers live no longer than their last pass.
#include "trace/whitted.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "algo/scan.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"
#include "trace/shading_tables.hpp"

namespace setka {

namespace {

/// Three floats a ray are numbered with 32 bits.
constexpr std::uint64_t most_level_rays = 1u << 30;

TraceOptions with_mask(TraceOptions options, std::uint32_t mask) {
    options.mask = mask;
    return options;
}

/// The largest coordinate of the box, in magnitude: what the rounding of any point in it is measured by.
float magnitude(const Bounds& bounds) {
    float largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::fabs(bounds.lower[axis]), std::fabs(bounds.upper[axis])});
    return largest;
}

std::uint32_t items(const Buffer<Ray>& rays) { return static_cast<std::uint32_t>(rays.size()); }

}  // namespace

std::uint32_t camera_mask(std::uint32_t mask) {
    return mask == SETKA_MASK_OPAQUE ? mask : mask & ~SETKA_MASK_OPAQUE;
}

void RayCounts::add(RayCounts other) {
    secondary += other.secondary;
    shadow += other.shadow;
    std::ranges::move(other.pending_shadow, std::back_inserter(pending_shadow));
}

void RayCounts::collect(Queue& queue) {
    for (const auto& numbers : pending_shadow)
        for (const std::uint32_t n : queue.download(numbers)) shadow += n;
    pending_shadow.clear();
}

/// What is kept of a level for the way up.
struct WhittedPasses::Level {
    Buffer<float> colours;
    Buffer<float> weights;          // of its rays in their parents' colours; none at level 0
    Buffer<std::uint32_t> offsets;  // the first child of each ray; none at the last level
};

WhittedPasses::WhittedPasses(Queue& queue, const DeviceScene& scene, const Structure& structure,
                             const TraceOptions& trace, std::uint32_t max_depth)
    : queue_(queue),
      scene_(scene),
      structure_(structure),
      tracer_(with_mask(trace, camera_mask(trace.mask))),
      opaque_tracer_(with_mask(trace, SETKA_MASK_OPAQUE)),
      max_depth_(max_depth),
      // A floor under the offset that grows with the triangle: a small triangle's neighbour may be as large
      // as the scene.
      offset_(std::ldexp(magnitude(structure.geometry().bounds), -20)),
      background_(make_background(scene.background())),
      lights_(make_light_table(scene)),
      has_transparent_(any_transparent(scene.materials())),
      has_onward_(any_onward(scene.materials())) {
    const std::vector<SkMaterial> materials = make_material_table(scene.materials());
    materials_ = queue.upload(std::span(materials), "materials");
}

Buffer<SkSurfacePoint> WhittedPasses::surfaces(const RayBatch& batch, const Buffer<float>& colours) const {
    const Buffer<Ray>& rays = batch.rays;
    const auto hits = queue_.make_buffer<Hit>(rays.size(), "hits");
    tracer_.closest_hit(queue_, structure_, batch, hits);
    auto points = queue_.make_buffer<SkSurfacePoint>(rays.size(), "surface points");
    queue_.impl().begin_stage("shade surfaces");
    launch_items(queue_, Kernel::shade_surface, items(rays), background_, offset_, rays, hits,
                 scene_.instances(), scene_.instance_starts(), scene_.indices(), scene_.normals(), scene_.colors(),
                 structure_.geometry().triangles, materials_, points, colours);
    return points;
}

Buffer<SkSurfacePoint> WhittedPasses::surfaces(const RayBatch& batch) const {
    return surfaces(batch, queue_.make_buffer<float>(3 * batch.rays.size(), "colours"));
}

void WhittedPasses::add_lights(const RayBatch& batch, const Buffer<SkSurfacePoint>& points,
                               const Buffer<float>& colours, RayCounts& count) const {
    if (lights_.empty()) return;
    const Buffer<Ray>& rays = batch.rays;
    const auto shadow_rays = queue_.make_buffer<Ray>(rays.size(), "shadow rays");
    // Rays that are left out are members of a team without work, so that teams are better off with rows, as they come.
    const bool in_tiles = queue_.device().impl()->width() > 1;
    const RayBatch shadow_batch(shadow_rays, {}, in_tiles ? batch.row_length : 0);
    const auto occluded = queue_.make_buffer<std::uint32_t>(rays.size(), "occlusion");
    const auto opaque = has_transparent_ ? queue_.make_buffer<std::uint32_t>(rays.size(), "opaque occlusion")
                                         : Buffer<std::uint32_t>();
    const auto active_counts = queue_.make_buffer<std::uint32_t>(lights_.size(), "shadow ray counts");
    queue_.impl().fill(*active_counts.memory(), 0, active_counts.size_bytes());

    for (std::uint32_t index = 0; index < lights_.size(); ++index) {
        const SkLight& light = lights_[index];
        queue_.impl().begin_stage("shade lights");
        launch_items(queue_, Kernel::shade_shadow_rays, items(rays), light, points, shadow_rays,
                     active_counts, index);
        tracer_.any_hit(queue_, structure_, shadow_batch, occluded);
        if (has_transparent_) {
            queue_.impl().begin_stage("shade lights");
            launch_items(queue_, Kernel::shade_shadow_narrow, items(rays), occluded, shadow_rays);
            opaque_tracer_.any_hit(queue_, structure_, shadow_batch, opaque);
        }
        queue_.impl().begin_stage("shade lights");
        launch_items(queue_, Kernel::shade_light, items(rays), light, rays, points, materials_, occluded,
                     opaque, std::uint32_t(has_transparent_), colours);
    }
    count.pending_shadow.push_back(active_counts);
}

Buffer<float> WhittedPasses::colours(RayBatch batch, RayCounts& count) const {
    std::vector<Level> levels;
    Buffer<float> throughputs,
        weights;  // none of the first level's, whose rays have all their light before them
    for (std::uint32_t depth = 0;; ++depth) {
        const Buffer<Ray> rays = batch.rays;
        const std::uint32_t n = items(rays);
        Level& level = levels.emplace_back();
        level.weights = std::move(weights);
        level.colours = queue_.make_buffer<float>(3 * rays.size(), "colours");
        const auto points = surfaces(batch, level.colours);
        add_lights(batch, points, level.colours, count);
        if (depth == max_depth_ || !has_onward_) break;

        queue_.impl().begin_stage("spawn rays");
        auto offsets = queue_.make_buffer<std::uint32_t>(rays.size() + 1, "child offsets");
        std::uint64_t total = 0;
        {
            const auto counts = queue_.make_buffer<std::uint32_t>(rays.size(), "child counts");
            launch_items(queue_, Kernel::shade_child_count, n, rays, points, materials_, throughputs,
                         std::uint32_t(depth > 0), counts);
            total = exclusive_scan(queue_, counts, n, offsets, "mirror and refraction rays");
        }
        if (total == 0) break;
        if (total > most_level_rays)
            throw Error(ErrorCategory::OutOfMemory, std::to_string(total) +
                                                        " rays go on from one batch at depth " +
                                                        std::to_string(depth) + "; at most " +
                                                        std::to_string(most_level_rays) + " can be numbered");
        count.secondary += total;
        auto child_rays = queue_.make_buffer<Ray>(total, "rays");
        auto child_throughputs = queue_.make_buffer<float>(total, "throughputs");
        weights = queue_.make_buffer<float>(3 * total, "weights");
        queue_.impl().begin_stage("spawn rays");
        launch_items(queue_, Kernel::shade_child_emit, n, rays, points, materials_, throughputs,
                     std::uint32_t(depth > 0), offsets, child_rays, weights, child_throughputs);
        level.offsets = std::move(offsets);
        batch = std::move(child_rays);  // in no row
        throughputs = std::move(child_throughputs);
    }
    return gather(std::move(levels));
}

Buffer<float> WhittedPasses::gather(std::vector<Level> levels) const {
    queue_.impl().begin_stage("gather");
    while (levels.size() > 1) {
        const Level child = std::move(levels.back());
        levels.pop_back();
        const Level& parent = levels.back();
        launch_items(queue_, Kernel::shade_gather, static_cast<std::uint32_t>(parent.colours.size() / 3),
                     parent.offsets, child.weights, child.colours, parent.colours);
    }
    return levels.front().colours;
}

}  // namespace setka
