// SPDX-License-Identifier: MIT
#include "accel/binned_lists.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/exact_math.hpp"
#include "core/launch.hpp"
#include "device/grid/limits.h"

namespace setka {

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);
constexpr std::uint64_t reach_words = 4;

std::uint64_t divide_up(std::uint64_t a, std::uint64_t b) noexcept { return (a + b - 1) / b; }

std::uint32_t bin_count(const ::SetkaGridHeader& header) noexcept {
    std::uint64_t bins = 1;
    for (const std::uint32_t dim : header.dims) bins *= divide_up(dim, SK_BIN_SIDE);
    return static_cast<std::uint32_t>(bins);
}

/// Pairs that are provided for before any is seen, by density: triangles of closed surfaces reach into 1.8 (spheres) to 3.5 cells (terrain,
/// scans) each at 8, coarse ones into 5 to 6, and into as many more as cells have sides.
std::uint64_t usual_pairs(std::uint32_t triangles, float density) {
    const double side = exact::root(double(density), 3) / 2;
    return static_cast<std::uint64_t>(std::ceil(double(triangles) * (2 + 4 * side * side))) + 8192;
}

/// Runs long enough to be worth their bounds, and so many that cores come out even and, of scenes of a million triangles or two, stay in their caches.
/// Few work-items share them, and groups of bins, with reaches and counters that stay there too, but more than cores: PoCL hands a core several at once.
/// Other devices may end a long loop early, or have very many work-items: there bins and short runs have one each.
BinRoom divided(const Device& device, std::uint32_t triangles, BinRoom room) {
    constexpr std::uint32_t most_counters = 1u << 24;
    const std::uint32_t shortest = prefers_bins(device) ? 2048 : 64;
    const std::uint32_t items = 4 * std::max(1u, device.info().compute_units);
    const std::uint64_t runs = prefers_bins(device) ? std::max(64u, 4 * items) : std::max<std::uint64_t>(1, divide_up(triangles, shortest));
    const std::uint64_t most_runs = std::clamp<std::uint64_t>(most_counters / room.bins, 1, runs);
    room.run = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(divide_up(triangles, most_runs), shortest, SK_LONGEST_RUN));
    room.runs = static_cast<std::uint32_t>(divide_up(triangles, room.run));
    room.run_items = prefers_bins(device) ? std::min(room.runs, items) : room.runs;
    room.bin_items = prefers_bins(device) ? std::min(room.bins, items) : room.bins;
    room.together = std::clamp(room.bins / (8 * room.bin_items), 1u, 16u);
    // Enough for those that are not empty in terrain, spheres, scans and buildings at the default density, as half of it is not.
    room.kept = prefers_bins(device) ? std::min(room.blocks, triangles / 24 + SK_BIN_BLOCKS) : 0;
    return room;
}

/// Room for this grid.
BinRoom room_of(const Device& device, const ::SetkaGridHeader& header, std::uint64_t pairs) {
    return divided(device, header.triangle_count,
                   {.blocks = block_count(header), .bins = bin_count(header), .pairs = static_cast<std::uint32_t>(pairs)});
}

/// Room for the grid of a usual scene with so many triangles, or for none: what reaches beyond the sides is some 20 times a
/// side of a cube of the cells, four cells deep of blocks and sixteen of bins (scattered_lists.cpp).
BinRoom usual_room(const Device& device, std::uint32_t triangles, const GridOptions& options) {
    const double cells = double(options.density) * triangles, side = exact::root(cells, 3);
    const auto whole = [&](double beyond, double in_each, std::uint32_t width) {
        const double axis = divide_up(options.max_cells_per_axis, width);
        return std::min(std::ceil((1.25 * cells + beyond * side * side + 4096) / in_each), axis * axis * axis);
    };
    const double blocks = whole(20, SK_BLOCK_CELLS, 4), bins = whole(100, SK_BIN_CELLS, SK_BIN_SIDE);
    const std::uint64_t pairs = usual_pairs(triangles, options.density);
    if (blocks * SK_BLOCK_CELLS > double(most_entries) || pairs > most_entries) return {};
    return divided(device, triangles,
                   {.blocks = static_cast<std::uint32_t>(blocks),
                    .bins = static_cast<std::uint32_t>(bins),
                    .pairs = static_cast<std::uint32_t>(pairs)});
}

std::uint64_t reaches_of(const BinRoom& room) { return std::uint64_t(room.run_items) * room.run * reach_words; }
std::uint64_t kept_of(const BinRoom& room) { return std::uint64_t(room.kept) * SK_KEPT_WORDS; }
std::uint64_t bounds_of(const BinRoom& room) { return room.runs * (room.bins + std::uint64_t(1)); }

/// The bytes that both filling and placing hold, world triangles not included.
std::uint64_t common_bytes(const Device& device, const BinRoom& room) {
    return report_bytes + block_sums_bytes(device, room.blocks) +
           (bounds_of(room) + room.pairs + std::uint64_t(room.bin_items) * SK_BIN_CELLS + 3 * std::uint64_t(room.bins) +
            room.blocks * block_words) *
               word;
}

