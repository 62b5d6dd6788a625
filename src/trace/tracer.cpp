// SPDX-License-Identifier: MIT
/// Which kernel traces which structure? The queries, and one place that picks by the structure's kind.
#include "setka/tracer.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "accel/world_geometry.hpp"
#include "algo/scan.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"
#include "setka/grid.hpp"
#include "trace/hit_memory.hpp"
#include "trace/host_rays.hpp"

namespace setka {

namespace {

void check_batch(std::size_t rays, std::size_t skipped) {
    if (rays > (1u << 30))
        throw Error(ErrorCategory::InvalidArgument, "rays has " + std::to_string(rays) + " elements; up to " +
                                                        std::to_string(1u << 30) + " are accepted in one call");
    if (skipped != 0 && skipped < rays)
        throw Error(ErrorCategory::InvalidArgument, "skip has " + std::to_string(skipped) +
                                                        " elements; none, or one for each of " +
                                                        std::to_string(rays) + " rays, are accepted");
}

void check_result(const char* name, std::size_t size, const RayBatch& batch) {
    const std::size_t rays = batch.rays.size();
    if (size < rays)
        throw Error(ErrorCategory::InvalidArgument, std::string(name) + " has " + std::to_string(size) +
                                                        " elements; one for each of " + std::to_string(rays) +
                                                        " rays is needed");
    check_batch(rays, batch.skip.size());
}

/// The most rays of one launch where a stop can be requested: a fraction of a second of work, and enough to fill the device.
std::uint64_t rays_a_launch(const Device& device, const Structure& structure) {
    const bool is_cpu = device.info().type == DeviceType::Cpu;
    const std::uint64_t rays = is_cpu ? 1u << 17 : 1u << 20;
    if (structure.kind() != StructureKind::BruteForce) return rays;
    const std::uint64_t tests = is_cpu ? 1u << 26 : std::uint64_t(1) << 31;
    const std::uint64_t filling = device.info().compute_units * (is_cpu ? 64u : 2048u);
    return std::clamp(tests / std::max(1u, structure.geometry().triangle_count), filling, std::max(rays, filling));
}

/// Kernels of one query: one for each structure and step.
struct QueryKernels {
    Kernel brute_force, grid_dda, grid_branch_free;
    Kernel grid_picture = grid_dda;  ///< rays in tiles, with the DDA step; on CPUs' vectors it is the same as for others
};

constexpr QueryKernels closest_kernels{Kernel::trace_brute_closest, Kernel::trace_grid_closest_dda,
                                       Kernel::trace_grid_closest_free, Kernel::trace_grid_closest_picture};
constexpr QueryKernels any_kernels{Kernel::trace_brute_any, Kernel::trace_grid_any_dda,
                                   Kernel::trace_grid_any_free, Kernel::trace_grid_any_picture};
constexpr QueryKernels count_kernels{Kernel::trace_brute_count, Kernel::trace_grid_count, Kernel::trace_grid_count};
constexpr QueryKernels all_kernels{Kernel::trace_brute_all, Kernel::trace_grid_all, Kernel::trace_grid_all};

/// What a query needs besides its batch and results. Kernels take, in this order: the number of rays, the first of them, more
/// plain values, the grid's header, the scene's parameters, rays, primitives to skip, what is particular to the query, the
/// structure's tables.
struct Query {
    Queue& queue;
    const Structure& structure;
    const TraceOptions& options;

    [[nodiscard]] sk_trace_params params(const RayBatch& batch) const {
        sk_trace_params params = trace_params(structure.geometry(), options.mask);
        params.skips = batch.skip.empty() ? 0 : 1;
        const std::uint32_t row = batch.row_length;
        if (row != 0) {
            const auto n = static_cast<std::uint32_t>(batch.rays.size());
            const std::uint32_t width = queue.device().impl()->width();
            const std::uint32_t columns = (width > 1 ? width * SK_FLIGHTS : SK_BLOCK_RAYS_OF_TEAMS) / SK_BLOCK_ROWS;
            params.row_length = row;
            params.blocks_across = row / columns;
            params.blocks_up = n / row / SK_BLOCK_ROWS;
            params.tiled_rays = params.blocks_up * SK_BLOCK_ROWS * row;
        }
        return params;
    }

    /// How a kernel that traces the grid shares out the rays. Teams are as many as an H200 has at once.
    [[nodiscard]] Shares shares(Kernel kernel) const {
        const backend::Device& device = *queue.device().impl();
        if (!traces_lists(kernel)) return {};
        if (device.team_size() > 1) return {.sharing_groups = device.info().compute_units * 28};
        return {.an_item = elements_an_item(kernel, device.width())};
    }

