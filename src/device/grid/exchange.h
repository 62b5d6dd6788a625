/* SPDX-License-Identifier: MIT */
/**
 * How do the paper's tables, an offset and a count for each cell, become the tables that walks read, and how do they come
 * back? One function a stage. Lists move between the order of cell numbers ("flat") and that of blocks; places[r] is where the
 * list of the r-th record lies in the flat order.
 */
#ifndef SETKA_DEVICE_GRID_EXCHANGE_H
#define SETKA_DEVICE_GRID_EXCHANGE_H

#include "device/grid/blocks.h"
#include "device/grid/limits.h"
#include "device/math.h"

/** Block b from the counts of its cells; `clearance` becomes the number of its pairs, or 2^32 - 1 if it is larger. */
SK_FUNCTION void sk_import_block(sk_u32 b, SetkaGridHeader grid, SK_GLOBAL const sk_u32* counts,
                                 SK_GLOBAL sk_u32* marks, SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_u32* totals) {
    const sk_dims cells = sk_cell_dims(grid), dims = sk_block_dims(cells);
    sk_u64 mask = 0u, pairs = 0u;
    sk_u32 longest = 0u;
    sk_block block;
    for (sk_u32 bit = 0u; bit < SK_BLOCK_CELLS; ++bit) {
        const sk_dims at = sk_cell_of_bit(dims, b, bit);
        if (sk_is_inside(cells, at)) {
            const sk_u32 count = counts[sk_number_at(cells, at.x, at.y, at.z)];
            if (count != 0u) mask |= (sk_u64)1 << bit;
            pairs += count;
            longest = sk_max_u32(longest, count);
        }
    }
    block.mask_low = (sk_u32)mask;
    block.mask_high = (sk_u32)(mask >> 32);
    block.first = 0u;
    block.clearance = pairs >> 32 != 0u ? 0xffffffffu : (sk_u32)pairs;
    blocks[b] = block;
    if (mask != 0u) sk_mark_block(dims, b, marks);
    if (longest > SK_LONG_LIST) sk_atomic_max(totals + SK_TOTAL_LONGEST, longest);
}

/** The records of block b's cells, after the scan; empty blocks learn their clearance. */
SK_FUNCTION void sk_import_cells(sk_u32 b, SetkaGridHeader grid, SK_GLOBAL const sk_i32* offsets,
                                 SK_GLOBAL const sk_u32* counts, SK_GLOBAL const sk_u32* marks,
                                 SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_cell_list* cells,
                                 SK_GLOBAL sk_u32* places) {
    const sk_dims cell_dims = sk_cell_dims(grid), dims = sk_block_dims(cell_dims);
    sk_block block = blocks[b];
    sk_u32 r = block.first;
    sk_cell_list list;
    list.offset = block.clearance;
    for (sk_u32 bit = 0u; bit < SK_BLOCK_CELLS; ++bit)
        if (sk_has_bit(block, bit)) {
            const sk_dims at = sk_cell_of_bit(dims, b, bit);
            const sk_u32 cell = sk_number_at(cell_dims, at.x, at.y, at.z);
            list.count = counts[cell];
            cells[r] = list;
            places[r] = (sk_u32)offsets[cell];
            list.offset += list.count;
            r += 1u;
        }
    block.clearance = sk_mask_of(block) != 0u ? 0u : sk_find_clearance(dims, b, marks);
    blocks[b] = block;
}

/** The counts of block b's cells, for all cells of the grid. */
SK_FUNCTION void sk_export_counts(sk_u32 b, SetkaGridHeader grid, SK_GLOBAL const sk_block* blocks,
                                  SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL sk_u32* counts) {
    const sk_dims cell_dims = sk_cell_dims(grid), dims = sk_block_dims(cell_dims);
    const sk_block block = blocks[b];
    sk_u32 r = block.first;
    for (sk_u32 bit = 0u; bit < SK_BLOCK_CELLS; ++bit) {
        const sk_dims at = sk_cell_of_bit(dims, b, bit);
        if (sk_is_inside(cell_dims, at)) {
            const sk_u32 is_listed = sk_has_bit(block, bit);
            counts[sk_number_at(cell_dims, at.x, at.y, at.z)] = is_listed ? cells[r].count : 0u;
            r += is_listed;
        }
    }
}

/** The offsets and places of block b's cells, from the scan of the counts. */
SK_FUNCTION void sk_export_offsets(sk_u32 b, SetkaGridHeader grid, SK_GLOBAL const sk_block* blocks,
                                   SK_GLOBAL const sk_u32* starts, SK_GLOBAL sk_i32* offsets,
                                   SK_GLOBAL sk_u32* places) {
    const sk_dims cell_dims = sk_cell_dims(grid), dims = sk_block_dims(cell_dims);
    const sk_block block = blocks[b];
    sk_u32 r = block.first;
    for (sk_u32 bit = 0u; bit < SK_BLOCK_CELLS; ++bit) {
        const sk_dims at = sk_cell_of_bit(dims, b, bit);
        if (sk_is_inside(cell_dims, at)) {
            const sk_u32 cell = sk_number_at(cell_dims, at.x, at.y, at.z);
            const sk_u32 is_listed = sk_has_bit(block, bit);
            offsets[cell] = is_listed ? (sk_i32)starts[cell] : -1;
            if (is_listed) places[r] = starts[cell];
            r += is_listed;
        }
    }
}

/** One reference of a list, between its place in the flat order and that in the order of blocks; none beyond the tables' end. */
SK_FUNCTION void sk_move_reference(sk_u32 in_blocks, sk_u32 flat, sk_u32 size, sk_u32 to_flat,
                                   SK_GLOBAL const sk_u32* from, SK_GLOBAL sk_u32* to) {
    if (in_blocks < size && flat < size) {
        if (to_flat)
            to[flat] = from[in_blocks];
        else
            to[in_blocks] = from[flat];
    }
}

/** The list of record r, unless it is long. */
SK_FUNCTION void sk_move_list(sk_u32 r, sk_u32 size, sk_u32 to_flat, SK_GLOBAL const sk_cell_list* cells,
                              SK_GLOBAL const sk_u32* places, SK_GLOBAL const sk_u32* from, SK_GLOBAL sk_u32* to) {
    const sk_cell_list list = cells[r];
    const sk_u32 place = places[r], count = list.count <= SK_LONG_LIST ? list.count : 0u;
    for (sk_u32 k = 0u; k < count; ++k) sk_move_reference(list.offset + k, place + k, size, to_flat, from, to);
}

/** Reference p, in the order of blocks, if it is of a long list. */
SK_FUNCTION void sk_move_long(sk_u32 p, sk_u32 size, sk_u32 to_flat, sk_u32 cell_count,
                              SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL const sk_u32* places,
                              SK_GLOBAL const sk_u32* from, SK_GLOBAL sk_u32* to) {
    sk_u32 low = 0u, high = cell_count; /* the last record that does not begin behind p is that of p */
    while (high - low > 1u) {
        const sk_u32 middle = low + (high - low) / 2u;
        if (cells[middle].offset <= p)
            low = middle;
        else
            high = middle;
    }
    if (cells[low].count > SK_LONG_LIST)
        sk_move_reference(p, places[low] + (p - cells[low].offset), size, to_flat, from, to);
}

#endif
