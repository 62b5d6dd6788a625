// SPDX-License-Identifier: MIT
/// How do a grid's tables come about where few work-items run at a time? Runs of triangles leave their pairs in order of bins of cells, and each
/// bin makes its own lists (device/grid/bins.h).
#pragma once

#include <optional>

#include "accel/compact_tables.hpp"
#include "accel/grid_limits.hpp"
#include "accel/world_geometry.hpp"

namespace setka {

/// What is provided for before anything is counted, and how it is divided.
struct BinRoom {
    std::uint32_t blocks = 0;
    std::uint32_t bins = 0;
    std::uint32_t pairs = 0;
    std::uint32_t run = 0;        ///< triangles in each run
    std::uint32_t runs = 0;
    std::uint32_t run_items = 0;  ///< work-items that share the runs
    std::uint32_t bin_items = 0;  ///< the same for bins
    std::uint32_t together = 0;   ///< bins that one of them takes at a time
    std::uint32_t kept = 0;       ///< blocks whose cells' counts are kept
};

/// What counting leaves for placing.
struct BinnedCount {
    std::uint32_t cells = 0;  ///< that are not empty
    std::uint32_t longest_list = 0;
    std::uint32_t taken = 0;  ///< by work-items of all launches so far, of what they share
    BinRoom room;
    Buffer<std::uint32_t> report;
    Buffer<std::uint32_t> reaches;   ///< of a run, for each work-item: 4 words a triangle
    Buffer<std::uint32_t> bounds;    ///< of each bin's pairs in each run
    Buffer<std::uint32_t> pairs;
    Buffer<std::uint32_t> counters;  ///< of a bin, for each work-item
    Buffer<std::uint64_t> filled;    ///< a bit for each block of a bin
    Buffer<std::uint32_t> kept;      ///< counts of cells, for placing; none where there is no space beside the tables
    Buffer<std::uint32_t> starts;    ///< where those of a bin are kept
    Buffer<std::uint32_t> blocks;    ///< counted ones; a grid's own are made of them
    Buffer<std::uint64_t> block_sums;
};

/// Whether lists come about this way where the options leave it to the device: where a work-item has vectors, and is alone.
[[nodiscard]] bool prefers_bins(const Device& device);

/// Enqueues the resolution and the count on the device, with room for what scenes usually need. Has no room, and counts nothing, if that
/// would not fit, if the device cannot tell the resolution, or if each launch is waited for anyway.
[[nodiscard]] BinnedCount start_bins(Queue& queue, const StartedTransform& transform, const GridOptions& options,
                                     const GridLimits& limits);

/// Finds out how many pairs there are, which the header learns. Waits, unless what was started has counted in this very grid, as `words`
/// of the report say. Nothing if counting or the tables do not fit the
/// budget, or if large triangles are most of the work. `held_bytes` becomes the most bytes that
/// counting held, world triangles not included.
[[nodiscard]] std::optional<BinnedCount> finish_bins(Queue& queue, const WorldGeometry& geometry,
                                                     ::SetkaGridHeader& header, const GridOptions& options,
                                                     const GridLimits& limits, BinnedCount started,
                                                     const Report& words, std::uint64_t& held_bytes);

/// The bytes that start_bins() holds, the report included, world triangles not.
[[nodiscard]] std::uint64_t started_bytes(const Device& device, const BinnedCount& started);

/// The bytes that build_binned() holds, tables included, world triangles not.
[[nodiscard]] std::uint64_t binned_bytes(const Device& device, const ::SetkaGridHeader& header,
                                         const BinnedCount& count);

[[nodiscard]] CompactTables build_binned(Queue& queue, const ::SetkaGridHeader& header, BinnedCount count);

}  // namespace setka
