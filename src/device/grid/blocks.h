/* SPDX-License-Identifier: MIT */
/**
 * Where is the list of a cell, and where is nothing? The tables that walks read. Cells come in blocks of 4 x 4 x 4, one
 * 16-byte record each: a bit a cell, and where the records of the block's non-empty cells begin. Only those have one. A third,
 * small table has a bit a block, in groups of 4 x 4 x 4 blocks. Blocks and groups are numbered like cells, bits inside as
 * sk_bit_in_block() says; cells and their lists follow each other in that order too, so that neighbours in space are
 * neighbours in memory.
 */
#ifndef SETKA_DEVICE_GRID_BLOCKS_H
#define SETKA_DEVICE_GRID_BLOCKS_H

#include "device/dialect.h"
#include "device/grid/limits.h"

/** 16 bytes, read at once. */
typedef struct SK_ALIGNED(16) sk_block {
    sk_u32 mask_low, mask_high; /* bit sk_bit_in_block() is set where a cell is not empty */
    sk_u32 first;               /* the record of the block's first non-empty cell */
    sk_u32 spare;               /* 0; while a grid is built, the pairs of the block and then those before it */
} sk_block;

/** references[offset .. offset + count) are the triangles of a cell. */
typedef struct SK_ALIGNED(8) sk_cell_list {
    sk_u32 offset, count;
} sk_cell_list;

typedef struct sk_dims {
    sk_u32 x, y, z;
} sk_dims;

SK_FUNCTION sk_dims sk_cell_dims(SetkaGridHeader grid) {
    sk_dims r;
    r.x = grid.dims[0];
    r.y = grid.dims[1];
    r.z = grid.dims[2];
    return r;
}

/** Blocks along the axes, for so many cells; or groups of blocks, for so many blocks. */
SK_FUNCTION sk_dims sk_block_dims(sk_dims cells) {
    sk_dims r;
    r.x = (cells.x + 3u) / 4u;
    r.y = (cells.y + 3u) / 4u;
    r.z = (cells.z + 3u) / 4u;
    return r;
}

SK_FUNCTION sk_u32 sk_number_at(sk_dims dims, sk_u32 x, sk_u32 y, sk_u32 z) { return (z * dims.y + y) * dims.x + x; }

/** The block that holds a cell, and the cell's bit in it. */
SK_FUNCTION sk_u32 sk_block_of(sk_dims blocks, sk_u32 x, sk_u32 y, sk_u32 z) {
    return sk_number_at(blocks, x >> 2, y >> 2, z >> 2);
}
SK_FUNCTION sk_u32 sk_bit_in_block(sk_u32 x, sk_u32 y, sk_u32 z) { return (z & 3u) * 16u + (y & 3u) * 4u + (x & 3u); }

/** The cell that a bit of block b stands for; it may be past the last one. */
SK_FUNCTION sk_dims sk_cell_of_bit(sk_dims blocks, sk_u32 b, sk_u32 bit) {
    sk_dims r;
    r.x = b % blocks.x * 4u + bit % 4u;
    r.y = b / blocks.x % blocks.y * 4u + bit / 4u % 4u;
    r.z = b / blocks.x / blocks.y * 4u + bit / 16u;
    return r;
}
SK_FUNCTION int sk_is_inside(sk_dims dims, sk_dims at) { return at.x < dims.x && at.y < dims.y && at.z < dims.z; }

SK_FUNCTION sk_u64 sk_mask_of(sk_block block) { return (sk_u64)block.mask_low | (sk_u64)block.mask_high << 32; }
SK_FUNCTION sk_u32 sk_has_bit(sk_block block, sk_u32 bit) {
    return (bit < 32u ? block.mask_low : block.mask_high) >> (bit & 31u) & 1u;
}
SK_FUNCTION sk_u32 sk_bit_count(sk_u64 mask) { return sk_popcount((sk_u32)mask) + sk_popcount((sk_u32)(mask >> 32)); }

/** How many cells before this one the block has a record for. */
SK_FUNCTION sk_u32 sk_rank_of(sk_block block, sk_u32 bit) {
    const sk_u32 below = ((sk_u32)1 << (bit & 31u)) - 1u;
    return bit < 32u ? sk_popcount(block.mask_low & below)
                     : sk_popcount(block.mask_low) + sk_popcount(block.mask_high & below);
}

/** The two words of group `group`'s bits from the blocks. */
SK_FUNCTION void sk_group_blocks(sk_u32 group, SetkaGridHeader grid, SK_GLOBAL const sk_block* blocks,
                                 SK_GLOBAL sk_u32* groups) {
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid)), group_dims = sk_block_dims(dims);
    sk_u64 mask = 0u;
    for (sk_u32 bit = 0u; bit < SK_BLOCK_CELLS; ++bit) {
        const sk_dims at = sk_cell_of_bit(group_dims, group, bit);
        if (sk_is_inside(dims, at) && sk_mask_of(blocks[sk_number_at(dims, at.x, at.y, at.z)]) != 0u)
            mask |= (sk_u64)1 << bit;
    }
    groups[2u * group] = (sk_u32)mask;
    groups[2u * group + 1u] = (sk_u32)(mask >> 32);
}

#endif
