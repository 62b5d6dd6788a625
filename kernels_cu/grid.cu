/* SPDX-License-Identifier: MIT */
/** Entries of the grid build, one a stage; the bodies are in src/device/grid/build.h. Those with `first` do elements first to n - 1. */
#include "platform.h"

#include "device/grid/build.h"

SK_KERNEL void grid_transform(sk_u32 n, sk_u32 elements, sk_u32 instance_count, SK_GLOBAL const float* positions,
                              SK_GLOBAL const sk_u32* indices, SK_GLOBAL const SetkaInstance* instances,
                              SK_GLOBAL const sk_u32* instance_starts, SK_GLOBAL float* triangles,
                              SK_GLOBAL sk_u32* report) {
    SK_LOCAL_STORAGE sk_u32 scratch[SK_BOUNDS_VALUES * SK_MAX_GROUP];
    sk_grid_transform(scratch, n, elements, instance_count, positions, indices, instances, instance_starts, triangles,
                      report);
}

/* One work-item. */
SK_KERNEL void grid_resolve(sk_u32 n, sk_u32 blocks, float density, sk_u32 max_cells, sk_u32 triangle_count,
                            sk_u32 instance_count, SK_GLOBAL sk_u32* report) {
    if (sk_global_id() < n)
        sk_grid_resolve(blocks, sk_make_cell_wish(density, max_cells, triangle_count, instance_count), report);
}

/* The same by the first work-item, while all n of them clear 4 n counters. */
SK_KERNEL void grid_resolve_clear(sk_u32 n, sk_u32 blocks, float density, sk_u32 max_cells, sk_u32 triangle_count,
                                  sk_u32 instance_count, SK_GLOBAL sk_u32* working) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_clear_counters(i, n, sk_counters_of(working));
    if (i == 0u)
        sk_grid_resolve(blocks, sk_make_cell_wish(density, max_cells, triangle_count, instance_count), working);
}

SK_KERNEL void grid_rows(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const float* triangles, SK_GLOBAL sk_u32* rows) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_grid_rows(i, grid, triangles, rows);
}

SK_KERNEL void grid_row_list(sk_u32 n, SK_GLOBAL const sk_u32* row_starts, SK_GLOBAL sk_u32* row_triangles) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_grid_row_list(i, row_starts, row_triangles);
}

SK_KERNEL void grid_count(sk_u32 n, sk_u32 first, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                          SK_GLOBAL const sk_u32* row_triangles, SK_GLOBAL const sk_u32* row_starts,
                          SK_GLOBAL sk_u32* counts, SK_GLOBAL sk_u32* long_rows) {
    const sk_u32 r = first + sk_global_id();
    if (r < n) sk_grid_count(r, grid, triangles, row_triangles, row_starts, counts, long_rows);
}

SK_KERNEL void grid_emit(sk_u32 n, sk_u32 first, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                         SK_GLOBAL const sk_u32* row_triangles, SK_GLOBAL const sk_u32* row_starts,
                         SK_GLOBAL const sk_u32* row_offsets, SK_GLOBAL sk_u32* cells, SK_GLOBAL sk_u32* references) {
    const sk_u32 r = first + sk_global_id();
    if (r < n) sk_grid_emit(r, grid, triangles, row_triangles, row_starts, row_offsets, cells, references);
}

SK_KERNEL void grid_cells_clear(sk_u32 n, SK_GLOBAL sk_i32* offsets, SK_GLOBAL sk_u32* counts) {
    const sk_u32 c = sk_global_id();
    if (c < n) sk_grid_cells_clear(c, offsets, counts);
}

SK_KERNEL void grid_cells_mark(sk_u32 n, SK_GLOBAL const sk_u32* cells, SK_GLOBAL sk_i32* offsets,
                               SK_GLOBAL sk_u32* counts) {
    const sk_u32 p = sk_global_id();
    if (p < n) sk_grid_cells_mark(p, n, cells, offsets, counts);
}

SK_KERNEL void grid_cells_close(sk_u32 n, SK_GLOBAL const sk_i32* offsets, SK_GLOBAL sk_u32* counts) {
    const sk_u32 c = sk_global_id();
    if (c < n) sk_grid_cells_close(c, offsets, counts);
}

SK_KERNEL void grid_cells_search(sk_u32 n, sk_u32 pair_count, SK_GLOBAL const sk_u32* cells,
                                 SK_GLOBAL sk_i32* offsets, SK_GLOBAL sk_u32* counts) {
    const sk_u32 c = sk_global_id();
    if (c < n) sk_grid_cells_search(c, pair_count, cells, offsets, counts);
}

SK_KERNEL void grid_mark(sk_u32 n, sk_u32 first, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                         SK_GLOBAL const sk_u32* row_triangles, SK_GLOBAL const sk_u32* row_starts,
                         SK_GLOBAL sk_u32* working) {
    const sk_u32 r = first + sk_global_id();
    if (r < n) sk_grid_mark(r, grid, triangles, row_triangles, row_starts, sk_counters_of(working));
}
