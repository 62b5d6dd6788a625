/* SPDX-License-Identifier: MIT */
/**
 * How do triangles get into the lists of their cells without being sorted? They are counted in their cells, the lists are laid out
 * one behind the other, and each triangle takes the next free place of each of its cells. Which place that is depends on
 * who comes first; what a list holds does not, and sort_lists.h puts it in order.
 */
#ifndef SETKA_DEVICE_GRID_SCATTER_H
#define SETKA_DEVICE_GRID_SCATTER_H

#include "device/grid/reach.h"
#include "device/grid/sort_lists.h"

/** What the kernels of one build share. A counter for each slot; later the next free place of its list. */
typedef struct sk_scatter {
    SK_GLOBAL const float* triangles;
    SK_GLOBAL sk_u32* counters;
    SK_GLOBAL sk_u32* references;
} sk_scatter;

SK_FUNCTION sk_scatter sk_make_scatter(SK_GLOBAL const float* triangles, SK_GLOBAL sk_u32* working,
                                       SK_GLOBAL sk_u32* references) {
    sk_scatter r;
    r.triangles = triangles;
    r.counters = sk_counters_of(working);
    r.references = references;
    return r;
}

/** Counts the triangle in the cell of a slot, or puts it into that cell's list. */
SK_FUNCTION void sk_take(sk_scatter out, sk_u32 slot, sk_u32 triangle, const int place) {
    const sk_u32 before = sk_atomic_add(out.counters + slot, 1u);
    if (place) out.references[before] = triangle;
}

/** The same for every cell that the triangle reaches into in row j; how many these are. */
SK_FUNCTION sk_u32 sk_take_row(SetkaGridHeader grid, sk_cell_triangle t, sk_u32 j, sk_scatter out, sk_u32 triangle,
                               const int place) {
    const sk_row row = sk_enter_row(grid, t, j);
    const sk_u32 row_slot = sk_slot_part(t.slot_v, j);
    sk_u32 count = 0u;
    for (sk_u32 i = row.first; i <= row.last; ++i) {
        const sk_column column = sk_enter_column(grid, t, row, i);
        const sk_u32 slot = row_slot + sk_slot_part(t.slot_u, i);
        for (sk_u32 k = column.first; k <= column.last; ++k)
            sk_take(out, slot + sk_slot_part(t.slot_w, k), triangle, place);
        if (column.first <= column.last) count += column.last - column.first + 1u;
    }
    return count;
}

/** The same for every row. */
SK_FUNCTION void sk_take_rows(SetkaGridHeader grid, sk_scatter out, sk_u32 triangle, const int place) {
    const sk_cell_triangle t = sk_load_cell_triangle(grid, out.triangles + (size_t)triangle * 9u);
    const sk_u32 last = sk_last_row(grid, t);
    for (sk_u32 j = sk_first_row(grid, t); j <= last; ++j) sk_take_row(grid, t, j, out, triangle, place);
}

/** The same for the cells of a mask. */
SK_FUNCTION void sk_take_mask(SetkaGridHeader grid, sk_scatter out, sk_reach reach, sk_u32 triangle, const int place) {
    const sk_slot_stride x = sk_slot_stride_of(grid, 0u), y = sk_slot_stride_of(grid, 1u), z = sk_slot_stride_of(grid, 2u);
    const sk_u32 x0 = reach.corner_xy & 0xffffu, y0 = reach.corner_xy >> 16, z0 = reach.corner_z & 0xffffu;
    for (sk_u64 rest = sk_reach_mask(reach); rest != 0u; rest &= rest - 1u) {
        const sk_u32 bit = sk_lowest_bit(rest);
        const sk_u32 slot = sk_slot_part(x, x0 + (bit & 3u)) + sk_slot_part(y, y0 + (bit >> 2 & 3u)) +
                            sk_slot_part(z, z0 + (bit >> 4));
        sk_take(out, slot, triangle, place);
    }
}

/** What is known of large triangles' rows: each a pair (triangle, row), `capacity` of them at most. */
typedef struct sk_row_list {
    SK_GLOBAL sk_u32* entries;
    SK_GLOBAL sk_u32* totals;
    sk_u32 capacity;
} sk_row_list;

/** That of the working memory, in which it begins `at` times 16 bytes from the start. */
SK_FUNCTION sk_row_list sk_make_row_list(SK_GLOBAL sk_u32* working, sk_u32 at, sk_u32 capacity) {
    sk_row_list r;
    r.entries = sk_part_of(working, at);
    r.totals = working;
    r.capacity = capacity;
    return r;
}