/// The bytes that filling holds, world triangles not included.
std::uint64_t fill_bytes(const Device& device, const BinRoom& room) {
    return common_bytes(device, room) + (reaches_of(room) + kept_of(room)) * word;
}

/// Whether filling fits the budget beside the world's triangles, and each of its tables one allocation.
bool fits_filling(const GridLimits& limits, const Device& device, const WorldGeometry& geometry, const BinRoom& room) {
    for (const std::uint64_t words : {std::uint64_t(room.pairs), reaches_of(room), kept_of(room), room.blocks * block_words, bounds_of(room),
                                      std::uint64_t(room.bin_items) * SK_BIN_CELLS})
        if (!limits.fits_an_allocation(words)) return false;
    return limits.fits(geometry.triangles.size_bytes() + fill_bytes(device, room));
}

/// Launches a kernel whose work-items, each a group of its own, share n runs or groups of bins. Where a stop can be requested, `step` at a time.
template <typename... Ts>
void launch_shared(Queue& queue, Kernel kernel, std::uint32_t n, std::uint32_t items, std::uint64_t step, BinnedCount& count,
                   const Ts&... arguments) {
    const bool has_one_each = !prefers_bins(queue.device());
    if (!queue.impl().stop_token().stop_possible()) step = n;
    for (std::uint64_t first = 0; first < n; first += step) {
        const auto end = static_cast<std::uint32_t>(std::min(first + step, std::uint64_t(n))), elements = end - static_cast<std::uint32_t>(first);
        const std::uint32_t own = has_one_each ? elements : items, before = count.taken - static_cast<std::uint32_t>(first);
        launch_groups(queue, kernel, own, 1, end, own, before, has_one_each ? 1 : ~0u, count.room.run, count.room.bins, arguments...);
        count.taken += has_one_each ? own : elements + own;  // each has taken one too many, if it could
    }
}

/// The same for the first bins.
template <typename... Ts>
void launch_bins(Queue& queue, Kernel kernel, std::uint32_t bins, BinnedCount& count, const Ts&... arguments) {
    const auto groups = static_cast<std::uint32_t>(divide_up(bins, count.room.together));
    launch_shared(queue, kernel, groups, count.room.bin_items, count.room.bin_items, count, arguments...);
}

/// Large triangles with so many cells at least, in units of SK_LONG_ROW, are not for bins: their rows are better spread over work-items of
/// their own (scattered_lists.hpp).
std::uint32_t most_units(std::uint32_t triangles) { return triangles / 4 + (1u << 14); }

/// Leaves the pairs of each run in order of the bins of the grid in the report, if there is room, and counts the blocks' cells and pairs.
BinnedCount enqueue_bins(Queue& queue, const WorldGeometry& geometry, const Buffer<std::uint32_t>& report, const BinRoom& room) {
    const std::uint32_t most = most_units(geometry.triangle_count);
    BinnedCount count;
    count.room = room;
    count.report = report;
    queue.impl().begin_stage("bins");
    count.reaches = queue.make_buffer<std::uint32_t>(reaches_of(room), "cells of small triangles");
    count.bounds = queue.make_buffer<std::uint32_t>(bounds_of(room), "bounds of pairs in bins");
    count.pairs = queue.make_buffer<std::uint32_t>(room.pairs, "pairs in bins");
    const std::uint64_t a_launch = std::max<std::uint64_t>(room.run_items, triangles_a_launch(queue.device()) / room.run);
    launch_shared(queue, Kernel::bins_fill, room.runs, room.run_items, a_launch, count, room.pairs, most, geometry.triangles, count.reaches, count.bounds,
                  count.pairs, report);
    queue.impl().begin_stage("blocks");
    count.counters = queue.make_buffer<std::uint32_t>(std::uint64_t(room.bin_items) * SK_BIN_CELLS, "counters of bins");
    count.filled = queue.make_buffer<std::uint64_t>(room.bins, "filled blocks of bins");
    count.kept = queue.make_buffer<std::uint32_t>(kept_of(room), "counts of cells");
    count.starts = queue.make_buffer<std::uint32_t>(room.bins, "where counts of bins are kept");
    count.blocks = queue.make_buffer<std::uint32_t>(room.blocks * block_words, "counted blocks");
    launch_bins(queue, Kernel::bins_tally, room.bins, count, room.pairs, most, room.runs, room.together, room.blocks, count.bounds, count.pairs,
                count.counters, count.blocks, count.filled, count.kept, count.starts, room.kept, report);
    count.block_sums = enqueue_block_sums(queue, count.blocks, report);
    return count;
}

}  // namespace

bool prefers_bins(const Device& device) { return device.impl()->width() > 1; }

