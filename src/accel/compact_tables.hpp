// SPDX-License-Identifier: MIT
/// What of a grid stays on the device, and how does it become the paper's tables? The host's side of
/// device/grid/blocks.h: sizes, the scan over blocks, and the exchange with flat tables.
#pragma once

#include <array>
#include <cstdint>

#include "device/grid/limits.h"
#include "setka/grid.hpp"

namespace setka {

/// Blocks of 4 x 4 x 4 cells.
[[nodiscard]] std::uint32_t block_count(const ::SetkaGridHeader& header) noexcept;
/// Words of a counter for each cell of all blocks, those outside the grid included, and of the blocks' marks behind them
/// (device/grid/blocks.h).
[[nodiscard]] std::uint64_t counter_count(const std::uint32_t (&dims)[3]) noexcept;
/// Of the marks alone.
[[nodiscard]] std::uint32_t mark_count(const std::uint32_t (&dims)[3]) noexcept;
/// Words of a block's and a cell's record.
inline constexpr std::uint64_t block_words = 4, cell_words = 2;

/// What the device tells of counted blocks.
struct BlockTotals {
    std::uint32_t cells = 0;         ///< that are not empty
    std::uint64_t pairs = 0;
    std::uint32_t longest_list = 0;  ///< 0 if none is longer than SK_LONG_LIST
    // Of large triangles, where these were counted; `rows` means nothing where there are bins (SK_TOTAL_TAKEN).
    std::uint32_t rows = 0;
    std::uint32_t long_rows = 0, found_long_rows = 0;
    std::uint32_t pieces = 0;        ///< of lists that one work-item does not sort alone
    std::uint64_t binned_pairs = 0;  ///< instead of pieces, where there are bins
};

/// Words of kernels to each other and the host, all 0: device/grid/limits.h.
[[nodiscard]] Buffer<std::uint32_t> make_report(Queue& queue);
inline constexpr std::uint64_t report_bytes = SK_REPORT * sizeof(std::uint32_t);
/// So many words of which the first are a report, and those behind it counters and marks (device/grid/blocks.h). The first `zeros` are 0.
[[nodiscard]] Buffer<std::uint32_t> make_working_memory(Queue& queue, std::uint64_t words, std::uint64_t zeros);
/// From here on kernels count in this grid, and totals are 0.
void report_header(Queue& queue, const Buffer<std::uint32_t>& report, const ::SetkaGridHeader& header);

using Report = std::array<std::uint32_t, SK_REPORT>;
/// Waits.
[[nodiscard]] Report read_report(Queue& queue, const Buffer<std::uint32_t>& report);
[[nodiscard]] BlockTotals totals_of(const Report& report) noexcept;
/// Whether the header in the report is this one, bit for bit.
[[nodiscard]] bool has_header(const Report& report, const ::SetkaGridHeader& header) noexcept;

/// Bytes of the sums of a scan over so many blocks.
[[nodiscard]] std::uint64_t block_sums_bytes(const Device& device, std::uint32_t blocks);
/// Enqueues the scan of the blocks' cells and pairs, up to the totals. Hands back the sums for what follows.
[[nodiscard]] Buffer<std::uint64_t> enqueue_block_sums(Queue& queue, const Buffer<std::uint32_t>& blocks,
                                                       const Buffer<std::uint32_t>& report);
/// The rest of the scan: each block learns where its cells and lists begin.
void enqueue_block_starts(Queue& queue, const Buffer<std::uint64_t>& sums,
                          const Buffer<std::uint32_t>& blocks);

/// Flat tables as compact ones; waits. Throws InvalidArgument if offsets or counts do not have one element for each cell, or
/// if the counts do not add up to the references.
[[nodiscard]] CompactTables import_tables(Queue& queue, const ::SetkaGridHeader& header,
                                          const GridTables& flat);
/// The most bytes that import_tables() holds beside the flat tables, the result included.
[[nodiscard]] std::uint64_t import_bytes(const Device& device, const ::SetkaGridHeader& header,
                                         std::uint32_t cells);

/// Compact tables as flat ones.
[[nodiscard]] GridTables export_tables(Queue& queue, const ::SetkaGridHeader& header,
                                       const CompactTables& tables);

}  // namespace setka
