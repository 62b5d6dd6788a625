// SPDX-License-Identifier: MIT
#include "accel/scattered_lists.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "accel/compact_tables.hpp"
#include "core/exact_math.hpp"
#include "core/launch.hpp"
#include "device/grid/limits.h"

namespace setka {

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);
constexpr std::uint64_t world_words = 9, reach_words = 4, row_words = 2, piece_words = 4;

/// The longest list that one work-item puts in order: some ten thousand steps on drivers that end loops early
/// (algo/shape.hpp).
std::uint32_t longest_alone(const Device& device) {
    return device.options().primitives == PrimitiveShape::Serial ? 512 : 32;
}

/// The most pieces that one work-item cuts a list into, for drivers that end loops early (algo/shape.hpp).
constexpr std::uint32_t most_pieces = 30000;

/// Work-items for so many rows: few enough to be no matter where there is no row, and sixteen rows each at most; four on drivers
/// that may end loops early.
std::uint32_t row_items(const Device& device, std::uint32_t capacity) {
    return capacity / (device.options().primitives == PrimitiveShape::Serial ? 4 : 16) + 1;
}

/// Triangles that one work-item counts.
std::uint32_t triangles_an_item(const Device& device) {
    return device.options().primitives == PrimitiveShape::Serial ? 8 : 1;
}

/// The groups in which blocks are counted and laid out, a work-item each; 0 if there are too many, since each reads the sums of all before it:
/// then a scan in launches of its own costs less. Where a work-item is a core's, it does.
std::uint32_t block_groups(const Device& device, std::uint32_t blocks) {
    constexpr std::uint32_t most = 2048;
    const std::uint32_t size = device.options().work_group_size, groups = blocks / size + (blocks % size != 0);
    return device.options().primitives == PrimitiveShape::Serial || groups > most ? 0 : groups;
}

/// Whether the counters are cleared by the launch in which the first work-item finds the resolution, while the rest of a GPU has nothing else to do.
bool clears_beside(const Device& device) { return device.options().primitives != PrimitiveShape::Serial; }

/// Rows of large triangles that are provided for before any is seen: one a triangle, and those of some giants.
std::uint32_t usual_rows(std::uint32_t triangles) { return triangles + 8192; }

/// Where what begins in the working memory, in units of four words, so that vectors can be read. Kernels know where the counters are.
struct Parts {
    std::uint32_t blocks, sums, rows;
    std::uint64_t words;  ///< in all
    explicit Parts(const CountRoom& room)
        : blocks(static_cast<std::uint32_t>((SK_REPORT + room.counters) / 4)),
          sums(blocks + (room.groups != 0 ? room.blocks : 0)),
          rows(sums + room.groups / 2 + room.groups % 2),
          words(4 * std::uint64_t(rows) + room.rows * row_words) {}
};
static_assert(SK_REPORT % 4 == 0 && block_words == 4);

CountRoom room_with(const Device& device, std::uint32_t rows, std::uint32_t blocks, std::uint64_t counters) {
    return {rows, blocks, block_groups(device, blocks), (counters + 3) / 4 * 4};
}

/// Room for this grid.
CountRoom room_of(const Device& device, const ::SetkaGridHeader& header, std::uint32_t rows) {
    return room_with(device, rows, block_count(header), counter_count(header.dims));
}

/// Room for the grid of a usual scene with so many triangles, or for none. Blocks at the sides reach beyond the cells, by up to four cells
/// along each axis: 20 times a side of a cube of the cells is enough for boxes with sides of 1 : 1 : 1/8. A quarter more lets
/// flat ones fit that are large. No scene needs more than the most cells along each axis.
CountRoom usual_room(const Device& device, std::uint32_t triangles, const GridOptions& options) {
    const double cells = double(options.density) * triangles, side = exact::root(cells, 3);
    const double axis = (options.max_cells_per_axis + 3) / 4, most = axis * axis * axis;  // NOLINT: whole blocks
    const double blocks = std::min(std::ceil((1.25 * cells + 20 * side * side + 4096) / SK_BLOCK_CELLS), most);
    if (blocks * SK_BLOCK_CELLS > double(most_entries)) return {};
    const auto whole = static_cast<std::uint32_t>(blocks);
    const std::uint64_t counters = whole * std::uint64_t(SK_BLOCK_CELLS + 1);  // a mark's word a block at most
    return room_with(device, usual_rows(triangles), whole, counters);
}

/// The bytes that counting holds, world triangles not included.
std::uint64_t count_bytes(const Device& device, std::uint32_t triangles, const CountRoom& room) {
    const std::uint64_t of_scan =
        room.groups == 0 ? room.blocks * block_words * word + block_sums_bytes(device, room.blocks) : 0;
    return (Parts(room).words + triangles * reach_words) * word + of_scan;
}