    /// `first` are the plain values.
    template <typename... First, typename... Particular>
    void launch(const QueryKernels& kernels, const RayBatch& batch, const std::tuple<First...>& first,
                const Particular&... particular) const {
        const auto n = static_cast<std::uint32_t>(batch.rays.size());
        const WorldGeometry& geometry = structure.geometry();
        sk_trace_params scene = params(batch);
        const std::uint64_t most = rays_a_launch(queue.device(), structure);
        std::apply(
            [&](const First&... values) {
                if (structure.kind() == StructureKind::UniformGrid) {
                    const auto& grid = static_cast<const Grid&>(structure);
                    const CompactTables& tables = grid.compact_tables();
                    const std::uint32_t width = queue.device().impl()->width();
                    const Kernel dda = scene.tiled_rays != 0 && width == 1 ? kernels.grid_picture : kernels.grid_dda;
                    const Kernel kernel = options.step == GridStep::Dda ? dda : kernels.grid_branch_free;
                    const auto launch = [&](const auto&... last) {
                        launch_shares(queue, kernel, n, shares(kernel), most, values..., grid.header(), scene, batch.rays, batch.skip,
                                      particular..., tables.blocks, tables.cells, tables.references, geometry.triangles,
                                      geometry.instance_starts, geometry.instances, last...);
                    };
                    if (traces_lists(kernel)) launch(Buffer<std::uint32_t>(queue.impl().launch_counts(), backend::Queue::launch_count_words));
                    else launch();
                } else {
                    const auto& brute_force = static_cast<const BruteForce&>(structure);
                    launch_range(queue, kernels.brute_force, n, most, values..., scene, batch.rays, batch.skip,
                                 particular..., brute_force.packets(), geometry.instance_starts,
                                 geometry.instances);
                }
            },
            first);
    }
};

}  // namespace

void Tracer::closest_hit(Queue& queue, const Structure& structure, const RayBatch& batch,
                         const Buffer<Hit>& hits) const {
    check_result("hits", hits.size(), batch);
    queue.impl().begin_stage("closest hit");
    Query{queue, structure, options_}.launch(closest_kernels, batch, std::tuple(), hits);
}

void Tracer::any_hit(Queue& queue, const Structure& structure, const RayBatch& batch,
                     const Buffer<std::uint32_t>& occluded) const {
    check_result("occluded", occluded.size(), batch);
    queue.impl().begin_stage("any hit");
    Query{queue, structure, options_}.launch(any_kernels, batch, std::tuple(), occluded);
}

void Tracer::closest_hit_cost(Queue& queue, const Structure& structure, const RayBatch& batch,
                              const Buffer<TraceCost>& costs) const {
    check_result("costs", costs.size(), batch);
    queue.impl().begin_stage("cost");
    if (structure.kind() == StructureKind::BruteForce) {
        // Brute force visits no cell and tests everything.
        const std::vector<TraceCost> cost(batch.rays.size(), {0, structure.geometry().triangle_count});
        queue.upload(std::span<const TraceCost>(cost), costs);
        return;
    }
    constexpr QueryKernels kernels{{}, Kernel::trace_grid_cost_dda, Kernel::trace_grid_cost_free};
    Query{queue, structure, options_}.launch(kernels, batch, std::tuple(), costs);
}

void Tracer::count_hits(Queue& queue, const Structure& structure, const RayBatch& batch,
                        const Buffer<std::uint32_t>& counts, const AllHitsOptions& options) const {
    check_result("counts", counts.size(), batch);
    queue.impl().begin_stage("count hits");
    Query{queue, structure, options_}.launch(count_kernels, batch, std::tuple(options.max_hits), counts);
}

AllHits Tracer::all_hits(Queue& queue, const Structure& structure, const RayBatch& batch,
                         const AllHitsOptions& options) const {
    check_batch(batch.rays.size(), batch.skip.size());
    const auto n = static_cast<std::uint32_t>(batch.rays.size());
    AllHits result;
    result.offsets = queue.make_buffer<std::uint32_t>(std::size_t(n) + 1, "hit offsets");
    std::uint64_t total = 0;
    {
        const auto counts = queue.make_buffer<std::uint32_t>(n, "hit counts");
        count_hits(queue, structure, batch, counts, options);
        total = queue.download(enqueue_exclusive_scan(queue, counts, n, result.offsets)).back();
    }
    check_hit_memory(queue.device(), n, total);
    result.hits = queue.make_buffer<Hit>(static_cast<std::size_t>(total), "hits");
    queue.impl().begin_stage("all hits");
    if (total != 0)
        Query{queue, structure, options_}.launch(all_kernels, batch, std::tuple(), result.offsets, result.hits);
    return result;
}

std::vector<Hit> Tracer::closest_hit(Queue& queue, const Structure& structure, std::span<const Ray> rays,
                                     std::span<const Primitive> skip) const {
    check_batch(rays.size(), skip.size());
    return trace_from_host<Hit>(queue, rays, skip, "hits", [&](const RayBatch& batch, const Buffer<Hit>& hits) {
        closest_hit(queue, structure, batch, hits);
    });
}

std::vector<std::uint32_t> Tracer::any_hit(Queue& queue, const Structure& structure, std::span<const Ray> rays,
                                           std::span<const Primitive> skip) const {
    check_batch(rays.size(), skip.size());
    return trace_from_host<std::uint32_t>(queue, rays, skip, "occluded",
                                          [&](const RayBatch& batch, const Buffer<std::uint32_t>& occluded) {
                                              any_hit(queue, structure, batch, occluded);
                                          });
}

std::vector<std::uint32_t> Tracer::count_hits(Queue& queue, const Structure& structure, std::span<const Ray> rays,
                                              const AllHitsOptions& options, std::span<const Primitive> skip) const {
    check_batch(rays.size(), skip.size());
    return trace_from_host<std::uint32_t>(queue, rays, skip, "hit counts",
                                          [&](const RayBatch& batch, const Buffer<std::uint32_t>& counts) {
                                              count_hits(queue, structure, batch, counts, options);
                                          });
}

HitLists Tracer::all_hits(Queue& queue, const Structure& structure, std::span<const Ray> rays,
                          const AllHitsOptions& options, std::span<const Primitive> skip) const {
    check_batch(rays.size(), skip.size());
    WaitIfThrown wait(queue);
    const AllHits all = all_hits(queue, structure, wrap_batch(queue, rays, skip), options);
    HitLists lists{queue.download(all.offsets), queue.download(all.hits)};
    wait.done();
    return lists;
}

}  // namespace setka
