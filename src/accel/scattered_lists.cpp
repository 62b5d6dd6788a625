// SPDX-License-Identifier: MIT
#include "accel/scattered_lists.hpp"

#include <algorithm>

#include "accel/compact_tables.hpp"
#include "core/launch.hpp"
#include "device/grid/limits.h"

namespace setka {

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);
constexpr std::uint64_t reach_words = 4, row_words = 2, piece_words = 4;

/// The longest list that one work-item puts in order: some ten thousand steps on drivers that end loops early
/// (algo/shape.hpp).
std::uint32_t longest_alone(const Device& device) {
    return device.options().primitives == PrimitiveShape::Serial ? 512 : 32;
}

/// Rows of large triangles that are provided for before any is seen: one a triangle, and those of some giants.
std::uint32_t usual_rows(const ::SetkaGridHeader& header) { return header.triangle_count + 8192; }

/// The most pieces that one work-item cuts a list into, for drivers that end loops early (algo/shape.hpp).
constexpr std::uint32_t most_pieces = 30000;

/// Work-items for so many rows: few enough to be no matter where there is no row, and sixteen rows each at most; four on drivers
/// that may end loops early.
std::uint32_t row_items(const Device& device, std::uint32_t capacity) {
    return capacity / (device.options().primitives == PrimitiveShape::Serial ? 4 : 16) + 1;
}

/// The most triangles of one launch where a stop can be requested.
std::uint64_t triangles_a_launch(const Device& device) {
    return device.info().type == DeviceType::Cpu ? 1u << 16 : 1u << 22;
}

/// Triangles that one work-item counts: where it does several side by side, enough to find such as are alike.
std::uint32_t triangles_an_item(const Device& device) {
    if (device.impl()->width() > 1) return 64;
    return device.options().primitives == PrimitiveShape::Serial ? 8 : 1;
}

