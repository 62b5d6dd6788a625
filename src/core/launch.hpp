// SPDX-License-Identifier: MIT
/// How does an algorithm put a kernel on a queue? One item per element, or a stated shape.
#pragma once

#include <algorithm>
#include <cstdint>

#include "backend/device.hpp"

namespace setka {

/// Launches `groups` groups of `group_size` work-items.
template <typename... Ts>
void launch_groups(Queue& queue, Kernel kernel, std::uint32_t groups, std::uint32_t group_size,
                   const Ts&... arguments) {
    queue.impl().check_stop(to_string(kernel));
    queue.impl().launch(kernel, groups, group_size, Arguments(arguments...));
    queue.impl().wait_if_stoppable();
}

/// The size of the groups in which a kernel runs that has a work-item an element: a team, or what the device's options say.
[[nodiscard]] inline std::uint32_t group_size_of(const Queue& queue, Kernel kernel) {
    const std::uint32_t team = is_team_kernel(kernel) ? queue.device().impl()->team_size() : 1;
    return team > 1 ? team : queue.device().options().work_group_size;
}

/// Launches groups enough for one work-item for each of `items` elements.
template <typename... Ts>
void launch_enough(Queue& queue, Kernel kernel, std::uint32_t items, std::uint32_t group_size, const Ts&... arguments) {
    launch_groups(queue, kernel, items / group_size + (items % group_size != 0), group_size, arguments...);
}

/// Launches one work-item for each of `items` elements; none if there is no element. The kernel's first argument is `items` (a
/// u32), so that it can ignore the last group's surplus.
template <typename... Ts>
void launch_items(Queue& queue, Kernel kernel, std::uint32_t items, const Ts&... arguments) {
    if (items == 0) return;
    launch_enough(queue, kernel, items, group_size_of(queue, kernel), items, arguments...);
}

/// How the elements of a launch are shared out.
struct Shares {
    std::uint32_t an_item = 1;         ///< a work-item has so many
    std::uint32_t sharing_groups = 0;  ///< if not 0: up to so many groups share the elements; where these are few, about half of its work-items begin with one
};

/// The same for a kernel that takes a second number, the first element (`n, first, …`), and does elements first to n - 1. Where a stop can be
/// requested, at most `most` a launch. Groups shrink with what a work-item does, as PoCL hands a core up to 256 of them at once.
template <typename... Ts>
void launch_shares(Queue& queue, Kernel kernel, std::uint32_t items, Shares shares, std::uint64_t most, const Ts&... arguments) {
    const std::uint32_t group_size = std::max(1u, group_size_of(queue, kernel) / shares.an_item);
    const std::uint64_t step = queue.impl().stop_token().stop_possible() ? std::max<std::uint64_t>(most, 1) : items;
    const std::uint64_t least = std::uint64_t(group_size) * shares.an_item / (shares.sharing_groups != 0 ? 2 : 1);
    for (std::uint64_t first = 0; first < items; first += step) {
        const std::uint64_t end = std::min<std::uint64_t>(items, first + step);
        const auto groups = static_cast<std::uint32_t>((end - first + least - 1) / least);
        launch_groups(queue, kernel, shares.sharing_groups != 0 ? std::min(groups, shares.sharing_groups) : groups, group_size,
                      static_cast<std::uint32_t>(end), static_cast<std::uint32_t>(first), arguments...);
    }
}

/// The same with one element in each work-item.
template <typename... Ts>
void launch_range(Queue& queue, Kernel kernel, std::uint32_t items, std::uint64_t most, const Ts&... arguments) {
    launch_shares(queue, kernel, items, {}, most, arguments...);
}

}  // namespace setka