/**
 * Hands the rows of a large triangle to work-items of their own. Adds up the rows, and the cells that the triangle has at least, as
 * many as along its longest axis; stops adding when there are too many for any grid.
 */
SK_FUNCTION void sk_list_rows(SetkaGridHeader grid, SK_GLOBAL const float* triangles, sk_u32 triangle, sk_u32 longest,
                              sk_row_list list) {
    const sk_cell_triangle t = sk_load_cell_triangle(grid, triangles + (size_t)triangle * 9u);
    const sk_u32 first = sk_first_row(grid, t), count = sk_last_row(grid, t) - first + 1u;
    /* To add 0 is to read what others may be adding to. */
    if (sk_atomic_add(list.totals + SK_TOTAL_LONG, 0u) < SK_MOST_LONG_ROWS)
        sk_atomic_add(list.totals + SK_TOTAL_LONG, longest / SK_LONG_ROW);
    if (sk_atomic_add(list.totals + SK_TOTAL_ROWS, 0u) < SK_MOST_ROWS) {
        const sk_u32 start = sk_atomic_add(list.totals + SK_TOTAL_ROWS, count);
        for (sk_u32 k = 0u; k < count; ++k)
            if (start + k < list.capacity) {
                list.entries[2u * (size_t)(start + k)] = triangle;
                list.entries[2u * (size_t)(start + k) + 1u] = first + k;
            }
    }
}

/** Counts triangle i in its cells, and keeps what it reaches for when it is placed; or lists the rows of a large one. */
SK_FUNCTION void sk_count_triangle(sk_u32 i, sk_reach reach, SetkaGridHeader grid, sk_scatter out,
                                   SK_GLOBAL sk_reach* reaches, sk_row_list list) {
    reaches[i] = reach;
    if (sk_reach_kind(reach) == SK_REACH_MASK) {
        sk_take_mask(grid, out, reach, i, 0);
    } else if (sk_reach_kind(reach) == SK_REACH_ROWS) {
        sk_take_rows(grid, out, i, 0);
    } else {
        const sk_cell_points points = sk_load_cell_points(grid, out.triangles + (size_t)i * 9u);
        sk_list_rows(grid, out.triangles, i, sk_longest_side(sk_box_of(grid, points)), list);
    }
}

/** Counts triangles first to end - 1. */
SK_FUNCTION void sk_count_triangles(sk_u32 first, sk_u32 end, SetkaGridHeader grid, sk_scatter out,
                                    SK_GLOBAL sk_reach* reaches, sk_row_list list) {
    for (sk_u32 i = first; i < end; ++i) {
        const sk_cell_points points = sk_load_cell_points(grid, out.triangles + (size_t)i * 9u);
        const sk_reach reach = sk_reach_by_rule(grid, points, sk_reach_by_box(sk_box_of(grid, points)));
        sk_count_triangle(i, reach, grid, out, reaches, list);
    }
}

/** Puts triangle i into the lists of its cells, unless it is large. */
SK_FUNCTION void sk_place_triangle(sk_u32 i, SetkaGridHeader grid, sk_scatter out, SK_GLOBAL const sk_reach* reaches) {
    const sk_reach reach = reaches[i];
    if (sk_reach_kind(reach) == SK_REACH_MASK)
        sk_take_mask(grid, out, reach, i, 1);
    else if (sk_reach_kind(reach) == SK_REACH_ROWS)
        sk_take_rows(grid, out, i, 1);
}

/**
 * Does the listed rows r, r + step, …. Nothing is done if not all rows are listed, or if they are known to be
 * too many; and counting ends when the cells found are more than any grid may have: it is refused then. What other work-items
 * see of that changes nothing else.
 */
SK_FUNCTION void sk_take_listed(sk_u32 r, sk_u32 step, SetkaGridHeader grid, sk_scatter out, sk_row_list list,
                                const int place) {
    const sk_u32 rows = list.totals[SK_TOTAL_ROWS];
    const int is_hopeless = rows > list.capacity || list.totals[SK_TOTAL_LONG] >= SK_MOST_LONG_ROWS;
    for (sk_u32 k = r; k < rows && !is_hopeless; k += step)
        if (place || *(volatile SK_GLOBAL sk_u32*)(list.totals + SK_TOTAL_FOUND) < SK_MOST_LONG_ROWS) {
            const sk_u32 triangle = list.entries[2u * (size_t)k], j = list.entries[2u * (size_t)k + 1u];
            const sk_cell_triangle t = sk_load_cell_triangle(grid, out.triangles + (size_t)triangle * 9u);
            const sk_u32 units = sk_take_row(grid, t, j, out, triangle, place) / SK_LONG_ROW;
            if (!place && units != 0u) sk_atomic_add(list.totals + SK_TOTAL_FOUND, units);
        }
}

