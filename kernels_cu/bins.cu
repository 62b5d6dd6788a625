/* SPDX-License-Identifier: MIT */
/**
 * Entries that make the lists of cells through bins; the bodies are in src/device/grid/bins.h. The grid is that of the report until the
 * host has checked it. Those with `first` do elements first to n - 1.
 */
#include "platform.h"

#include "device/grid/bins.h"

/* A work-item a run of `length` triangles: what they reach into, and the pairs of each bin. `counts` has room for so many bins a run. */
SK_KERNEL void bins_count(sk_u32 n, sk_u32 first, sk_u32 length, sk_u32 bins, sk_u32 most_units,
                          SK_GLOBAL const float* triangles, SK_GLOBAL sk_reach* reaches, SK_GLOBAL sk_u32* counts,
                          SK_GLOBAL sk_u32* report) {
    const sk_u32 r = first + sk_global_id();
    if (r < n)
        sk_count_run(r, length, bins, sk_reported_grid(report), triangles, reaches, counts, most_units, report);
}

/* A work-item a part of the bins, for both. */
SK_KERNEL void bins_sum(sk_u32 n, sk_u32 bins, sk_u32 runs, SK_GLOBAL const sk_u32* counts, SK_GLOBAL sk_u64* sums) {
    const sk_u32 part = sk_global_id();
    if (part < n) sk_sum_bins(part, bins, runs, counts, sums);
}

SK_KERNEL void bins_start(sk_u32 n, sk_u32 bins, sk_u32 runs, sk_u32 most_units, SK_GLOBAL const sk_u64* sums,
                          SK_GLOBAL sk_u32* counts, SK_GLOBAL sk_u32* starts, SK_GLOBAL sk_u32* report) {
    const sk_u32 part = sk_global_id();
    if (part < n) sk_start_bins(part, bins, runs, most_units, sums, counts, starts, report);
}

/* A work-item a run of triangles: its pairs go to the bins, if there is room for all. */
SK_KERNEL void bins_fill(sk_u32 n, sk_u32 first, sk_u32 length, sk_u32 bins, sk_u32 capacity,
                         SK_GLOBAL const float* triangles, SK_GLOBAL const sk_reach* reaches, SK_GLOBAL sk_u32* next,
                         SK_GLOBAL sk_u32* pairs, SK_GLOBAL sk_u32* report) {
    const sk_u32 r = first + sk_global_id();
    if (r < n && sk_is_binned(report, capacity))
        sk_fill_run(r, length, bins, sk_reported_grid(report), triangles, reaches, next, pairs, report);
}

/* A work-item for every step-th bin, with counters of its own: the records of the bin's blocks. */
SK_KERNEL void bins_tally(sk_u32 n, sk_u32 first, sk_u32 step, sk_u32 capacity, sk_u32 blocks,
                          SK_GLOBAL const sk_u32* starts, SK_GLOBAL const sk_u32* pairs, SK_GLOBAL sk_u32* counters,
                          SK_GLOBAL sk_block* counted, SK_GLOBAL sk_u64* filled, SK_GLOBAL sk_u32* report) {
    const sk_u32 item = sk_global_id();
    if (item < step)
        sk_tally_bins(first + item, n, step, capacity, blocks, sk_reported_grid(report), starts, pairs,
                      counters + (size_t)item * SK_BIN_CELLS, counted, filled, report);
}

/* The same for the lists: records of blocks and cells, and references. */
SK_KERNEL void bins_place(sk_u32 n, sk_u32 first, sk_u32 step, sk_u32 length, sk_u32 runs, sk_u32 bins, SetkaGridHeader grid,
                          SK_GLOBAL const sk_u32* starts, SK_GLOBAL const sk_u32* ends, SK_GLOBAL const sk_u32* pairs,
                          SK_GLOBAL sk_u32* counters, SK_GLOBAL const sk_block* counted, SK_GLOBAL const sk_u64* filled,
                          SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_cell_list* lists, SK_GLOBAL sk_u32* references) {
    const sk_u32 item = sk_global_id();
    if (item < step)
        for (sk_u32 b = first + item; b < n; b += step)
            sk_place_bin(b, starts[b], starts[b + 1u], length, runs, bins, ends, grid, pairs, counters + (size_t)item * SK_BIN_CELLS,
                         counted, filled, blocks, lists, references);
}
