// SPDX-License-Identifier: MIT
/// How do a grid's tables come about by sorting? Rows of cells are counted, pairs (triangle, cell) written and sorted by cell, as
/// in the paper. The way to any grid that fits: no list is too long for it.
#pragma once

#include "accel/grid_limits.hpp"

namespace setka {

/// What counting leaves for writing.
struct SortedCount {
    std::uint64_t rows = 0;
    std::uint32_t cells = 0;  ///< that are not empty
    Buffer<std::uint32_t> row_triangles, row_starts, row_offsets;
};

/// Counts rows and pairs; the header learns the number of pairs. Waits.
[[nodiscard]] SortedCount count_sorted(Queue& queue, const WorldGeometry& geometry, ::SetkaGridHeader& header,
                                       const GridLimits& limits);

/// The most bytes that count_sorted() and build_sorted() hold, world triangles not included.
[[nodiscard]] std::uint64_t sorted_bytes(Queue& queue, const ::SetkaGridHeader& header,
                                         const SortedCount& count);

[[nodiscard]] GridTables build_sorted(Queue& queue, const WorldGeometry& geometry,
                                      const ::SetkaGridHeader& header, SortedCount count, CellTables method);

}  // namespace setka
