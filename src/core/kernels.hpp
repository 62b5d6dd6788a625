// SPDX-License-Identifier: MIT
/// Which kernels are there? One list drives the enum, the names that each backend loads, and the timing table.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/trace/params.h"

// Each name is an entry point in kernels_cl/ and in kernels_cu/.
#define SETKA_KERNEL_LIST(X)                                                                               \
    X(probe_rounding) X(probe_layout) X(probe_barrier)                                                     \
    X(scan_reduce) X(scan_spine) X(scan_apply)                                                             \
    X(sort_count) X(sort_scatter)                                                                          \
    X(grid_transform) X(grid_resolve) X(grid_resolve_clear)                                                \
    X(grid_rows) X(grid_row_list) X(grid_count) X(grid_emit)                                               \
    X(grid_cells_clear) X(grid_cells_mark) X(grid_cells_close) X(grid_cells_search)                        \
    X(grid_mark)                                                                                           \
    X(blocks_reduce) X(blocks_spine) X(blocks_apply) X(blocks_count) X(blocks_lay_out)                     \
    X(blocks_tally) X(blocks_settle)                                                                       \
    X(scatter_count) X(scatter_count_rows) X(scatter_place) X(scatter_place_rows) X(lists_sort)            \
    X(lists_rank) X(lists_merge)                                                                           \
    X(bins_fill) X(bins_tally) X(bins_place)                                                               \
    X(import_blocks) X(import_cells) X(export_counts) X(export_offsets) X(lists_move) X(lists_move_long)   \
    X(trace_pack) X(trace_brute_closest) X(trace_brute_any)                                                \
    X(trace_grid_closest_dda) X(trace_grid_closest_free) X(trace_grid_any_dda) X(trace_grid_any_free)      \
    X(trace_grid_closest_picture) X(trace_grid_any_picture)                                                \
    X(trace_grid_cost_dda) X(trace_grid_cost_free)                                                         \
    X(trace_brute_count) X(trace_brute_all) X(trace_grid_count) X(trace_grid_all)                          \
    X(shade_camera_rays) X(shade_surface) X(shade_shadow_rays) X(shade_shadow_narrow) X(shade_light)       \
    X(shade_child_count) X(shade_child_emit) X(shade_gather) X(shade_normals) X(shade_ramp)                \
    X(shade_add_colours) X(shade_add_depths) X(shade_add_costs)                                            \
    X(shade_mean_colour) X(shade_mean_depth) X(shade_mean_cost) X(shade_encode)

namespace setka {

enum class Kernel {
#define SETKA_KERNEL_ENUM(name) name,
    SETKA_KERNEL_LIST(SETKA_KERNEL_ENUM)
#undef SETKA_KERNEL_ENUM
};

inline constexpr const char* kernel_names[] = {
#define SETKA_KERNEL_NAME(name) #name,
    SETKA_KERNEL_LIST(SETKA_KERNEL_NAME)
#undef SETKA_KERNEL_NAME
};

inline constexpr std::size_t kernel_count = sizeof(kernel_names) / sizeof(kernel_names[0]);

[[nodiscard]] constexpr const char* to_string(Kernel kernel) noexcept {
    return kernel_names[static_cast<std::size_t>(kernel)];
}

/// Kernels whose groups are teams (SK_TEAM_KERNEL in the dialect), not of the device's group size.
[[nodiscard]] constexpr bool is_team_kernel(Kernel kernel) noexcept {
    return kernel == Kernel::trace_grid_closest_dda || kernel == Kernel::trace_grid_any_dda ||
           kernel == Kernel::trace_grid_closest_picture || kernel == Kernel::trace_grid_any_picture ||
           kernel == Kernel::trace_grid_cost_dda;
}

/// Kernels that trace a list of rays: on CPUs many in a work-item, on GPUs in teams that share the list (device/grid/trace.h).
[[nodiscard]] constexpr bool traces_lists(Kernel kernel) noexcept {
    return kernel == Kernel::trace_grid_closest_dda || kernel == Kernel::trace_grid_any_dda;
}

/// How many elements one work-item of a kernel does on a device of this width (SK_WIDTH in the dialect). Its groups have as many work-items fewer.
[[nodiscard]] constexpr std::uint32_t elements_an_item(Kernel kernel, std::uint32_t width) noexcept {
    return traces_lists(kernel) && width > 1 ? width * SK_FLIGHTS : 1;
}

}  // namespace setka