SK_FUNCTION sk_u32 sk_pieces_of(sk_u32 count, sk_u32 alone) { return count > alone ? sk_piece_count(count) : 0u; }

/** The marks of blocks lie behind the counters of as many blocks as the grid has, wherever the table ends. */
SK_FUNCTION SK_GLOBAL sk_u32* sk_marks_behind(SK_GLOBAL sk_u32* counters, sk_dims blocks) {
    return counters + (size_t)sk_block_count(blocks) * SK_BLOCK_CELLS;
}

/**
 * Block b from the counters of its cells; `clearance` becomes the number of its pairs. Lists longer than `alone` come in pieces. A block
 * beyond the grid's last one, for which there is room only because the grid was not known, is empty.
 */
SK_FUNCTION void sk_count_block(sk_u32 b, sk_u32 alone, SetkaGridHeader grid, SK_GLOBAL sk_u32* working,
                                SK_GLOBAL sk_block* blocks) {
    SK_GLOBAL sk_u32* counters = sk_counters_of(working);
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid));
    const sk_u32 rows = b < sk_block_count(dims) ? SK_BLOCK_CELLS / 4u : 0u;
    SK_GLOBAL const sk_four_counts* own = (SK_GLOBAL const sk_four_counts*)(counters + (size_t)b * SK_BLOCK_CELLS);
    sk_tally tally = sk_no_tally();
    sk_u32 pieces = 0u;
    for (sk_u32 row = 0u; row < rows; ++row) {
        const sk_four_counts counts = own[row];
        tally = sk_tally_row(tally, row, counts);
        if (tally.longest > alone)
            pieces += sk_pieces_of(counts.a, alone) + sk_pieces_of(counts.b, alone) +
                      (sk_pieces_of(counts.c, alone) + sk_pieces_of(counts.d, alone));
    }
    blocks[b] = sk_counted_block(tally);
    if (tally.mask != 0u) sk_mark_block(dims, b, sk_marks_behind(counters, dims));
    if (tally.longest > sk_min_u32(alone, SK_LONG_LIST)) sk_atomic_max(working + SK_TOTAL_LONGEST, tally.longest);
    if (pieces != 0u) sk_atomic_add(working + SK_TOTAL_PIECES, pieces);
}

/** Cuts a list into pieces. */
SK_FUNCTION void sk_cut_list(sk_cell_list list, SK_GLOBAL sk_piece* pieces, SK_GLOBAL sk_u32* totals) {
    const sk_u32 count = sk_piece_count(list.count);
    sk_piece piece;
    piece.offset = list.offset;
    piece.count = list.count;
    piece.first = sk_atomic_add(totals + SK_TOTAL_CUT, count);
    piece.spare = 0u;
    for (sk_u32 k = 0u; k < count; ++k) pieces[piece.first + k] = piece;
}

/**
 * The record of block b and those of its cells, from what was counted and scanned (`block`); the counters become the first places of the lists.
 * Empty blocks learn their clearance.
 */
SK_FUNCTION void sk_lay_out_block(sk_u32 b, sk_u32 alone, SetkaGridHeader grid, SK_GLOBAL sk_u32* working,
                                  sk_block block, SK_GLOBAL sk_block* blocks, SK_GLOBAL sk_cell_list* cells,
                                  SK_GLOBAL sk_piece* pieces) {
    SK_GLOBAL sk_u32* counters = sk_counters_of(working);
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid));
    SK_GLOBAL sk_u32* own = counters + (size_t)b * SK_BLOCK_CELLS;
    sk_u32 r = block.first;
    sk_cell_list list;
    list.offset = block.clearance;
    for (sk_u64 rest = sk_mask_of(block); rest != 0u; rest &= rest - 1u) {
        const sk_u32 bit = sk_lowest_bit(rest);
        list.count = own[bit];
        own[bit] = list.offset;
        cells[r] = list;
        if (list.count > alone) sk_cut_list(list, pieces, working);
        list.offset += list.count;
        r += 1u;
    }
    block.clearance =
        sk_mask_of(block) != 0u ? 0u : sk_find_clearance(dims, b, sk_marks_behind(counters, dims));
    blocks[b] = block;
}

#endif
