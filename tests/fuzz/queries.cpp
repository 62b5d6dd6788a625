// SPDX-License-Identifier: MIT
#include "fuzz/queries.hpp"

#include "fuzz/check.hpp"
#include "setka/grid.hpp"
#include "support/compare.hpp"

namespace fuzz {

using setka::ErrorCategory;
using setka::GridStep;
using setka::Hit;

namespace {

constexpr Hit miss{std::numeric_limits<float>::infinity(), 0, 0, SETKA_NO_HIT, SETKA_NO_HIT};

/// A walk moves by one cell of one axis at least each turn.
void check_costs(setka::Queue& queue, const setka::Tracer& tracer, const setka::Structure& structure,
                 const Queries& queries) {
    const auto rays = queue.upload(std::span(queries.rays), "rays");
    const auto skip = queue.upload(std::span(queries.skip), "skip");
    const auto costs = queue.make_buffer<setka::TraceCost>(queries.rays.size(), "costs");
    tracer.closest_hit_cost(queue, structure, {rays, skip}, costs);
    std::uint32_t most = 0;
    if (structure.kind() == setka::StructureKind::UniformGrid)
        for (const std::uint32_t dim : static_cast<const setka::Grid&>(structure).header().dims) most += dim;
    for (const setka::TraceCost& cost : queue.download(costs))
        check(cost.steps <= most, "a walk of " + std::to_string(cost.steps) + " steps through a grid of " +
                                      std::to_string(most) + " planes");
}

}  // namespace

std::vector<std::vector<Hit>> right_hits(const oracle::World& world, const Queries& queries) {
    auto right = oracle::all_hits(world, queries.rays, queries.skip, queries.mask);
    if (!queries.skip.empty()) return right;
    // The oracle's two loops agree.
    const std::vector<Hit> closest = oracle::closest_hits(world, queries.rays, queries.mask);
    for (std::size_t i = 0; i < right.size(); ++i)
        check(support::same_hits(std::span(queries.rays).subspan(i, 1), std::vector{closest[i]},
                                 std::vector{right[i].empty() ? miss : right[i].front()}),
              "the oracle's lists begin with its closest hits");
    return right;
}

void check_queries(setka::Queue& queue, const setka::Structure& structure, const Queries& queries,
                   const std::vector<std::vector<Hit>>& right) {
    const auto& rays = queries.rays;
    std::vector<Hit> closest;
    for (const auto& list : right) closest.push_back(list.empty() ? miss : list.front());
    for (const GridStep step : {GridStep::Dda, GridStep::BranchFree}) {
        const setka::Tracer tracer({step, queries.mask});
        check(support::same_hits(rays, closest, tracer.closest_hit(queue, structure, rays, queries.skip)),
              "closest hit");
        check(support::same_occlusion(rays, closest, tracer.any_hit(queue, structure, rays, queries.skip)),
              "any hit");
        check_costs(queue, tracer, structure, queries);
    }
    const setka::Tracer tracer({GridStep::Dda, queries.mask});
    for (const std::uint32_t most : {queries.max_hits, ~0u}) {
        const setka::HitLists lists = support::as_lists(right, most);
        check(support::same_lists(rays, lists, tracer.all_hits(queue, structure, rays, {most}, queries.skip)),
              "all hits");
        const auto counts = tracer.count_hits(queue, structure, rays, {most}, queries.skip);
        for (std::size_t i = 0; i < counts.size(); ++i)
            check(counts[i] == lists[i].size(), "the number of hits of ray " + std::to_string(i));
    }
}

void check_queries_end(setka::Queue& queue, const setka::Structure& structure, const Queries& queries) {
    const auto starts = queue.download(structure.geometry().instance_starts);
    const auto check_hit = [&](const Hit& hit) {
        check(hit.instance == SETKA_NO_HIT
                  ? hit.primitive == SETKA_NO_HIT
                  : hit.instance + 1 < starts.size() &&
                        hit.primitive < starts[hit.instance + 1] - starts[hit.instance],
              "a hit of a triangle that does not exist");
    };
    for (const GridStep step : {GridStep::Dda, GridStep::BranchFree}) {
        const setka::Tracer tracer({step, queries.mask});
        for (const Hit& hit : tracer.closest_hit(queue, structure, queries.rays, queries.skip))
            check_hit(hit);
        for (const std::uint32_t value : tracer.any_hit(queue, structure, queries.rays, queries.skip))
            check(value <= 1, "any hit is 0 or 1");
        check_costs(queue, tracer, structure, queries);
    }
    const setka::Tracer tracer({GridStep::Dda, queries.mask});
    (void)succeeds({ErrorCategory::OutOfMemory}, [&] {
        for (const Hit& hit :
             tracer.all_hits(queue, structure, queries.rays, {queries.max_hits}, queries.skip).hits)
            check_hit(hit);
    });
}

}  // namespace fuzz