/// Whether counting fits the budget beside the world's triangles, and the working memory one allocation.
bool fits_counting(const GridLimits& limits, const Device& device, std::uint32_t triangles, const CountRoom& room) {
    return limits.fits_an_allocation(Parts(room).words) &&
           limits.fits(triangles * world_words * word + count_bytes(device, triangles, room));
}

/// Counts every triangle in its cells of the grid in the report, and the blocks' cells and pairs. Counters are 0.
void enqueue_count(Queue& queue, const WorldGeometry& geometry, ScatteredCount& count, std::uint64_t most_rows) {
    const CountRoom& room = count.room;
    const Parts at(room);
    const std::uint32_t n = geometry.triangle_count, items = row_items(queue.device(), room.rows);
    queue.impl().begin_stage("count");
    count.reaches = queue.make_buffer<std::uint32_t>(n * reach_words, "cells of small triangles");
    const std::uint32_t run = triangles_an_item(queue.device());
    launch_range(queue, Kernel::scatter_count, (n + run - 1) / run, triangles_a_launch(queue.device()) / run, run,
                 at.rows, room.rows, geometry.triangles, count.working, count.reaches);
    launch_range(queue, Kernel::scatter_count_rows, items, most_rows / 16, items, at.rows, room.rows, geometry.triangles,
                 count.working);
    queue.impl().begin_stage("blocks");
    const std::uint32_t alone = longest_alone(queue.device());
    if (room.groups != 0) {
        launch_items(queue, Kernel::blocks_tally, room.blocks, alone, at.blocks, at.sums, count.working);
    } else {
        count.blocks = queue.make_buffer<std::uint32_t>(room.blocks * block_words, "counted blocks");
        launch_items(queue, Kernel::blocks_count, room.blocks, alone, count.working, count.blocks);
        count.sums = enqueue_block_sums(queue, count.blocks, count.working);
    }
}

/// Puts lists in order that are cut into pieces: these first, then runs of two, four, ….
void sort_pieces(Queue& queue, const ScatteredCount& count, const Buffer<std::uint32_t>& pieces,
                 const Buffer<std::uint32_t>& references) {
    if (count.pieces == 0) return;
    const std::uint32_t n = count.pieces * SK_PIECE;
    auto from = queue.make_buffer<std::uint32_t>(n, "sorted runs");
    auto to = queue.make_buffer<std::uint32_t>(n, "longer runs");
    launch_items(queue, Kernel::lists_rank, n, pieces, references, from);
    for (std::uint32_t width = SK_PIECE, is_last = 0; is_last == 0; width *= 2) {
        is_last = count.longest_list <= 2 * std::uint64_t(width) ? 1 : 0;
        launch_items(queue, Kernel::lists_merge, n, width, is_last, pieces, from, to, references);
        std::swap(from, to);
    }
}

}  // namespace

void ScatteredCount::learn(const BlockTotals& totals) noexcept {
    cells = totals.cells;
    rows = totals.rows;
    longest_list = totals.longest_list;
    pieces = totals.pieces;
}

ScatteredCount make_room(Queue& queue, std::uint32_t triangles, const GridOptions& options, const GridLimits& limits) {
    const Device& device = queue.device();
    const CountRoom room = usual_room(device, triangles, options);
    ScatteredCount count;
    if (!device.impl()->has_doubles() || queue.stop_token().stop_possible() || room.blocks == 0 ||
        !fits_counting(limits, device, triangles, room))
        return count;
    count.room = room;
    count.working = make_working_memory(queue, Parts(room).words,
                                        clears_beside(device) ? SK_REPORT : SK_REPORT + room.counters);
    return count;
}

Buffer<std::uint32_t> report_in(const ScatteredCount& count) {
    if (count.working.empty()) return {};
    return {count.working.memory(), SK_REPORT};
}

void start_count(Queue& queue, const WorldGeometry& geometry, const GridOptions& options, ScatteredCount& count) {
    const CountRoom& room = count.room;
    const bool clears = clears_beside(queue.device());
    launch_items(queue, clears ? Kernel::grid_resolve_clear : Kernel::grid_resolve,
                 clears ? static_cast<std::uint32_t>(room.counters / 4) : 1, room.blocks, options.density,
                 options.max_cells_per_axis, geometry.triangle_count, geometry.instance_count, count.working);
    enqueue_count(queue, geometry, count, most_entries);
}

