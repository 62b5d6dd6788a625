/* SPDX-License-Identifier: MIT */
/**
 * Where do a block's cells and lists begin? The exclusive scan of device/scan.h over blocks, for two numbers of each at once: its
 * non-empty cells and its pairs. The same three steps; there are few blocks, one for 64 cells.
 */
#ifndef SETKA_DEVICE_GRID_BLOCK_SCAN_H
#define SETKA_DEVICE_GRID_BLOCK_SCAN_H

#include "device/grid/blocks.h"
#include "device/grid/limits.h"
#include "device/scan.h"

typedef struct sk_block_sums {
    sk_u64 cells, pairs;
} sk_block_sums;

/** Blocks [first, first + elements) of n, whose `clearance` are their pairs. */
SK_FUNCTION sk_block_sums sk_sum_blocks(SK_GLOBAL const sk_block* blocks, sk_u64 first, sk_u32 elements, sk_u32 n) {
    sk_block_sums r;
    r.cells = 0u;
    r.pairs = 0u;
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) {
            const sk_block block = blocks[first + k];
            r.cells += sk_bit_count(sk_mask_of(block));
            r.pairs += block.clearance;
        }
    return r;
}

/** sums[group] = the cells of the group's blocks, sums[groups + 1 + group] = their pairs. */
SK_FUNCTION void sk_blocks_reduce(SK_LOCAL sk_u64* scratch, SK_LOCAL sk_u64* pair_scratch, sk_u32 n, sk_u32 elements,
                                  sk_u32 groups, SK_GLOBAL const sk_block* blocks, SK_GLOBAL sk_u64* sums) {
    const sk_block_sums own = sk_sum_blocks(blocks, (sk_u64)sk_global_id() * elements, elements, n);
    sk_u32 total_at;
    sk_group_scan(scratch, own.cells, &total_at);
    sk_group_scan(pair_scratch, own.pairs, &total_at);
    if (sk_local_id() == 0u) {
        sums[sk_group_id()] = scratch[total_at];
        sums[groups + 1u + sk_group_id()] = pair_scratch[total_at];
    }
}

/** One group: each of the n sums of both kinds becomes that of those before it; the totals go to `totals`. */
SK_FUNCTION void sk_blocks_spine(SK_LOCAL sk_u64* scratch, SK_LOCAL sk_u64* pair_scratch, sk_u32 n, sk_u32 elements,
                                 SK_GLOBAL sk_u64* sums, SK_GLOBAL sk_u32* totals) {
    sk_scan_spine(scratch, n, elements, sums);
    sk_scan_spine(pair_scratch, n, elements, sums + (n + 1u));
    if (sk_local_id() == 0u) { /* who wrote them */
        totals[SK_TOTAL_CELLS] = (sk_u32)sums[n];
        totals[SK_TOTAL_PAIRS_LOW] = (sk_u32)sums[2u * n + 1u];
        totals[SK_TOTAL_PAIRS_HIGH] = (sk_u32)(sums[2u * n + 1u] >> 32);
    }
}

/** first and clearance of each block become the cells and the pairs before it. */
SK_FUNCTION void sk_blocks_apply(SK_LOCAL sk_u64* scratch, SK_LOCAL sk_u64* pair_scratch, sk_u32 n, sk_u32 elements,
                                 sk_u32 groups, SK_GLOBAL const sk_u64* sums, SK_GLOBAL sk_block* blocks) {
    const sk_u64 first = (sk_u64)sk_global_id() * elements;
    const sk_block_sums own = sk_sum_blocks(blocks, first, elements, n);
    sk_u32 total_at;
    sk_u64 cells = sums[sk_group_id()] + sk_group_scan(scratch, own.cells, &total_at);
    sk_u64 pairs = sums[groups + 1u + sk_group_id()] + sk_group_scan(pair_scratch, own.pairs, &total_at);
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) {
            sk_block block = blocks[first + k];
            const sk_u32 of_block = block.clearance;
            block.first = (sk_u32)cells;
            block.clearance = (sk_u32)pairs;
            blocks[first + k] = block;
            cells += sk_bit_count(sk_mask_of(block));
            pairs += of_block;
        }
}

#endif