/// Counts every triangle in its cells, and the blocks' cells and pairs.
BlockTotals count_all(Queue& queue, const WorldGeometry& geometry, const ::SetkaGridHeader& header,
                      ScatteredCount& count) {
    const std::uint32_t n = header.triangle_count, items = row_items(queue.device(), count.row_capacity);
    queue.impl().begin_stage("count");
    count.row_list = queue.make_buffer<std::uint32_t>(count.row_capacity * row_words, "rows of large triangles");
    queue.impl().fill(*count.totals.memory(), 0, count.totals.size_bytes());
    count.counters = make_counters(queue, header);
    const std::uint32_t run = triangles_an_item(queue.device());
    launch_range(queue, Kernel::scatter_count, (n + run - 1) / run, triangles_a_launch(queue.device()) / run, run,
                 header, geometry.triangles,
                 count.counters, count.reaches, count.row_capacity, count.row_list, count.totals);
    launch_range(queue, Kernel::scatter_count_rows, items, rows_a_launch(queue.device(), header) / 16, items,
                 header, geometry.triangles, count.counters, count.row_capacity, count.row_list, count.totals);
    queue.impl().begin_stage("blocks");
    launch_items(queue, Kernel::blocks_count, block_count(header),
                 longest_alone(queue.device()), header, count.counters, count.blocks, count.totals);
    count.sums = enqueue_block_sums(queue, count.blocks, count.totals);
    return read_totals(queue, count.totals);
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

std::optional<ScatteredCount> count_scattered(Queue& queue, const WorldGeometry& geometry,
                                              ::SetkaGridHeader& header, const GridLimits& limits,
                                              std::uint64_t& held_bytes) {
    const std::uint64_t world = geometry.triangles.size_bytes();
    ScatteredCount count;
    count.row_capacity = usual_rows(header);
    if (!limits.fits(world + scattered_count_bytes(queue.device(), header, count.row_capacity))) return {};
    held_bytes = scattered_count_bytes(queue.device(), header, count.row_capacity);
    count.totals = make_totals(queue);
    count.blocks = queue.make_buffer<std::uint32_t>(block_count(header) * block_words, "blocks");
    count.reaches =
        queue.make_buffer<std::uint32_t>(header.triangle_count * reach_words, "cells of small triangles");
    BlockTotals totals = count_all(queue, geometry, header, count);
    const auto is_hopeless = [&] {
        return totals.rows >= SK_MOST_ROWS || totals.long_rows >= SK_MOST_LONG_ROWS ||
               totals.rows * row_words * word > queue.device().info().max_allocation_bytes ||
               (queue.device().options().primitives == PrimitiveShape::Serial &&
                totals.longest_list / SK_PIECE > most_pieces) ||
               !limits.fits(world + scattered_count_bytes(queue.device(), header,
                                                          std::max(totals.rows, count.row_capacity)));
    };
    if (is_hopeless()) return {};
    if (totals.rows > count.row_capacity) {
        count.row_capacity = totals.rows;
        held_bytes = scattered_count_bytes(queue.device(), header, count.row_capacity);
        count.row_list = {};
        count.counters = {};
        count.sums = {};
        totals = count_all(queue, geometry, header, count);
    }
    if (totals.pairs > most_entries)
        limits.refuse_count((totals.found_long_rows < SK_MOST_LONG_ROWS ? "" : "at least ") +
                            std::to_string(totals.pairs) + " pairs (triangle, cell)");
    header.reference_count = static_cast<std::uint32_t>(totals.pairs);
    count.cells = totals.cells;
    count.rows = totals.rows;
    count.longest_list = totals.longest_list;
    count.pieces = totals.pieces;
    return count;
}

std::uint64_t scattered_count_bytes(const Device& device, const ::SetkaGridHeader& header,
                                    std::uint32_t row_capacity) {
    const std::uint32_t blocks = block_count(header);
    return (SK_TOTALS + counter_count(header.dims) + blocks * block_words + header.triangle_count * reach_words +
            row_capacity * row_words) *
               word +
           block_sums_bytes(device, blocks);
}

std::uint64_t scattered_bytes(const Device& device, const ::SetkaGridHeader& header,
                              const ScatteredCount& count) {
    return scattered_count_bytes(device, header, count.row_capacity) +
           (count.cells * cell_words + header.reference_count + count.pieces * (piece_words + 2 * SK_PIECE)) *
               word;
}

CompactTables build_scattered(Queue& queue, const WorldGeometry& geometry, const ::SetkaGridHeader& header,
                              ScatteredCount count) {
    CompactTables tables;
    queue.impl().begin_stage("blocks");
    tables.cells = queue.make_buffer<std::uint32_t>(count.cells * cell_words, "cells");
    enqueue_block_starts(queue, count.sums, count.blocks);
    const std::uint32_t alone = longest_alone(queue.device());
    const auto pieces = queue.make_buffer<std::uint32_t>(count.pieces * piece_words, "pieces of lists");
    launch_items(queue, Kernel::blocks_lay_out, block_count(header), alone, header, count.counters, count.blocks,
                 tables.cells, pieces, count.totals);
    queue.impl().begin_stage("place");
    tables.references = queue.make_buffer<std::uint32_t>(header.reference_count, "references");
    launch_range(queue, Kernel::scatter_place, header.triangle_count, triangles_a_launch(queue.device()), header,
                 geometry.triangles, count.counters, count.reaches, tables.references);
    const std::uint32_t items = std::min(row_items(queue.device(), count.row_capacity), count.rows);
    launch_range(queue, Kernel::scatter_place_rows, items, rows_a_launch(queue.device(), header) / 16, items,
                 header, geometry.triangles, count.counters, count.row_capacity, count.row_list, count.totals,
                 tables.references);
    queue.impl().begin_stage("sort");
    launch_items(queue, Kernel::lists_sort, count.cells, alone, tables.cells, tables.references);
    sort_pieces(queue, count, pieces, tables.references);
    tables.blocks = std::move(count.blocks);
    tables.longest_list = count.longest_list;
    return tables;
}

}  // namespace setka
