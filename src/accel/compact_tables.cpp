// SPDX-License-Identifier: MIT
#include "accel/compact_tables.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <string>

#include "algo/scan.hpp"
#include "algo/shape.hpp"
#include "core/launch.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

using HeaderWords = std::array<std::uint32_t, SK_REPORT - SK_REPORT_HEADER>;
static_assert(sizeof(HeaderWords) == sizeof(::SetkaGridHeader));

std::uint32_t in_fours(std::uint32_t n) noexcept { return (n + 3) / 4; }

std::uint64_t cells_of(const ::SetkaGridHeader& header) noexcept {
    return std::uint64_t(header.dims[0]) * header.dims[1] * header.dims[2];
}

void check_cells(const char* name, std::size_t size, const ::SetkaGridHeader& header) {
    const std::uint64_t cells = cells_of(header);
    if (size != cells)
        throw Error(ErrorCategory::InvalidArgument, std::string(name) + " has " + std::to_string(size) +
                                                        " elements; the header's dims ask for " +
                                                        std::to_string(cells));
}

/// Lists between the two orders; `places` are those in the flat one.
void move_lists(Queue& queue, const CompactTables& tables, const Buffer<std::uint32_t>& places,
                std::uint32_t to_flat, const Buffer<std::uint32_t>& from, const Buffer<std::uint32_t>& to) {
    const auto cells = static_cast<std::uint32_t>(places.size());
    const auto references = static_cast<std::uint32_t>(from.size());
    launch_items(queue, Kernel::lists_move, cells, references, to_flat, tables.cells, places, from, to);
    if (tables.longest_list > SK_LONG_LIST)
        launch_items(queue, Kernel::lists_move_long, references, to_flat, cells, tables.cells, places, from,
                     to);
}

}  // namespace

std::uint32_t block_count(const ::SetkaGridHeader& header) noexcept {
    return in_fours(header.dims[0]) * in_fours(header.dims[1]) * in_fours(header.dims[2]);
}

std::uint32_t mark_count(const std::uint32_t (&dims)[3]) noexcept {
    return (in_fours(dims[0]) + 15) / 16 * in_fours(dims[1]) * in_fours(dims[2]);
}

std::uint64_t counter_count(const std::uint32_t (&dims)[3]) noexcept {
    return std::uint64_t(in_fours(dims[0])) * in_fours(dims[1]) * in_fours(dims[2]) * SK_BLOCK_CELLS + mark_count(dims);
}

Buffer<std::uint32_t> make_report(Queue& queue) {
    auto report = queue.make_buffer<std::uint32_t>(SK_REPORT, "report of the build");
    queue.impl().fill(*report.memory(), 0, report.size_bytes());
    return report;
}

Buffer<std::uint32_t> make_working_memory(Queue& queue, std::uint64_t words, std::uint64_t zeros) {
    auto working = queue.make_buffer<std::uint32_t>(words, "working memory of the build");
    queue.impl().fill(*working.memory(), 0, zeros * sizeof(std::uint32_t));
    return working;
}

void report_header(Queue& queue, const Buffer<std::uint32_t>& report, const ::SetkaGridHeader& header) {
    const auto words = std::bit_cast<HeaderWords>(header);
    queue.impl().fill(*report.memory(), 0, SK_TOTALS * sizeof(std::uint32_t));
    queue.upload(std::span<const std::uint32_t>(words), report, SK_REPORT_HEADER);
}

Report read_report(Queue& queue, const Buffer<std::uint32_t>& report) {
    Report words;
    queue.download(report, std::span<std::uint32_t>(words));
    return words;
}

BlockTotals totals_of(const Report& report) noexcept {
    return {report[SK_TOTAL_CELLS],
            report[SK_TOTAL_PAIRS_LOW] | std::uint64_t(report[SK_TOTAL_PAIRS_HIGH]) << 32,
            report[SK_TOTAL_LONGEST],
            report[SK_TOTAL_ROWS],
            report[SK_TOTAL_LONG],
            report[SK_TOTAL_FOUND],
            report[SK_TOTAL_PIECES],
            report[SK_TOTAL_BINNED_LOW] | std::uint64_t(report[SK_TOTAL_BINNED_HIGH]) << 32};
}

bool has_header(const Report& report, const ::SetkaGridHeader& header) noexcept {
    return std::ranges::equal(std::span(report).subspan<SK_REPORT_HEADER>(), std::bit_cast<HeaderWords>(header));
}

std::uint64_t block_sums_bytes(const Device& device, std::uint32_t blocks) {
    return 2 * (primitive_layout(device, blocks).groups + std::uint64_t(1)) * sizeof(std::uint64_t);
}

