// SPDX-License-Identifier: MIT
/// How do a grid's tables come about without sorting? Triangles are counted in their cells, the lists are laid out, and each
/// triangle takes places in those of its cells (device/grid/scatter.h).
#pragma once

#include <optional>

#include "accel/grid_limits.hpp"

namespace setka {

/// What counting leaves for placing.
struct ScatteredCount {
    std::uint32_t cells = 0;  ///< that are not empty
    std::uint32_t rows = 0;   ///< of large triangles
    std::uint32_t row_capacity = 0;
    std::uint32_t longest_list = 0;
    std::uint32_t pieces = 0;  ///< of long lists
    Buffer<std::uint32_t> totals;
    Buffer<std::uint32_t> counters;   ///< 64 a block
    Buffer<std::uint32_t> reaches;    ///< 4 words a triangle
    Buffer<std::uint32_t> row_list;   ///< 2 words a row
    Buffer<std::uint32_t> blocks;
    Buffer<std::uint64_t> sums;
};

/// Counts pairs; the header learns their number. Waits. Nothing if this is no way to the grid: if large triangles have too many
/// rows to be listed. `held_bytes` becomes the most bytes that it held.
[[nodiscard]] std::optional<ScatteredCount> count_scattered(Queue& queue, const WorldGeometry& geometry,
                                                            ::SetkaGridHeader& header,
                                                            const GridLimits& limits,
                                                            std::uint64_t& held_bytes);

/// The most bytes that count_scattered() holds, if large triangles have up to so many rows, world triangles not included.
[[nodiscard]] std::uint64_t scattered_count_bytes(const Device& device, const ::SetkaGridHeader& header,
                                                  std::uint32_t row_capacity);
/// The bytes that build_scattered() holds, tables included, world triangles not.
[[nodiscard]] std::uint64_t scattered_bytes(const Device& device, const ::SetkaGridHeader& header,
                                            const ScatteredCount& count);

[[nodiscard]] CompactTables build_scattered(Queue& queue, const WorldGeometry& geometry,
                                            const ::SetkaGridHeader& header, ScatteredCount count);

}  // namespace setka
