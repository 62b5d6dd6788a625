// SPDX-License-Identifier: MIT
/// What does a grid look like? See the header.
#include "cli/grid_statistics.hpp"

#include <algorithm>

namespace setka::cli {

GridStatistics grid_statistics(Queue& queue, const Grid& grid) {
    GridStatistics statistics;
    for (const std::uint32_t count : queue.download(grid.tables(queue).counts)) {
        statistics.empty_cells += count == 0;
        statistics.longest_list = std::max(statistics.longest_list, count);
    }
    return statistics;
}

}  // namespace setka::cli
