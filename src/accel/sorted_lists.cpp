// SPDX-License-Identifier: MIT
#include "accel/sorted_lists.hpp"

#include <algorithm>
#include <bit>

#include "accel/compact_tables.hpp"
#include "algo/scan.hpp"
#include "algo/sort.hpp"
#include "core/launch.hpp"
#include "device/grid/limits.h"

namespace setka {

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);

/// Bits that a cell number of this grid can have.
std::uint32_t key_bits_of(const ::SetkaGridHeader& header) { return std::bit_width(header.cell_count - 1); }

/// Row starts, row triangles and row offsets.
std::uint64_t row_table_bytes(std::uint64_t triangles, std::uint64_t rows) {
    return ((triangles + 1) + rows + (rows + 1)) * word;
}

/// The bytes that counting the pairs holds.
std::uint64_t count_bytes(Queue& queue, std::uint64_t triangles, std::uint64_t rows) {
    return row_table_bytes(triangles, rows) + rows * word + word +
           scan_scratch_bytes(queue, static_cast<std::uint32_t>(rows));
}

/// The bytes that finding out which cells are not empty holds.
std::uint64_t mark_bytes(const Device& device, const ::SetkaGridHeader& header) {
    const std::uint32_t blocks = block_count(header);
    return (SK_REPORT + counter_count(header.dims) + blocks * block_words) * word + block_sums_bytes(device, blocks);
}

void count_rows(Queue& queue, const WorldGeometry& geometry, const ::SetkaGridHeader& header,
                const GridLimits& limits, SortedCount& count) {
    const std::uint32_t n = header.triangle_count;
    queue.impl().begin_stage("rows");
    const auto rows = queue.make_buffer<std::uint32_t>(n, "rows a triangle");
    count.row_starts = queue.make_buffer<std::uint32_t>(std::size_t(n) + 1, "row starts");
    launch_items(queue, Kernel::grid_rows, n, header, geometry.triangles, rows);
    count.rows = total_of(queue, enqueue_exclusive_scan(queue, rows, n, count.row_starts));
    if (count.rows > most_entries) limits.refuse_count(std::to_string(count.rows) + " rows of cells");
}

void count_pairs(Queue& queue, const WorldGeometry& geometry, ::SetkaGridHeader& header,
                 const GridLimits& limits, SortedCount& count) {
    const auto r = static_cast<std::uint32_t>(count.rows);
    count.row_triangles = queue.make_buffer<std::uint32_t>(r, "row triangles");
    count.row_offsets = queue.make_buffer<std::uint32_t>(std::size_t(r) + 1, "row offsets");
    launch_items(queue, Kernel::grid_row_list, header.triangle_count, count.row_starts, count.row_triangles);
    queue.impl().begin_stage("count");
    const auto counts = queue.make_buffer<std::uint32_t>(r, "cells a row");
    const auto long_rows = queue.make_buffer<std::uint32_t>(1, "columns of long rows");
    queue.impl().fill(*long_rows.memory(), 0, long_rows.size_bytes());
    launch_range(queue, Kernel::grid_count, r, rows_a_launch(queue.device(), header.dims), header,
                 geometry.triangles, count.row_triangles, count.row_starts, counts, long_rows);
    const std::uint64_t pairs = total_of(queue, enqueue_exclusive_scan(queue, counts, r, count.row_offsets));
    if (pairs > most_entries) {
        const bool is_all = queue.download(long_rows).front() < SK_MOST_LONG_ROWS;
        limits.refuse_count((is_all ? "" : "at least ") + std::to_string(pairs) + " pairs (triangle, cell)");
    }
    header.reference_count = static_cast<std::uint32_t>(pairs);
}

