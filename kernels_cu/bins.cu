/* SPDX-License-Identifier: MIT */
/**
 * Entries that make the lists of cells through bins; the bodies are in src/device/grid/bins.h. The grid is that of the report until the
 * host has checked it. All have `items` work-items, each with memory of its own, that share the work up to element n: they take up to `most` elements each.
 */
#include "platform.h"

#include "device/grid/bins.h"

/* Runs of `length` triangles: the pairs of each, if there is room for those of all. */
SK_KERNEL void bins_fill(sk_u32 n, sk_u32 items, sk_u32 before, sk_u32 most, sk_u32 length, sk_u32 bins, sk_u32 capacity, sk_u32 most_units,
                         SK_GLOBAL const float* triangles, SK_GLOBAL sk_reach* reaches, SK_GLOBAL sk_u32* bounds,
                         SK_GLOBAL sk_u32* pairs, SK_GLOBAL sk_u32* report) {
    const sk_u32 item = sk_global_id();
    if (item < items)
        sk_fill_runs(n, before, most, length, bins, capacity, most_units, sk_reported_grid(report), triangles, reaches + (size_t)item * length,
                     bounds, pairs, report);
}

/* Groups of bins: the records of their blocks. */
SK_KERNEL void bins_tally(sk_u32 n, sk_u32 items, sk_u32 before, sk_u32 most, sk_u32 length, sk_u32 bins, sk_u32 capacity, sk_u32 most_units, sk_u32 runs,
                          sk_u32 together, sk_u32 blocks, SK_GLOBAL const sk_u32* bounds, SK_GLOBAL const sk_u32* pairs,
                          SK_GLOBAL sk_u32* counters, SK_GLOBAL sk_block* counted, SK_GLOBAL sk_u64* filled, SK_GLOBAL sk_u32* kept,
                          SK_GLOBAL sk_u32* kept_starts, sk_u32 kept_room, SK_GLOBAL sk_u32* report) {
    const sk_u32 item = sk_global_id();
    if (item < items)
        sk_tally_bins(n, before, most, together, capacity, most_units, blocks, sk_reported_grid(report),
                      sk_make_binned(bounds, pairs, length, runs, bins), counters + (size_t)item * SK_BIN_CELLS, counted, filled,
                      sk_make_kept(kept, kept_starts, kept_room, items), report);
}

/* Groups of bins: records of blocks and cells, and references. */
SK_KERNEL void bins_place(sk_u32 n, sk_u32 items, sk_u32 before, sk_u32 most, sk_u32 length, sk_u32 bins, sk_u32 runs, sk_u32 together, SetkaGridHeader grid,
                          SK_GLOBAL const sk_u32* bounds, SK_GLOBAL const sk_u32* pairs, SK_GLOBAL sk_u32* counters,
                          SK_GLOBAL const sk_block* counted, SK_GLOBAL const sk_u64* filled, SK_GLOBAL sk_u32* kept,
                          SK_GLOBAL sk_u32* kept_starts, SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_cell_list* lists,
                          SK_GLOBAL sk_u32* references, SK_GLOBAL sk_u32* report) {
    const sk_u32 item = sk_global_id();
    if (item < items)
        sk_place_bins(n, before, most, together, grid, sk_make_binned(bounds, pairs, length, runs, bins), counters + (size_t)item * SK_BIN_CELLS,
                      counted, filled, sk_make_kept(kept, kept_starts, 0u, items), blocks, lists, references, report);
}
