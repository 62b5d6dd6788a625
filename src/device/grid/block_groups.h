/* SPDX-License-Identifier: MIT */
/**
 * How are the blocks of a grid that is not large counted and laid out in two launches? A work-item a block: a group adds up its blocks when they
 * are counted, and those of all groups before it when lists are laid out. That is the scan of block_scan.h without launches of its own; nobody
 * waits for another group. Each group reads the sums of those before it, so there must not be too many of them.
 */
#ifndef SETKA_DEVICE_GRID_BLOCK_GROUPS_H
#define SETKA_DEVICE_GRID_BLOCK_GROUPS_H

#include "device/grid/block_scan.h"
#include "device/grid/scatter.h"

/** Non-empty cells and pairs in one number, in this order: sums of sums too, since tables hold fewer than 2^32 of each. */
SK_FUNCTION sk_u64 sk_packed_sums(sk_block_sums sums) { return (sums.cells << 32) + (sums.pairs & 0xffffffffu); }

/**
 * Counts the work-item's block, one of n, and adds up those of its group. The working memory has a place for blocks and one for a packed sum of each
 * group; the totals are in the report.
 */
SK_FUNCTION void sk_tally_blocks(SK_LOCAL sk_u64* scratch, SK_LOCAL sk_u64* pair_scratch, sk_u32 n, sk_u32 alone,
                                 sk_u32 blocks_at, sk_u32 sums_at, SK_GLOBAL sk_u32* working) {
    SK_GLOBAL sk_block* blocks = (SK_GLOBAL sk_block*)sk_part_of(working, blocks_at);
    SK_GLOBAL sk_u64* sums = (SK_GLOBAL sk_u64*)sk_part_of(working, sums_at);
    const sk_u32 b = sk_global_id(), item = sk_local_id();
    sk_block_sums own;
    if (b < n) sk_count_block(b, alone, sk_reported_grid(working), working, blocks);
    own = sk_sum_blocks(blocks, b, 1u, n);
    scratch[item] = own.cells;
    pair_scratch[item] = own.pairs;
    for (sk_u32 others = sk_local_size() / 2u; others > 0u; others /= 2u) {
        SK_BARRIER();
        if (item < others) {
            scratch[item] += scratch[item + others];
            pair_scratch[item] += pair_scratch[item + others];
        }
    }
    if (item == 0u) { /* who has added the last two */
        own.cells = scratch[0];
        own.pairs = pair_scratch[0];
        sums[sk_group_id()] = sk_packed_sums(own);
        if (own.cells != 0u) {
            sk_atomic_add(working + SK_TOTAL_CELLS, (sk_u32)own.cells);
            (void)sk_add_to_total(working + SK_TOTAL_PAIRS_LOW, working + SK_TOTAL_PAIRS_HIGH, own.pairs);
        }
    }
}

/** Lays out the work-item's block, one of n, as sk_lay_out_block() does. */
SK_FUNCTION void sk_settle_blocks(SK_LOCAL sk_u64* scratch, SK_LOCAL sk_u64* own_scratch, sk_u32 n, sk_u32 alone,
                                  SetkaGridHeader grid, sk_u32 blocks_at, sk_u32 sums_at, SK_GLOBAL sk_u32* working,
                                  SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_cell_list* cells,
                                  SK_GLOBAL sk_piece* pieces) {
    SK_GLOBAL const sk_block* counted = (SK_GLOBAL const sk_block*)sk_part_of(working, blocks_at);
    SK_GLOBAL const sk_u64* sums = (SK_GLOBAL const sk_u64*)sk_part_of(working, sums_at);
    const sk_u32 b = sk_global_id();
    const sk_u64 own = sk_packed_sums(sk_sum_blocks(counted, b, 1u, n));
    sk_u64 before = 0u;
    sk_u32 total_at;
    for (sk_u32 group = sk_local_id(); group < sk_group_id(); group += sk_local_size()) before += sums[group];
    sk_group_scan(scratch, before, &total_at);
    before = scratch[total_at] + sk_group_scan(own_scratch, own, &total_at);
    if (b < n) {
        sk_block block = counted[b];
        block.first = (sk_u32)(before >> 32);
        block.clearance = (sk_u32)before;
        sk_lay_out_block(b, alone, grid, working, block, blocks, cells, pieces);
    }
}

#endif