Buffer<std::uint64_t> enqueue_block_sums(Queue& queue, const Buffer<std::uint32_t>& blocks,
                                         const Buffer<std::uint32_t>& report) {
    const auto n = static_cast<std::uint32_t>(blocks.size() / block_words);
    const PrimitiveLayout layout = primitive_layout(queue.device(), n);
    auto sums = queue.make_buffer<std::uint64_t>(2 * (layout.groups + std::size_t(1)), "sums of blocks");
    const std::uint32_t spine_elements = (layout.groups + layout.group_size - 1) / layout.group_size;
    launch_groups(queue, Kernel::blocks_reduce, layout.groups, layout.group_size, n, layout.elements,
                  layout.groups, blocks, sums);
    launch_groups(queue, Kernel::blocks_spine, 1, layout.group_size, layout.groups, spine_elements, sums,
                  report);
    return sums;
}

void enqueue_block_starts(Queue& queue, const Buffer<std::uint64_t>& sums,
                          const Buffer<std::uint32_t>& blocks) {
    const auto n = static_cast<std::uint32_t>(blocks.size() / block_words);
    const PrimitiveLayout layout = primitive_layout(queue.device(), n);
    launch_groups(queue, Kernel::blocks_apply, layout.groups, layout.group_size, n, layout.elements,
                  layout.groups, sums, blocks);
}

CompactTables import_tables(Queue& queue, const ::SetkaGridHeader& header, const GridTables& flat) {
    check_cells("offsets", flat.offsets.size(), header);
    check_cells("counts", flat.counts.size(), header);
    CompactTables tables;
    const std::uint32_t n = block_count(header);
    tables.blocks = queue.make_buffer<std::uint32_t>(n * block_words, "blocks");
    const auto marks = queue.make_buffer<std::uint32_t>(mark_count(header.dims), "marks of blocks");
    queue.impl().fill(*marks.memory(), 0, marks.size_bytes());
    BlockTotals totals;
    {
        const auto report = make_report(queue);
        launch_items(queue, Kernel::import_blocks, n, header, flat.counts, marks, tables.blocks, report);
        const auto sums = enqueue_block_sums(queue, tables.blocks, report);
        totals = totals_of(read_report(queue, report));
        if (totals.pairs != flat.references.size())
            throw Error(ErrorCategory::InvalidArgument,
                        "counts add up to " + std::to_string(totals.pairs) + "; references has " +
                            std::to_string(flat.references.size()) + " elements");
        enqueue_block_starts(queue, sums, tables.blocks);
    }
    tables.longest_list = totals.longest_list;
    tables.cells = queue.make_buffer<std::uint32_t>(totals.cells * cell_words, "cells");
    tables.references = queue.make_buffer<std::uint32_t>(flat.references.size(), "references of blocks");
    const auto places = queue.make_buffer<std::uint32_t>(totals.cells, "places of lists");
    launch_items(queue, Kernel::import_cells, n, header, flat.offsets, flat.counts, marks, tables.blocks,
                 tables.cells, places);
    move_lists(queue, tables, places, 0, flat.references, tables.references);
    return tables;
}

std::uint64_t import_bytes(const Device& device, const ::SetkaGridHeader& header, std::uint32_t cells) {
    constexpr std::uint64_t word = sizeof(std::uint32_t);
    const std::uint32_t n = block_count(header);
    return (n * block_words + mark_count(header.dims)) * word +
           std::max(report_bytes + block_sums_bytes(device, n),
                    (cells * (cell_words + std::uint64_t(1)) + header.reference_count) * word);
}

GridTables export_tables(Queue& queue, const ::SetkaGridHeader& header, const CompactTables& tables) {
    GridTables flat;
    const std::uint32_t n = block_count(header);
    const auto cell_count = static_cast<std::uint32_t>(cells_of(header));
    flat.counts = queue.make_buffer<std::uint32_t>(cell_count, "counts");
    launch_items(queue, Kernel::export_counts, n, header, tables.blocks, tables.cells, flat.counts);
    flat.offsets = queue.make_buffer<std::int32_t>(cell_count, "offsets");
    const auto places = queue.make_buffer<std::uint32_t>(tables.cells.size() / cell_words, "places of lists");
    {
        const auto starts = queue.make_buffer<std::uint32_t>(std::size_t(cell_count) + 1, "starts of lists");
        (void)enqueue_exclusive_scan(queue, flat.counts, cell_count, starts);
        launch_items(queue, Kernel::export_offsets, n, header, tables.blocks, starts, flat.offsets, places);
    }
    flat.references = queue.make_buffer<std::uint32_t>(tables.references.size(), "flat references");
    move_lists(queue, tables, places, 1, tables.references, flat.references);
    return flat;
}

}  // namespace setka
