// SPDX-License-Identifier: MIT
/// Does a build fit the device? The questions that every way of building asks, and what is said where it does not.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "setka/grid.hpp"

namespace setka {

/// Rows, pairs and cells are numbered with 31 bits: offsets are signed, -1 stands for an empty cell.
inline constexpr std::uint64_t most_entries = std::numeric_limits<std::int32_t>::max();

class GridLimits {
  public:
    /// What the device holds now was held before the build, but for `own_bytes` that are the build's; what comes from here on is the build's.
    GridLimits(const Device& device, const GridOptions& options, std::uint64_t own_bytes = 0);

    /// Refuses a grid whose cells alone cannot be held, before any triangle is counted.
    void check_cells(const GridResolution& resolution) const;
    [[nodiscard]] bool fits(std::uint64_t bytes) const;
    /// Throws if `bytes` do not fit the budget beside what was held before; `purpose` says what they are for.
    void check_budget(std::uint64_t bytes, const std::string& purpose) const;
    /// Throws if a table of `words` would be larger than any allocation of the device.
    void check_allocation(std::uint64_t words, const std::string& name) const;
    [[nodiscard]] bool fits_an_allocation(std::uint64_t words) const;
    /// Throws: there are more of something than tables can number.
    [[noreturn]] void refuse_count(const std::string& count) const;

  private:
    Device device_;
    GridOptions options_;
    std::uint64_t held_before_bytes_;
};

/// The most rows of cells of one launch where a stop can be requested: a fraction of a second of work, even if each is as wide
/// as the grid, and enough to fill a GPU.
[[nodiscard]] std::uint64_t rows_a_launch(const Device& device, const std::uint32_t (&dims)[3]);

/// The most triangles of one launch where a stop can be requested.
[[nodiscard]] std::uint64_t triangles_a_launch(const Device& device);

}  // namespace setka
