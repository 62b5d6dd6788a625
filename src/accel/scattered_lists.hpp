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
    std::uint32_t groups = 0;    ///< in which blocks are counted and laid out, or 0: then a scan in launches of its own does that
    std::uint64_t counters = 0;  ///< words, with the blocks' marks; a multiple of four
};

/// What counting leaves for placing.
struct ScatteredCount {
    std::uint32_t cells = 0;  ///< that are not empty
    std::uint32_t rows = 0;   ///< of large triangles
    std::uint32_t longest_list = 0;
    std::uint32_t pieces = 0;  ///< of long lists
    CountRoom room;
    /// Report, counters, rows of large triangles and, where there are groups, counted blocks and the groups' sums.
    Buffer<std::uint32_t> working;
    Buffer<std::uint32_t> reaches;  ///< 4 words a triangle: on their own, so that one allocation need not hold them too
    Buffer<std::uint32_t> blocks;   ///< counted ones where there are no groups; a grid's own are made of them
    Buffer<std::uint64_t> sums;     ///< of their scan

    void learn(const BlockTotals& totals) noexcept;
};

/// Room for as many blocks as scenes of so many triangles usually need, with working memory in which the report is 0. There is none if that would
/// not fit, if the device cannot tell the resolution, or if each launch is waited for anyway: then nothing is counted before the bounds are known.
[[nodiscard]] ScatteredCount make_room(Queue& queue, std::uint32_t triangles, const GridOptions& options,
                                       const GridLimits& limits);

/// The report in the working memory; empty if there was no room.
[[nodiscard]] Buffer<std::uint32_t> report_in(const ScatteredCount& count);

/// Enqueues the resolution and the count on the device, in the room that there is. The transform has written its report there.
void start_count(Queue& queue, const WorldGeometry& geometry, const GridOptions& options, ScatteredCount& count);

/// Finds out how many pairs there are, which the header learns. Waits, unless what was started has counted in this very grid, as
/// `words` of the report say. Nothing if this is no way to the grid: if large triangles have too many rows to be listed, or if the working memory
/// would not fit one allocation. `held_bytes` becomes the most bytes that counting held, world triangles not included.
[[nodiscard]] std::optional<ScatteredCount> finish_count(Queue& queue, const WorldGeometry& geometry,
                                                         ::SetkaGridHeader& header, const GridLimits& limits,
                                                         ScatteredCount started, const Report& words,
                                                         std::uint64_t& held_bytes);

/// The bytes that start_count() holds, or the report if there was no room; world triangles not included.
[[nodiscard]] std::uint64_t started_bytes(const Device& device, std::uint32_t triangles, const ScatteredCount& started);

/// The bytes that build_scattered() holds, tables included, world triangles not.
[[nodiscard]] std::uint64_t scattered_bytes(const Device& device, const ::SetkaGridHeader& header,
                                            const ScatteredCount& count);

[[nodiscard]] CompactTables build_scattered(Queue& queue, const WorldGeometry& geometry,
                                            const ::SetkaGridHeader& header, ScatteredCount count);

}  // namespace setka
