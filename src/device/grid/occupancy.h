/* SPDX-License-Identifier: MIT */
/**
 * Where in the grid is nothing? One bit a cell, in blocks of 4 x 4 x 4 cells of two words each (the lower and the upper two
 * layers in z; bit (z % 2) * 16 + y * 4 + x), numbered like cells; and behind the blocks the same again with a block for a cell.
 * A walk reads one block instead of 64 offsets, and leaves in one step what is empty ahead of it.
 */
#ifndef SETKA_DEVICE_GRID_OCCUPANCY_H
#define SETKA_DEVICE_GRID_OCCUPANCY_H

#include "device/dialect.h"

/** What sk_clearance says of a cell that is not empty. */
#define SK_OCCUPIED 31u

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

/** Blocks along the axes. */
SK_FUNCTION sk_dims sk_block_dims(sk_dims cells) {
    sk_dims r;
    r.x = (cells.x + 3u) / 4u;
    r.y = (cells.y + 3u) / 4u;
    r.z = (cells.z + 3u) / 4u;
    return r;
}

/** Where the words of the second level begin. */
SK_FUNCTION sk_u32 sk_coarse_start(sk_dims blocks) { return 2u * blocks.x * blocks.y * blocks.z; }

/** The place that bit `bit` of word w stands for, among the children of `blocks` blocks; it may be past the last child. */
SK_FUNCTION sk_dims sk_child_of_bit(sk_dims blocks, sk_u32 w, sk_u32 bit) {
    const sk_u32 block = w / 2u;
    sk_dims r;
    r.x = block % blocks.x * 4u + bit % 4u;
    r.y = block / blocks.x % blocks.y * 4u + bit / 4u % 4u;
    r.z = block / blocks.x / blocks.y * 4u + (w & 1u) * 2u + bit / 16u;
    return r;
}

/** Word w of the first level, from the cells' offsets. */
SK_FUNCTION void sk_occupancy_fine(sk_u32 w, SetkaGridHeader grid, SK_GLOBAL const sk_i32* offsets,
                                   SK_GLOBAL sk_u32* occupancy) {
    const sk_dims cells = sk_cell_dims(grid), blocks = sk_block_dims(cells);
    sk_u32 word = 0u;
    for (sk_u32 bit = 0u; bit < 32u; ++bit) {
        const sk_dims at = sk_child_of_bit(blocks, w, bit);
        if (at.x < cells.x && at.y < cells.y && at.z < cells.z && offsets[(at.z * cells.y + at.y) * cells.x + at.x] >= 0)
            word |= 1u << bit;
    }
    occupancy[w] = word;
}

/** Word w of the second level, from the first. */
SK_FUNCTION void sk_occupancy_coarse(sk_u32 w, SetkaGridHeader grid, SK_GLOBAL sk_u32* occupancy) {
    const sk_dims cells = sk_block_dims(sk_cell_dims(grid)), blocks = sk_block_dims(cells);
    sk_u32 word = 0u;
    for (sk_u32 bit = 0u; bit < 32u; ++bit) {
        const sk_dims at = sk_child_of_bit(blocks, w, bit);
        if (at.x < cells.x && at.y < cells.y && at.z < cells.z) {
            SK_GLOBAL const sk_u32* fine = occupancy + (size_t)((at.z * cells.y + at.y) * cells.x + at.x) * 2u;
            if ((fine[0] | fine[1]) != 0u) word |= 1u << bit;
        }
    }
    occupancy[sk_coarse_start(cells) + w] = word;
}

/** The 64 bits of the block that holds (x, y, z). */
SK_FUNCTION sk_u64 sk_block_bits(SK_GLOBAL const sk_u32* words, sk_dims blocks, sk_u32 x, sk_u32 y, sk_u32 z) {
    SK_GLOBAL const sk_u32* block = words + (size_t)(((z >> 2) * blocks.y + (y >> 2)) * blocks.x + (x >> 2)) * 2u;
    return (sk_u64)block[0] | (sk_u64)block[1] << 32;
}

/** The bits of a block from (x, y, z) on, in the directions given: where a ray that is there may still go. */
SK_FUNCTION sk_u64 sk_bits_ahead(sk_u32 x, sk_u32 y, sk_u32 z, int forward_x, int forward_y, int forward_z) {
    const sk_u32 ix = x & 3u, iy = (y & 3u) * 4u, iz = (z & 3u) * 16u;
    const sk_u32 along_x = (forward_x ? 15u << ix & 15u : 15u >> (3u - ix)) * 0x11111111u;
    const sk_u32 along_y = (forward_y ? 0xffffu << iy & 0xffffu : 0xffffu >> (12u - iy)) * 0x00010001u;
    const sk_u64 everywhere = ~(sk_u64)0, layer = (sk_u64)(along_x & along_y);
    return (layer | layer << 32) & (forward_z ? everywhere << iz : everywhere >> (48u - iz));
}

#endif
