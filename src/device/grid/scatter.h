/* SPDX-License-Identifier: MIT */
/**
 * How do triangles get into the lists of their cells without being sorted? They are counted in their cells, the lists are laid out
 * one behind the other, and each triangle takes the next free place of each of its cells; then every list is put in order.
 */
#ifndef SETKA_DEVICE_GRID_SCATTER_H
#define SETKA_DEVICE_GRID_SCATTER_H

#include "device/grid/cells.h"
#include "device/grid/limits.h"

/** Block b from the counters of its cells; `spare` becomes the number of its pairs. */
SK_FUNCTION void sk_count_block(sk_u32 b, SK_GLOBAL const sk_u32* counters, SK_GLOBAL sk_block* blocks,
                                SK_GLOBAL sk_u32* totals) {
    SK_GLOBAL const sk_u32* own = counters + (size_t)b * SK_BLOCK_CELLS;
    sk_u64 pairs = 0u;
    sk_u32 longest = 0u, mask[2] = {0u, 0u};
    sk_block block;
    for (sk_u32 word = 0u; word < 2u; ++word)
        for (sk_u32 bit = 0u; bit < 32u; ++bit) {
            const sk_u32 count = own[word * 32u + bit];
            mask[word] |= (count != 0u ? 1u : 0u) << bit;
            pairs += count;
            longest = sk_max_u32(longest, count);
        }
    block.mask_low = mask[0];
    block.mask_high = mask[1];
    block.first = 0u;
    block.spare = pairs >> 32 != 0u ? 0xffffffffu : (sk_u32)pairs;
    blocks[b] = block;
    if (longest > SK_LONG_LIST) sk_atomic_min(totals + SK_TOTAL_LONGEST, ~longest);
}

#endif
