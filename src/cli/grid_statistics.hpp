// SPDX-License-Identifier: MIT
/// What does a grid look like? The figures that one tunes a density by.
#pragma once

#include <cstdint>

#include "setka/grid.hpp"

namespace setka::cli {

struct GridStatistics {
    std::uint64_t empty_cells = 0;
    std::uint32_t longest_list = 0;
};

/// Downloads the counts and looks.
[[nodiscard]] GridStatistics grid_statistics(Queue& queue, const Grid& grid);

/// Part over whole, and 0 of nothing.
[[nodiscard]] inline double share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace setka::cli
