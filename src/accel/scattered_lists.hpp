// SPDX-License-Identifier: MIT
/// How do a grid's tables come about without sorting? Triangles are counted in their cells, the lists are laid out, and each
/// triangle takes places in those of its cells (device/grid/scatter.h).
#pragma once

#include <optional>

#include "accel/grid_limits.hpp"
#include "accel/world_geometry.hpp"

namespace setka {

/// What is provided for before anything is counted.
struct CountRoom {
    std::uint32_t rows = 0;  ///< of large triangles
    std::uint32_t blocks = 0;
    std::uint64_t counters = 0;  ///< words, with the blocks' marks
};

/// What counting leaves for placing.
struct ScatteredCount {
    std::uint32_t cells = 0;  ///< that are not empty
    std::uint32_t rows = 0;   ///< of large triangles
    std::uint32_t longest_list = 0;
    std::uint32_t pieces = 0;  ///< of long lists
    CountRoom room;
    Buffer<std::uint32_t> report;
    Buffer<std::uint32_t> counters;  ///< 64 a block
    Buffer<std::uint32_t> reaches;   ///< 4 words a triangle
    Buffer<std::uint32_t> row_list;  ///< 2 words a row
    Buffer<std::uint32_t> blocks;    ///< counted ones; a grid's own are made of them
    Buffer<std::uint64_t> sums;

    void learn(const BlockTotals& totals) noexcept;
};

/// Enqueues the resolution and the count on the device, with room for as many blocks as scenes usually need. Has no room, and counts
/// nothing, if that would not fit, if the device cannot tell the resolution, or if each launch is waited for anyway.
[[nodiscard]] ScatteredCount start_count(Queue& queue, const StartedTransform& transform, const GridOptions& options,
                                         const GridLimits& limits);

/// Finds out how many pairs there are, which the header learns. Waits, unless what was started has counted in this very grid, as
/// `words` of the report say. Nothing if this is no way to the grid: if large triangles have too many rows to be listed. `held_bytes` becomes
/// the most bytes that counting held, world triangles not included.
[[nodiscard]] std::optional<ScatteredCount> finish_count(Queue& queue, const WorldGeometry& geometry,
                                                         ::SetkaGridHeader& header, const GridLimits& limits,
                                                         ScatteredCount started, const Report& words,
                                                         std::uint64_t& held_bytes);

/// The bytes that start_count() holds, the report included, world triangles not.
[[nodiscard]] std::uint64_t started_bytes(const Device& device, std::uint32_t triangles, const ScatteredCount& started);

/// The bytes that build_scattered() holds, tables included, world triangles not.
[[nodiscard]] std::uint64_t scattered_bytes(const Device& device, const ::SetkaGridHeader& header,
                                            const ScatteredCount& count);

[[nodiscard]] CompactTables build_scattered(Queue& queue, const WorldGeometry& geometry,
                                            const ::SetkaGridHeader& header, ScatteredCount count);

}  // namespace setka
