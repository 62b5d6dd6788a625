// SPDX-License-Identifier: MIT
/// Which kernel traces which structure? The queries, and one place that picks by the structure's kind.
#include "setka/tracer.hpp"

#include <string>

#include "accel/world_geometry.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"
#include "setka/grid.hpp"

namespace setka {

namespace {

void check_result(const char* name, std::size_t size, std::size_t rays) {
    if (size < rays)
        throw Error(ErrorCategory::InvalidArgument, std::string(name) + " has " + std::to_string(size) +
                                                        " elements; one for each of " + std::to_string(rays) +
                                                        " rays is needed");
    if (rays > (1u << 30))
        throw Error(ErrorCategory::InvalidArgument, "rays has " + std::to_string(rays) + " elements; up to " +
                                                        std::to_string(1u << 30) + " are accepted in one call");
}

/// Grid kernels of one query: one for each step.
struct GridKernels {
    Kernel dda, branch_free;
};

template <typename Result>
void trace_grid(Queue& queue, const Grid& grid, const TraceOptions& options, const GridKernels& kernels,
                const Buffer<Ray>& rays, const Buffer<Result>& results) {
    const WorldGeometry& geometry = grid.geometry();
    launch_items(queue, options.step == GridStep::Dda ? kernels.dda : kernels.branch_free,
                 static_cast<std::uint32_t>(rays.size()), grid.header(), trace_params(geometry, options.mask), rays,
                 results, grid.offsets(), grid.counts(), grid.references(), geometry.triangles,
                 geometry.instance_starts, geometry.instances);
}

template <typename Result>
void trace_brute_force(Queue& queue, const BruteForce& structure, const TraceOptions& options, Kernel kernel,
                       const Buffer<Ray>& rays, const Buffer<Result>& results) {
    const WorldGeometry& geometry = structure.geometry();
    launch_items(queue, kernel, static_cast<std::uint32_t>(rays.size()), trace_params(geometry, options.mask), rays,
                 results, structure.packets(), geometry.instance_starts, geometry.instances);
}

}  // namespace

void Tracer::closest_hit(Queue& queue, const Structure& structure, const Buffer<Ray>& rays,
                         const Buffer<Hit>& hits) const {
    check_result("hits", hits.size(), rays.size());
    queue.impl().begin_stage("closest hit");
    if (structure.kind() == StructureKind::UniformGrid)
        trace_grid(queue, static_cast<const Grid&>(structure), options_,
                   {Kernel::trace_grid_closest_dda, Kernel::trace_grid_closest_free}, rays, hits);
    else
        trace_brute_force(queue, static_cast<const BruteForce&>(structure), options_, Kernel::trace_brute_closest,
                          rays, hits);
}

void Tracer::any_hit(Queue& queue, const Structure& structure, const Buffer<Ray>& rays,
                     const Buffer<std::uint32_t>& occluded) const {
    check_result("occluded", occluded.size(), rays.size());
    queue.impl().begin_stage("any hit");
    if (structure.kind() == StructureKind::UniformGrid)
        trace_grid(queue, static_cast<const Grid&>(structure), options_,
                   {Kernel::trace_grid_any_dda, Kernel::trace_grid_any_free}, rays, occluded);
    else
        trace_brute_force(queue, static_cast<const BruteForce&>(structure), options_, Kernel::trace_brute_any, rays,
                          occluded);
}

void Tracer::closest_hit_cost(Queue& queue, const Structure& structure, const Buffer<Ray>& rays,
                              const Buffer<TraceCost>& costs) const {
    check_result("costs", costs.size(), rays.size());
    queue.impl().begin_stage("cost");
    if (structure.kind() == StructureKind::UniformGrid) {
        trace_grid(queue, static_cast<const Grid&>(structure), options_,
                   {Kernel::trace_grid_cost_dda, Kernel::trace_grid_cost_free}, rays, costs);
    } else {
        // Brute force visits no cell and tests everything.
        const std::vector<TraceCost> cost(rays.size(), {0, structure.geometry().triangle_count});
        queue.upload(std::span<const TraceCost>(cost), costs);
    }
}

std::vector<Hit> Tracer::closest_hit(Queue& queue, const Structure& structure, std::span<const Ray> rays) const {
    std::vector<Hit> hits(rays.size());
    const auto device_rays = queue.wrap(rays, "rays");
    const auto device_hits = queue.wrap(std::span(hits), "hits");
    closest_hit(queue, structure, device_rays, device_hits);
    queue.download(device_hits, std::span(hits));
    return hits;
}

std::vector<std::uint32_t> Tracer::any_hit(Queue& queue, const Structure& structure, std::span<const Ray> rays) const {
    std::vector<std::uint32_t> occluded(rays.size());
    const auto device_rays = queue.wrap(rays, "rays");
    const auto device_occluded = queue.wrap(std::span(occluded), "occluded");
    any_hit(queue, structure, device_rays, device_occluded);
    queue.download(device_occluded, std::span(occluded));
    return occluded;
}

}  // namespace setka
