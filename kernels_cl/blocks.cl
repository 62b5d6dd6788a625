/* SPDX-License-Identifier: MIT */
/**
 * Entries that make the tables of blocks and cells, and the paper's tables from them; the bodies are in
 * src/device/grid/scatter.h, block_scan.h and exchange.h. One work-item a block unless the entry says otherwise.
 */
#include "platform.h"

#include "device/grid/block_scan.h"
#include "device/grid/exchange.h"
#include "device/grid/scatter.h"

SK_KERNEL void blocks_reduce(sk_u32 n, sk_u32 elements, sk_u32 groups, SK_GLOBAL const sk_block* blocks,
                             SK_GLOBAL sk_u64* sums) {
    SK_LOCAL_STORAGE sk_u64 scratch[2 * SK_MAX_GROUP];
    SK_LOCAL_STORAGE sk_u64 pair_scratch[2 * SK_MAX_GROUP];
    sk_blocks_reduce(scratch, pair_scratch, n, elements, groups, blocks, sums);
}

SK_KERNEL void blocks_spine(sk_u32 n, sk_u32 elements, SK_GLOBAL sk_u64* sums, SK_GLOBAL sk_u32* totals) {
    SK_LOCAL_STORAGE sk_u64 scratch[2 * SK_MAX_GROUP];
    SK_LOCAL_STORAGE sk_u64 pair_scratch[2 * SK_MAX_GROUP];
    sk_blocks_spine(scratch, pair_scratch, n, elements, sums, totals);
}

SK_KERNEL void blocks_apply(sk_u32 n, sk_u32 elements, sk_u32 groups, SK_GLOBAL const sk_u64* sums,
                            SK_GLOBAL sk_block* blocks) {
    SK_LOCAL_STORAGE sk_u64 scratch[2 * SK_MAX_GROUP];
    SK_LOCAL_STORAGE sk_u64 pair_scratch[2 * SK_MAX_GROUP];
    sk_blocks_apply(scratch, pair_scratch, n, elements, groups, sums, blocks);
}

SK_KERNEL void blocks_count(sk_u32 n, SK_GLOBAL const sk_u32* counters, SK_GLOBAL sk_block* blocks,
                            SK_GLOBAL sk_u32* totals) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_count_block(b, counters, blocks, totals);
}

SK_KERNEL void blocks_group(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const sk_block* blocks,
                            SK_GLOBAL sk_u32* groups) {
    const sk_u32 group = sk_global_id();
    if (group < n) sk_group_blocks(group, grid, blocks, groups);
}

SK_KERNEL void import_blocks(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const sk_u32* counts,
                             SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_u32* totals) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_import_block(b, grid, counts, blocks, totals);
}

SK_KERNEL void import_cells(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const sk_i32* offsets,
                            SK_GLOBAL const sk_u32* counts, SK_GLOBAL sk_block* blocks,
                            SK_GLOBAL sk_cell_list* cells, SK_GLOBAL sk_u32* places) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_import_cells(b, grid, offsets, counts, blocks, cells, places);
}

SK_KERNEL void export_counts(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const sk_block* blocks,
                             SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL sk_u32* counts) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_export_counts(b, grid, blocks, cells, counts);
}

SK_KERNEL void export_offsets(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const sk_block* blocks,
                              SK_GLOBAL const sk_u32* starts, SK_GLOBAL sk_i32* offsets, SK_GLOBAL sk_u32* places) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_export_offsets(b, grid, blocks, starts, offsets, places);
}

/* A work-item a list. */
SK_KERNEL void lists_move(sk_u32 n, sk_u32 size, sk_u32 to_flat, SK_GLOBAL const sk_cell_list* cells,
                          SK_GLOBAL const sk_u32* places, SK_GLOBAL const sk_u32* from, SK_GLOBAL sk_u32* to) {
    const sk_u32 r = sk_global_id();
    if (r < n) sk_move_list(r, size, to_flat, cells, places, from, to);
}

/* A work-item a reference. */
SK_KERNEL void lists_move_long(sk_u32 n, sk_u32 to_flat, sk_u32 cell_count, SK_GLOBAL const sk_cell_list* cells,
                               SK_GLOBAL const sk_u32* places, SK_GLOBAL const sk_u32* from, SK_GLOBAL sk_u32* to) {
    const sk_u32 p = sk_global_id();
    if (p < n) sk_move_long(p, n, to_flat, cell_count, cells, places, from, to);
}
