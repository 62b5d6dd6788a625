/* SPDX-License-Identifier: MIT */
/**
 * Where is the list of a cell, and where is nothing? The tables that walks read. Cells come in blocks of 4 x 4 x 4, one
 * 16-byte record each: a bit a cell, where the records of the block's non-empty cells begin, and how far around an empty block
 * there is nothing. Only non-empty cells have a record. Blocks are numbered like cells, bits inside as sk_bit_in_block() says; cells and their lists follow each other in that order too, so that neighbours in space are
 * neighbours in memory.
 */
#ifndef SETKA_DEVICE_GRID_BLOCKS_H
#define SETKA_DEVICE_GRID_BLOCKS_H

#include "device/dialect.h"
#include "device/grid/limits.h"
#include "device/math.h"

/** 16 bytes, read at once. */
typedef struct SK_ALIGNED(16) sk_block {
    sk_u32 mask_low, mask_high; /* bit sk_bit_in_block() is set where a cell is not empty */
    sk_u32 first;               /* the record of the block's first non-empty cell */
    sk_u32 clearance;           /* 4 k - 1 where the block and those less than k blocks away are empty, k up to 4; 0 where it is not.
                                   While a grid is built, the pairs of the block and then those before it. */
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

/** Blocks along the axes, for so many cells. */
SK_FUNCTION sk_dims sk_block_dims(sk_dims cells) {
    sk_dims r;
    r.x = (cells.x + 3u) / 4u;
    r.y = (cells.y + 3u) / 4u;
    r.z = (cells.z + 3u) / 4u;
    return r;
}

SK_FUNCTION sk_u32 sk_block_count(sk_dims blocks) { return blocks.x * blocks.y * blocks.z; }

/** The grid in which is counted; one without triangles and cells where none was made. */
SK_FUNCTION SetkaGridHeader sk_reported_grid(SK_GLOBAL const sk_u32* report) {
    return *(SK_GLOBAL const SetkaGridHeader*)(report + SK_REPORT_HEADER);
}

/** Adds to a total of two words; what the lower one was. When two do so at once, each takes along the carry that it caused. */
SK_FUNCTION sk_u32 sk_add_to_total(SK_GLOBAL sk_u32* low, SK_GLOBAL sk_u32* high, sk_u64 value) {
    const sk_u32 part = (sk_u32)value;
    const sk_u32 before = sk_atomic_add(low, part);
    const sk_u32 above = (sk_u32)(value >> 32) + (before + part < part ? 1u : 0u);
    if (above != 0u) (void)sk_atomic_add(high, above);
    return before;
}

/**
 * The working memory of a build that counts in cells: the report, the counters of cells, with the marks of blocks behind them, and what else the
 * host has laid behind these. One buffer, since some drivers take time for each that a launch has.
 */
SK_FUNCTION SK_GLOBAL sk_u32* sk_counters_of(SK_GLOBAL sk_u32* working) { return working + SK_REPORT; }
/** What begins at so many times 16 bytes. */
SK_FUNCTION SK_GLOBAL sk_u32* sk_part_of(SK_GLOBAL sk_u32* working, sk_u32 at) { return working + (size_t)at * 4u; }

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

/** The bits of the aligned 2 x 2 x 2 cells from bit 0 on, in one word of a block's mask; and what of a cell's bit is the first of its eight. */
#define SK_EIGHT_CELLS 0x00330033
#define SK_FIRST_OF_EIGHT (2 + 8)
SK_FUNCTION int sk_has_one_of_eight(sk_block block, sk_u32 bit) {
    return ((bit < 32u ? block.mask_low : block.mask_high) >> (bit & SK_FIRST_OF_EIGHT) & SK_EIGHT_CELLS) != 0u;
}

SK_FUNCTION sk_u64 sk_mask_of(sk_block block) { return (sk_u64)block.mask_low | (sk_u64)block.mask_high << 32; }
SK_FUNCTION sk_u32 sk_has_bit(sk_block block, sk_u32 bit) {
    return (bit < 32u ? block.mask_low : block.mask_high) >> (bit & 31u) & 1u;
}
SK_FUNCTION sk_u32 sk_bit_count(sk_u64 mask) { return sk_popcount_u64(mask); }
/** The number of the lowest bit of a mask that has one. */
SK_FUNCTION sk_u32 sk_lowest_bit(sk_u64 mask) { return sk_popcount_u64(~mask & (mask - 1u)); }

/** How many cells before this one the block has a record for. */
SK_FUNCTION sk_u32 sk_rank_of(sk_block block, sk_u32 bit) {
    const sk_u32 below = ((sk_u32)1 << (bit & 31u)) - 1u;
    return bit < 32u ? sk_popcount(block.mask_low & below)
                     : sk_popcount(block.mask_low) + sk_popcount(block.mask_high & below);
}

/** Counters of four cells, read at once. */
typedef struct SK_ALIGNED(16) sk_four_counts {
    sk_u32 a, b, c, d;
} sk_four_counts;

/** What is known of a block while its counters are read. */
typedef struct sk_tally {
    sk_u64 mask, pairs;
    sk_u32 longest;
} sk_tally;

SK_FUNCTION sk_tally sk_no_tally(void) {
    sk_tally r;
    r.mask = 0u;
    r.pairs = 0u;
    r.longest = 0u;
    return r;
}

/** The same with the cells from bit 4 * row on. */
SK_FUNCTION sk_tally sk_tally_row(sk_tally tally, sk_u32 row, sk_four_counts counts) {
    const sk_u32 most = sk_max_u32(sk_max_u32(counts.a, counts.b), sk_max_u32(counts.c, counts.d));
    const sk_u32 bits = (counts.a != 0u ? 1u : 0u) | (counts.b != 0u ? 2u : 0u) | (counts.c != 0u ? 4u : 0u) |
                        (counts.d != 0u ? 8u : 0u);
    sk_tally r;
    r.mask = tally.mask | (sk_u64)bits << 4u * row;
    r.pairs = tally.pairs + (((sk_u64)counts.a + counts.b) + ((sk_u64)counts.c + counts.d));
    r.longest = sk_max_u32(tally.longest, most);
    return r;
}

/** The block's record until the lists are laid out: `clearance` is the number of its pairs. */
SK_FUNCTION sk_block sk_counted_block(sk_tally tally) {
    sk_block r;
    r.mask_low = (sk_u32)tally.mask;
    r.mask_high = (sk_u32)(tally.mask >> 32);
    r.first = 0u;
    r.clearance = tally.pairs >> 32 != 0u ? 0xffffffffu : (sk_u32)tally.pairs;
    return r;
}

/**
 * Marks: a bit for each block along x, set where the block is not empty. Word i of a row of blocks has the 32 from block 16 i - 8 on, so that
 * one word has all blocks that are near one of its middle; most blocks have two bits.
 */
#define SK_MARKED_BLOCKS 16u
SK_FUNCTION sk_u32 sk_words_in_row(sk_dims blocks) { return (blocks.x + SK_MARKED_BLOCKS - 1u) / SK_MARKED_BLOCKS; }

/** Sets the marks of block b, which is not empty. They are 0 at first. */
SK_FUNCTION void sk_mark_block(sk_dims blocks, sk_u32 b, SK_GLOBAL sk_u32* marks) {
    const sk_u32 x = b % blocks.x, row = b / blocks.x;
    const sk_u32 words = sk_words_in_row(blocks), i = x / SK_MARKED_BLOCKS, k = x % SK_MARKED_BLOCKS;
    SK_GLOBAL sk_u32* word = marks + ((size_t)row * words + i);
    (void)sk_atomic_or(word, 1u << (k + 8u));
    if (k < 8u && i > 0u) (void)sk_atomic_or(word - 1, 1u << (k + 24u));
    if (k >= 8u && i + 1u < words) (void)sk_atomic_or(word + 1, 1u << (k - 8u));
}

/** How many blocks around an empty one are looked at, in each direction. */
#define SK_FAR 3

/** The row that is at a distance; past the grid's end the last one stands in, which is nearer. */
SK_FUNCTION sk_u32 sk_row_at(sk_u32 from, sk_i32 distance, sk_u32 rows) {
    const sk_i32 at = (sk_i32)from + distance;
    return at < 0 ? 0u : sk_min_u32((sk_u32)at, rows - 1u);
}

/** The words at `column` of all rows whose distance from row (y, z) is `around` in one direction and no more in the other. */
SK_FUNCTION sk_u32 sk_marks_around(sk_dims blocks, sk_u32 y, sk_u32 z, sk_u32 around, SK_GLOBAL const sk_u32* column) {
    const sk_u32 words = sk_words_in_row(blocks);
    const sk_i32 far = (sk_i32)around;
    sk_u32 some = 0u;
    for (sk_i32 dz = -far; dz <= far; ++dz) {
        const sk_i32 step = dz == far || dz == -far ? 1 : 2 * far;
        const sk_u32 first = sk_row_at(z, dz, blocks.z) * blocks.y;
        for (sk_i32 dy = -far; dy <= far; dy += step)
            some |= column[(size_t)(first + sk_row_at(y, dy, blocks.y)) * words];
    }
    return some;
}

/** Whether a block is marked in a word, up to `around` blocks from block x; the word is that of its column. */
SK_FUNCTION sk_u32 sk_is_marked_near(sk_u32 word, sk_u32 x, sk_u32 around) {
    return (word >> (x % SK_MARKED_BLOCKS + 8u - around) & ((2u << 2u * around) - 1u)) != 0u ? 1u : 0u;
}

/** The clearance of block b, which is empty. */
SK_FUNCTION sk_u32 sk_find_clearance(sk_dims blocks, sk_u32 b, SK_GLOBAL const sk_u32* marks) {
    const sk_u32 row = b / blocks.x, x = b % blocks.x, y = row % blocks.y, z = row / blocks.y;
    SK_GLOBAL const sk_u32* column = marks + x / SK_MARKED_BLOCKS;
    sk_u32 some = column[(size_t)row * sk_words_in_row(blocks)], around = 1u; /* of all rows that are so near; the next distance */
    while (around <= SK_FAR) {
        some |= sk_marks_around(blocks, y, z, around, column);
        if (sk_is_marked_near(some, x, around) != 0u) break;
        around += 1u;
    }
    return 4u * around - 1u;
}

#endif