/// How many cells are not empty: their records are part of the tables.
void count_cells(Queue& queue, const WorldGeometry& geometry, const ::SetkaGridHeader& header,
                 SortedCount& count) {
    const std::uint32_t n = block_count(header);
    const std::uint64_t words = SK_REPORT + counter_count(header.dims);
    const auto working = make_working_memory(queue, words, words);
    launch_range(queue, Kernel::grid_mark, static_cast<std::uint32_t>(count.rows),
                 rows_a_launch(queue.device(), header.dims), header, geometry.triangles, count.row_triangles,
                 count.row_starts, working);
    const auto blocks = queue.make_buffer<std::uint32_t>(n * block_words, "blocks");
    report_header(queue, working, header);
    launch_items(queue, Kernel::blocks_count, n, ~0u, working, blocks);
    const auto sums = enqueue_block_sums(queue, blocks, working);
    count.cells = totals_of(read_report(queue, working)).cells;
}

}  // namespace

SortedCount count_sorted(Queue& queue, const WorldGeometry& geometry, ::SetkaGridHeader& header,
                         const GridLimits& limits) {
    SortedCount count;
    count_rows(queue, geometry, header, limits, count);
    const std::uint64_t triangles = header.triangle_count;
    limits.check_budget(9 * triangles * sizeof(float) + count_bytes(queue, triangles, count.rows),
                        "to count pairs in " + std::to_string(count.rows) + " rows of cells");
    limits.check_allocation(count.rows + 1, "row offsets");
    count_pairs(queue, geometry, header, limits, count);
    count_cells(queue, geometry, header, count);
    return count;
}

std::uint64_t sorted_bytes(Queue& queue, const ::SetkaGridHeader& header, const SortedCount& count) {
    const std::uint64_t n = header.triangle_count, p = header.reference_count, c = header.cell_count;
    const auto n32 = header.triangle_count, p32 = header.reference_count;
    const std::uint64_t pairs = 2 * p * word, flat = (2 * c + p) * word;
    const std::uint64_t rows = row_table_bytes(n, count.rows);
    return std::max({n * word + (n + 1) * word + scan_scratch_bytes(queue, n32),
                     count_bytes(queue, n, count.rows), rows + mark_bytes(queue.device(), header), rows + pairs,
                     pairs + sort_scratch_bytes(queue, p32, key_bits_of(header)), pairs + 2 * c * word,
                     flat + import_bytes(queue.device(), header, count.cells)});
}

GridTables build_sorted(Queue& queue, const WorldGeometry& geometry, const ::SetkaGridHeader& header,
                        SortedCount count, CellTables method) {
    const std::uint32_t pair_count = header.reference_count;
    queue.impl().begin_stage("emit");
    auto cells = queue.make_buffer<std::uint32_t>(pair_count, "pair cells");
    auto references = queue.make_buffer<std::uint32_t>(pair_count, "references");
    launch_range(queue, Kernel::grid_emit, static_cast<std::uint32_t>(count.rows),
                 rows_a_launch(queue.device(), header.dims), header, geometry.triangles, count.row_triangles,
                 count.row_starts, count.row_offsets, cells, references);
    count = {};

    queue.impl().begin_stage("sort");
    stable_sort_pairs(queue, cells, references, pair_count, key_bits_of(header));

    queue.impl().begin_stage("cell tables");
    GridTables tables;
    tables.offsets = queue.make_buffer<std::int32_t>(header.cell_count, "offsets");
    tables.counts = queue.make_buffer<std::uint32_t>(header.cell_count, "counts");
    if (method == CellTables::BinarySearch) {
        launch_items(queue, Kernel::grid_cells_search, header.cell_count, pair_count, cells, tables.offsets,
                     tables.counts);
    } else {
        launch_items(queue, Kernel::grid_cells_clear, header.cell_count, tables.offsets, tables.counts);
        launch_items(queue, Kernel::grid_cells_mark, pair_count, cells, tables.offsets, tables.counts);
        launch_items(queue, Kernel::grid_cells_close, header.cell_count, tables.offsets, tables.counts);
    }
    tables.references = std::move(references);
    return tables;
}

}  // namespace setka
