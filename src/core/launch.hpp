// SPDX-License-Identifier: MIT
/// How does an algorithm put a kernel on a queue? One item per element, or a stated shape.
#pragma once

#include <cstdint>

#include "backend/device.hpp"

namespace setka {

/// Launches one work-item for each of `items` elements, in groups of the device's size; none if there is no element. The
/// kernel's first argument is `items` (a u32), so that it can ignore the last group's surplus.
template <typename... Ts>
void launch_items(Queue& queue, Kernel kernel, std::uint32_t items, const Ts&... arguments) {
    if (items == 0) return;
    const std::uint32_t group_size = queue.device().options().work_group_size;
    const std::uint32_t groups = items / group_size + (items % group_size != 0);
    queue.impl().launch(kernel, groups, group_size, Arguments(items, arguments...));
}

/// The same for a kernel that takes a second number, the first element (`n, first, …`), and does elements first to n - 1.
template <typename... Ts>
void launch_range(Queue& queue, Kernel kernel, std::uint32_t items, const Ts&... arguments) {
    launch_items(queue, kernel, items, std::uint32_t(0), arguments...);
}

/// Launches `groups` groups of `group_size` work-items.
template <typename... Ts>
void launch_groups(Queue& queue, Kernel kernel, std::uint32_t groups, std::uint32_t group_size,
                   const Ts&... arguments) {
    queue.impl().launch(kernel, groups, group_size, Arguments(arguments...));
}

}  // namespace setka
