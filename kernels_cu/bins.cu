/* SPDX-License-Identifier: MIT */
/**
 * Entries that make the lists of cells through bins; the bodies are in src/device/grid/bins.h. The grid is that of the report until the
 * host has checked it. Those with `first` do elements first to n - 1.
 */
#include "platform.h"

#include "device/grid/bins.h"

/* A work-item for every step-th run of `length` triangles, with reaches of its own: the run's pairs, if there is room for those of all. */
SK_KERNEL void bins_fill(sk_u32 n, sk_u32 first, sk_u32 step, sk_u32 length, sk_u32 bins, sk_u32 capacity, sk_u32 most_units,
                         SK_GLOBAL const float* triangles, SK_GLOBAL sk_reach* reaches, SK_GLOBAL sk_u32* bounds,
                         SK_GLOBAL sk_u32* pairs, SK_GLOBAL sk_u32* report) {
    const sk_u32 item = sk_global_id();
    if (item < step)
        for (sk_u32 r = first + item; r < n; r += step)
            sk_fill_run(r, length, bins, capacity, most_units, sk_reported_grid(report), triangles, reaches + (size_t)item * length, bounds,
                        pairs, report);
}

/* A work-item for every step-th bin, with counters of its own: the records of the bin's blocks. */
SK_KERNEL void bins_tally(sk_u32 n, sk_u32 first, sk_u32 step, sk_u32 length, sk_u32 runs, sk_u32 bins, sk_u32 capacity, sk_u32 most_units,
                          sk_u32 blocks, SK_GLOBAL const sk_u32* bounds, SK_GLOBAL const sk_u32* pairs, SK_GLOBAL sk_u32* counters,
                          SK_GLOBAL sk_block* counted, SK_GLOBAL sk_u64* filled, SK_GLOBAL sk_u32* report) {
    const sk_u32 item = sk_global_id();
    if (item < step)
        sk_tally_bins(first + item, n, step, capacity, most_units, blocks, sk_reported_grid(report),
                      sk_make_binned(bounds, pairs, length, runs, bins), counters + (size_t)item * SK_BIN_CELLS, counted, filled, report);
}

/* The same for the lists: records of blocks and cells, and references. */
SK_KERNEL void bins_place(sk_u32 n, sk_u32 first, sk_u32 step, sk_u32 length, sk_u32 runs, sk_u32 bins, SetkaGridHeader grid,
                          SK_GLOBAL const sk_u32* bounds, SK_GLOBAL const sk_u32* pairs, SK_GLOBAL sk_u32* counters,
                          SK_GLOBAL const sk_block* counted, SK_GLOBAL const sk_u64* filled, SK_GLOBAL sk_block* blocks,
                          SK_GLOBAL sk_cell_list* lists, SK_GLOBAL sk_u32* references) {
    const sk_u32 item = sk_global_id();
    if (item < step)
        for (sk_u32 b = first + item; b < n; b += step)
            sk_place_bin(b, grid, sk_make_binned(bounds, pairs, length, runs, bins), counters + (size_t)item * SK_BIN_CELLS, counted, filled,
                         blocks, lists, references);
}