BinnedCount start_bins(Queue& queue, const StartedTransform& transform, const GridOptions& options,
                       const GridLimits& limits) {
    const Device& device = queue.device();
    const WorldGeometry& geometry = transform.geometry;
    const std::uint32_t n = geometry.triangle_count;
    const BinRoom room = usual_room(device, n, options);
    if (!device.impl()->has_doubles() || queue.stop_token().stop_possible() || room.blocks == 0 ||
        !fits_filling(limits, device, geometry, room)) {
        BinnedCount nothing;
        nothing.report = transform.report;
        return nothing;
    }
    launch_items(queue, Kernel::grid_resolve, 1, room.blocks, options.density, options.max_cells_per_axis, n,
                 geometry.instance_count, transform.report);
    return enqueue_bins(queue, geometry, transform.report, room);
}

std::optional<BinnedCount> finish_bins(Queue& queue, const WorldGeometry& geometry, ::SetkaGridHeader& header,
                                       const GridOptions& options, const GridLimits& limits, BinnedCount started,
                                       const Report& words, std::uint64_t& held_bytes) {
    const Device& device = queue.device();
    const std::uint32_t n = header.triangle_count;
    const std::uint64_t world = geometry.triangles.size_bytes();
    BinnedCount count = std::move(started);
    BlockTotals totals = totals_of(words);
    const auto fits = [&](const BinRoom& room) { return fits_filling(limits, device, geometry, room); };
    /// Fills bins of this grid if there is room for so many pairs; with room for none they are counted.
    const auto fill_again = [&](std::uint64_t pairs) {
        const BinRoom room = room_of(device, header, pairs);
        if (!fits(room)) return false;
        const Buffer<std::uint32_t> report = std::exchange(count, {}).report;
        report_header(queue, report, header);
        held_bytes = std::max(held_bytes, fill_bytes(device, room));
        count = enqueue_bins(queue, geometry, report, room);
        totals = totals_of(read_report(queue, report));
        return true;
    };
    if (count.room.blocks != 0) held_bytes = fill_bytes(device, count.room);
    const bool has_room = count.room.blocks >= block_count(header) && count.room.bins >= bin_count(header);
    if (!has_room || !has_header(words, header)) {
        // Where the room that is usual was not enough this is a sheet most likely, whose triangles lie in their cells with all of their area.
        const std::uint64_t usual = usual_pairs(n, options.density), wanted = count.room.blocks != 0 ? 4 * usual : usual;
        if (!fill_again(std::min(wanted, most_entries)) && !fill_again(0)) return {};
    }
    if (totals.long_rows >= most_units(n)) return {};
    if (totals.binned_pairs > most_entries)
        limits.refuse_count((totals.found_long_rows < SK_MOST_LONG_ROWS ? "" : "at least ") +
                            std::to_string(totals.binned_pairs) + " pairs (triangle, cell)");
    if (totals.binned_pairs > count.room.pairs && !fill_again(totals.binned_pairs)) return {};
    const auto has_space = [&] {
        header.reference_count = static_cast<std::uint32_t>(totals.pairs);
        count.cells = totals.cells;
        count.longest_list = totals.longest_list;
        const auto fits_with_tables = [&] { return limits.fits(world + binned_bytes(device, header, count)); };
        if (fits_with_tables()) return true;
        count.kept = {};  // placing does without
        return fits_with_tables();
    };
    const bool is_exact = count.room.pairs == totals.binned_pairs && count.room.blocks == block_count(header);
    if (!has_space() && (is_exact || !fill_again(totals.binned_pairs) || !has_space())) return {};
    count.reaches = {};
    return count;
}

std::uint64_t started_bytes(const Device& device, const BinnedCount& started) {
    return started.room.blocks == 0 ? report_bytes : fill_bytes(device, started.room);
}

std::uint64_t binned_bytes(const Device& device, const ::SetkaGridHeader& header, const BinnedCount& count) {
    return common_bytes(device, count.room) +
           (count.kept.size() + block_count(header) * block_words + count.cells * cell_words + header.reference_count) * word;
}

CompactTables build_binned(Queue& queue, const ::SetkaGridHeader& header, BinnedCount count) {
    CompactTables tables;
    queue.impl().begin_stage("blocks");
    tables.cells = queue.make_buffer<std::uint32_t>(count.cells * cell_words, "cells");
    tables.blocks = queue.make_buffer<std::uint32_t>(block_count(header) * block_words, "blocks");
    tables.references = queue.make_buffer<std::uint32_t>(header.reference_count, "references");
    enqueue_block_starts(queue, count.block_sums, count.blocks);
    queue.impl().begin_stage("lists");
    launch_bins(queue, Kernel::bins_place, bin_count(header), count, count.room.runs, count.room.together, header, count.bounds, count.pairs,
                count.counters, count.blocks, count.filled, count.kept, count.starts, tables.blocks, tables.cells,
                tables.references, count.report);
    tables.longest_list = count.longest_list;
    return tables;
}

}  // namespace setka
