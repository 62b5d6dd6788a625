/* SPDX-License-Identifier: MIT */
/**
 * Entries that make the tables of blocks and cells, and the paper's tables from them; the bodies are in
 * src/device/grid/scatter.h, block_scan.h, block_groups.h and exchange.h. One work-item a block unless the entry says otherwise.
 */
#include "platform.h"

#include "device/grid/block_groups.h"
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

/* Counts in the grid that the report names; n may be more than it has. */
SK_KERNEL void blocks_count(sk_u32 n, sk_u32 alone, SK_GLOBAL sk_u32* working, SK_GLOBAL sk_block* blocks) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_count_block(b, alone, sk_reported_grid(working), working, blocks);
}

SK_KERNEL void blocks_lay_out(sk_u32 n, sk_u32 alone, SetkaGridHeader grid, SK_GLOBAL sk_u32* working,
                              SK_GLOBAL const sk_block* counted, SK_GLOBAL sk_block* blocks,
                              SK_GLOBAL sk_cell_list* cells, SK_GLOBAL sk_piece* pieces) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_lay_out_block(b, alone, grid, working, counted[b], blocks, cells, pieces);
}

/* Both at once with what lies between them, a work-item a block; n of the first may be more than the grid has. */
SK_KERNEL void blocks_tally(sk_u32 n, sk_u32 alone, sk_u32 blocks_at, sk_u32 sums_at, SK_GLOBAL sk_u32* working) {
    SK_LOCAL_STORAGE sk_u64 scratch[SK_MAX_GROUP];
    SK_LOCAL_STORAGE sk_u64 pair_scratch[SK_MAX_GROUP];
    sk_tally_blocks(scratch, pair_scratch, n, alone, blocks_at, sums_at, working);
}

SK_KERNEL void blocks_settle(sk_u32 n, sk_u32 alone, SetkaGridHeader grid, sk_u32 blocks_at, sk_u32 sums_at,
                             SK_GLOBAL sk_u32* working, SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_cell_list* cells,
                             SK_GLOBAL sk_piece* pieces) {
    SK_LOCAL_STORAGE sk_u64 scratch[2 * SK_MAX_GROUP];
    SK_LOCAL_STORAGE sk_u64 own_scratch[2 * SK_MAX_GROUP];
    sk_settle_blocks(scratch, own_scratch, n, alone, grid, blocks_at, sums_at, working, blocks, cells, pieces);
}

/* A work-item for each `run` triangles of the grid that the report names, elements first to n - 1. */
SK_KERNEL void scatter_count(sk_u32 n, sk_u32 first, sk_u32 run, sk_u32 rows_at, sk_u32 capacity,
                             SK_GLOBAL const float* triangles, SK_GLOBAL sk_u32* working,
                             SK_GLOBAL sk_reach* reaches) {
    const sk_u32 i = first + sk_global_id();
    const SetkaGridHeader grid = sk_reported_grid(working);
    if (i < n)
        sk_count_triangles(i * run, sk_min_u32(i * run + run, grid.triangle_count), grid,
                           sk_make_scatter(triangles, working, (SK_GLOBAL sk_u32*)0), reaches,
                           sk_make_row_list(working, rows_at, capacity));
}

/* A work-item a triangle. */
SK_KERNEL void scatter_place(sk_u32 n, sk_u32 first, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                             SK_GLOBAL sk_u32* working, SK_GLOBAL const sk_reach* reaches,
                             SK_GLOBAL sk_u32* references) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) sk_place_triangle(i, grid, sk_make_scatter(triangles, working, references), reaches);
}

/* A work-item for every step-th row of large triangles, elements first to n - 1. */
SK_KERNEL void scatter_count_rows(sk_u32 n, sk_u32 first, sk_u32 step, sk_u32 rows_at, sk_u32 capacity,
                                  SK_GLOBAL const float* triangles, SK_GLOBAL sk_u32* working) {
    const sk_u32 r = first + sk_global_id();
    if (r < n)
        sk_take_listed(r, step, sk_reported_grid(working),
                       sk_make_scatter(triangles, working, (SK_GLOBAL sk_u32*)0),
                       sk_make_row_list(working, rows_at, capacity), 0);
}

SK_KERNEL void scatter_place_rows(sk_u32 n, sk_u32 first, sk_u32 step, sk_u32 rows_at, sk_u32 capacity,
                                  SetkaGridHeader grid, SK_GLOBAL const float* triangles, SK_GLOBAL sk_u32* working,
                                  SK_GLOBAL sk_u32* references) {
    const sk_u32 r = first + sk_global_id();
    if (r < n)
        sk_take_listed(r, step, grid, sk_make_scatter(triangles, working, references),
                       sk_make_row_list(working, rows_at, capacity), 1);
}

/* A work-item a list. */
SK_KERNEL void lists_sort(sk_u32 n, sk_u32 alone, SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL sk_u32* references) {
    const sk_u32 r = sk_global_id();
    if (r < n) sk_sort_list(r, alone, cells, references);
}

/* A work-item a number of a long list, for both. */
SK_KERNEL void lists_rank(sk_u32 n, SK_GLOBAL const sk_piece* pieces, SK_GLOBAL const sk_u32* references,
                          SK_GLOBAL sk_u32* scratch) {
    const sk_u32 e = sk_global_id();
    if (e < n) sk_rank_in_piece(e, pieces, references, scratch);
}

SK_KERNEL void lists_merge(sk_u32 n, sk_u32 width, sk_u32 is_last, SK_GLOBAL const sk_piece* pieces,
                           SK_GLOBAL const sk_u32* from, SK_GLOBAL sk_u32* to, SK_GLOBAL sk_u32* references) {
    const sk_u32 e = sk_global_id();
    if (e < n) sk_merge_runs(e, width, is_last, pieces, from, to, references);
}

SK_KERNEL void import_blocks(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const sk_u32* counts,
                             SK_GLOBAL sk_u32* marks, SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_u32* totals) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_import_block(b, grid, counts, marks, blocks, totals);
}

SK_KERNEL void import_cells(sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const sk_i32* offsets,
                            SK_GLOBAL const sk_u32* counts, SK_GLOBAL const sk_u32* marks,
                            SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_cell_list* cells, SK_GLOBAL sk_u32* places) {
    const sk_u32 b = sk_global_id();
    if (b < n) sk_import_cells(b, grid, offsets, counts, marks, blocks, cells, places);
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