std::optional<ScatteredCount> finish_count(Queue& queue, const WorldGeometry& geometry, ::SetkaGridHeader& header,
                                           const GridLimits& limits, ScatteredCount started, const Report& words,
                                           std::uint64_t& held_bytes) {
    const Device& device = queue.device();
    const std::uint32_t n = header.triangle_count;
    const std::uint64_t world = geometry.triangles.size_bytes();
    const auto fits = [&](std::uint32_t rows) {
        return fits_counting(limits, device, n, room_of(device, header, rows));
    };
    ScatteredCount count = std::move(started);
    BlockTotals totals = totals_of(words);
    const auto count_again = [&](std::uint32_t rows) {
        count = {};
        const CountRoom& room = count.room = room_of(device, header, rows);
        held_bytes = std::max(held_bytes, count_bytes(device, n, room));
        count.working = make_working_memory(queue, Parts(room).words, SK_REPORT + room.counters);
        report_header(queue, count.working, header);
        enqueue_count(queue, geometry, count, rows_a_launch(device, header.dims));
        totals = totals_of(read_report(queue, count.working));
    };
    if (count.room.blocks != 0) held_bytes = count_bytes(device, n, count.room);
    if (count.room.blocks < block_count(header) || !has_header(words, header)) {
        if (!fits(usual_rows(n))) return {};
        count_again(usual_rows(n));
    }
    const auto is_hopeless = [&] {
        return totals.rows >= SK_MOST_ROWS || totals.long_rows >= SK_MOST_LONG_ROWS ||
               (device.options().primitives == PrimitiveShape::Serial &&
                totals.longest_list / SK_PIECE > most_pieces) ||
               !fits(std::max(totals.rows, usual_rows(n)));
    };
    if (is_hopeless()) return {};
    if (totals.rows > count.room.rows) count_again(totals.rows);
    if (totals.pairs > most_entries)
        limits.refuse_count((totals.found_long_rows < SK_MOST_LONG_ROWS ? "" : "at least ") +
                            std::to_string(totals.pairs) + " pairs (triangle, cell)");
    header.reference_count = static_cast<std::uint32_t>(totals.pairs);
    count.learn(totals);
    if (count.room.blocks > block_count(header) && !limits.fits(world + scattered_bytes(device, header, count))) {
        count_again(count.room.rows);  // without the blocks that there are not
        count.learn(totals);
    }
    return count;
}

std::uint64_t started_bytes(const Device& device, std::uint32_t triangles, const ScatteredCount& started) {
    return started.room.blocks == 0 ? report_bytes : count_bytes(device, triangles, started.room);
}

std::uint64_t scattered_bytes(const Device& device, const ::SetkaGridHeader& header,
                              const ScatteredCount& count) {
    return count_bytes(device, header.triangle_count, count.room) +
           (block_count(header) * block_words + count.cells * cell_words + header.reference_count +
            count.pieces * (piece_words + 2 * SK_PIECE)) *
               word;
}

CompactTables build_scattered(Queue& queue, const WorldGeometry& geometry, const ::SetkaGridHeader& header,
                              ScatteredCount count) {
    CompactTables tables;
    queue.impl().begin_stage("blocks");
    tables.cells = queue.make_buffer<std::uint32_t>(count.cells * cell_words, "cells");
    const std::uint32_t alone = longest_alone(queue.device());
    const Parts at(count.room);
    const bool is_tallied = count.room.groups != 0;
    if (!is_tallied) enqueue_block_starts(queue, count.sums, count.blocks);
    tables.blocks = queue.make_buffer<std::uint32_t>(block_count(header) * block_words, "blocks");
    const auto pieces = queue.make_buffer<std::uint32_t>(count.pieces * piece_words, "pieces of lists");
    if (is_tallied)
        launch_items(queue, Kernel::blocks_settle, block_count(header), alone, header, at.blocks, at.sums,
                     count.working, tables.blocks, tables.cells, pieces);
    else
        launch_items(queue, Kernel::blocks_lay_out, block_count(header), alone, header, count.working, count.blocks,
                     tables.blocks, tables.cells, pieces);
    queue.impl().begin_stage("place");
    tables.references = queue.make_buffer<std::uint32_t>(header.reference_count, "references");
    launch_range(queue, Kernel::scatter_place, header.triangle_count, triangles_a_launch(queue.device()), header,
                 geometry.triangles, count.working, count.reaches, tables.references);
    const std::uint32_t items = std::min(row_items(queue.device(), count.room.rows), count.rows);
    launch_range(queue, Kernel::scatter_place_rows, items, rows_a_launch(queue.device(), header.dims) / 16, items,
                 at.rows, count.room.rows, header, geometry.triangles, count.working, tables.references);
    queue.impl().begin_stage("sort");
    launch_items(queue, Kernel::lists_sort, count.cells, alone, tables.cells, tables.references);
    sort_pieces(queue, count, pieces, tables.references);
    tables.longest_list = count.longest_list;
    return tables;
}

}  // namespace setka
