/* SPDX-License-Identifier: MIT */
/**
 * Which pairs (cell, triangle) does a run of triangles put into which bins of cells? The first half of bins.h: each work-item takes a run, finds into which
 * cells its triangles reach, counts the pairs of each bin, and writes them bin by bin, in cache from the first to the last.
 */
#ifndef SETKA_DEVICE_GRID_BIN_RUNS_H
#define SETKA_DEVICE_GRID_BIN_RUNS_H

#include "device/grid/reach.h"
#if SK_WIDTH > 1
#include "device/grid/rows_lanes.h"
#endif

#if SK_WIDTH == 1

/** The reaches of triangles first to end - 1, and in how many cells large ones are at least, in units of SK_LONG_ROW. */
SK_FUNCTION sk_u64 sk_find_reaches(sk_u32 first, sk_u32 end, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                                   SK_GLOBAL sk_reach* reaches) {
    const sk_dims bins = sk_bin_dims(sk_cell_dims(grid));
    sk_u64 units = 0u;
    for (sk_u32 i = first; i < end; ++i) {
        const sk_cell_points points = sk_load_cell_points(grid, triangles + (size_t)i * 9u);
        const sk_box box = sk_box_of(grid, points);
        const sk_reach reach = sk_reach_by_rule(grid, points, sk_reach_by_box(box));
        if (sk_reach_kind(reach) == SK_REACH_LARGE) units += sk_longest_side(box) / SK_LONG_ROW;
        reaches[i] = sk_reach_in_bin(reach, box, bins);
    }
    return units;
}

#endif

/** A pair of a run in a bin: the cell's number there, above the triangle's in the run. */
SK_FUNCTION sk_u32 sk_pair_of(sk_u32 cell, sk_u32 triangle) { return cell * SK_LONGEST_RUN + triangle; }
SK_FUNCTION sk_u32 sk_cell_of_pair(sk_u32 pair) { return pair / SK_LONGEST_RUN; }
SK_FUNCTION sk_u32 sk_triangle_of_pair(sk_u32 pair) { return pair % SK_LONGEST_RUN; }

/** Where a run's pairs go. `next` has a number for each bin: of the run's pairs in it so far, or of the place of its next one. */
typedef struct sk_run_of_triangles {
    SK_GLOBAL sk_u32* next;
    SK_GLOBAL sk_u32* pairs;
    sk_dims bins;
} sk_run_of_triangles;

SK_FUNCTION sk_run_of_triangles sk_make_run(SK_GLOBAL sk_u32* next, SK_GLOBAL sk_u32* pairs, SetkaGridHeader grid) {
    sk_run_of_triangles r;
    r.next = next;
    r.pairs = pairs;
    r.bins = sk_bin_dims(sk_cell_dims(grid));
    return r;
}

#if SK_WIDTH > 1
/** Pairs of the lowest four bits of a mask, which are taken from it; of fewer, where it has no more. */
SK_FUNCTION sk_u4 sk_next_four(sk_u64* mask, sk_u32 corner) {
    const sk_u64 after_a = *mask & (*mask - 1u), after_b = after_a & (after_a - 1u), after_c = after_b & (after_b - 1u);
    const sk_u4 bits = sk_make_u4(sk_lowest_bit(*mask), sk_lowest_bit(after_a), sk_lowest_bit(after_b), sk_lowest_bit(after_c));
    *mask = after_c & (after_c - 1u);
    return ((bits & 3u) + (bits << 2 & 0x30u) + (bits << 4 & 0x300u)) * SK_LONGEST_RUN + corner;
}
#endif

/** Counts the pairs of a triangle whose cells are in one bin, as a mask from the bin's cell `first` on, or puts them where they belong. */
SK_FUNCTION void sk_hand_over_bin(sk_run_of_triangles run, sk_u32 bin, sk_u32 first, sk_u64 mask, sk_u32 triangle, const int put) {
    const sk_u32 count = sk_bit_count(mask), place = run.next[bin];
    if (put) {
        /* Cells of the mask add to this: what is too much for a bin's numbers falls off above. */
        const sk_u32 corner = sk_pair_of(first, triangle);
        SK_GLOBAL sk_u32* pairs = run.pairs + place;
#if SK_WIDTH > 1
        /* Four at once: most triangles have no more, and where a loop over single bits ends is guessed wrong. */
        sk_u64 rest = mask;
        sk_u32 left = count;
        for (; left > 4u; left -= 4u, pairs += 4) sk_store_u4(sk_next_four(&rest, corner), pairs);
        sk_put_u4(pairs, left, sk_next_four(&rest, corner));
#else
        for (sk_u64 rest = mask; rest != 0u; rest &= rest - 1u) *pairs++ = corner + sk_pair_of(sk_bin_step(sk_lowest_bit(rest)), 0u);
#endif
    }
    run.next[bin] = place + count;
}

/** Of a mask's 4 x 4 x 4 cells, those that lie less than `count` from its corner along an axis. */
SK_FUNCTION sk_u64 sk_near_x(sk_u32 count) { return ((sk_u64)0x11111111u << 32 | 0x11111111u) * ((1u << sk_min_u32(count, 4u)) - 1u); }
SK_FUNCTION sk_u64 sk_near_y(sk_u32 count) { return ((sk_u64)0x00010001u << 32 | 0x00010001u) * ((1u << sk_min_u32(4u * count, 16u)) - 1u); }
SK_FUNCTION sk_u64 sk_near_z(sk_u32 count) { return count < 4u ? ((sk_u64)1 << 16u * count) - 1u : ~(sk_u64)0; }

/** The pairs of a triangle whose cells are in several bins, up to two along each axis: one after the other. */
SK_FUNCTION void sk_hand_over_mask(sk_run_of_triangles run, sk_reach reach, sk_u32 triangle, const int put) {
    const sk_dims corner = sk_reach_corner(reach);
    const sk_u64 near_x = sk_near_x(SK_BIN_SIDE - corner.x % SK_BIN_SIDE), near_y = sk_near_y(SK_BIN_SIDE - corner.y % SK_BIN_SIDE),
                 near_z = sk_near_z(SK_BIN_SIDE - corner.z % SK_BIN_SIDE);
    const sk_u32 bin = sk_number_at(run.bins, corner.x / SK_BIN_SIDE, corner.y / SK_BIN_SIDE, corner.z / SK_BIN_SIDE);
    const sk_u32 first = sk_cell_in_bin(corner.x, corner.y, corner.z);
    const sk_u64 all = sk_reach_mask(reach);
    sk_u32 parts = 1u; /* bit x + 2 y + 4 z: some cell may be in that one of the eight bins */
    parts |= (all & ~near_x) != 0u ? parts << 1 : 0u;
    parts |= (all & ~near_y) != 0u ? parts << 2 : 0u;
    parts |= (all & ~near_z) != 0u ? parts << 4 : 0u;
    for (; parts != 0u; parts &= parts - 1u) {
        const sk_u32 part = sk_lowest_bit(parts), x = part & 1u, y = part >> 1 & 1u, z = part >> 2;
        const sk_u64 mask = all & (x != 0u ? ~near_x : near_x) & (y != 0u ? ~near_y : near_y) & (z != 0u ? ~near_z : near_z);
        /* Cells of the next bin on an axis are counted from this one's corner on, and so by a side too many. */
        if (mask != 0u)
            sk_hand_over_bin(run, bin + x + run.bins.x * (y + run.bins.y * z),
                             first - SK_BIN_SIDE * (x + SK_BIN_SIDE * (y + SK_BIN_SIDE * z)), mask, triangle, put);
    }
}

/** The pairs of column i of row j; how many these are. They follow each other in one bin after the other. */
SK_FUNCTION sk_u32 sk_hand_over_column(sk_run_of_triangles run, sk_cell_triangle t, sk_u32 i, sk_u32 j, sk_column column,
                                       sk_u32 triangle, const int put) {
    const int along_z = t.slot_w.cell == 16u, along_x = t.slot_w.cell == 1u;
    const sk_u32 stride = along_z ? SK_BIN_SIDE * SK_BIN_SIDE : along_x ? 1u : SK_BIN_SIDE;
    const sk_u32 end = column.first <= column.last ? column.last + 1u : column.first;
    for (sk_u32 k = column.first; k < end;) {
        const sk_u32 x = along_x ? k : i, y = along_z ? j : along_x ? i : k, z = along_z ? k : j;
        const sk_u32 cells = sk_min_u32(end - k, SK_BIN_SIDE - k % SK_BIN_SIDE);
        SK_GLOBAL sk_u32* next = run.next + sk_number_at(run.bins, x / SK_BIN_SIDE, y / SK_BIN_SIDE, z / SK_BIN_SIDE);
        const sk_u32 place = *next, first = sk_cell_in_bin(x, y, z);
        *next = place + cells;
        if (put)
            for (sk_u32 c = 0u; c < cells; ++c) run.pairs[place + c] = sk_pair_of(first + c * stride, triangle);
        k += cells;
    }
    return end - column.first;
}

/** Whether pairs are still counted: not if they are known to be more than any grid may have. */
SK_FUNCTION int sk_still_counts(SK_GLOBAL const sk_u32* report) {
    return *(volatile SK_GLOBAL const sk_u32*)(report + SK_TOTAL_FOUND) < SK_MOST_LONG_ROWS;
}
SK_FUNCTION void sk_add_found(SK_GLOBAL sk_u32* report, sk_u32 pairs) {
    if (pairs / SK_LONG_ROW != 0u) (void)sk_atomic_add(report + SK_TOTAL_FOUND, pairs / SK_LONG_ROW);
}

/** The pairs of a triangle that has no mask. */
SK_FUNCTION void sk_hand_over_rows(sk_run_of_triangles run, SetkaGridHeader grid, sk_cell_triangle t, sk_u32 triangle,
                                   SK_GLOBAL sk_u32* report, const int put) {
    const sk_u32 last = sk_last_row(grid, t);
#if SK_WIDTH > 1
    const sk_wide_triangle wide = sk_widen(t);
    for (sk_u32 start = sk_first_row(grid, t); start <= last; start += SK_WIDTH) {
        const sk_rows_lanes rows = sk_enter_rows(grid, t, wide, start);
        for (sk_u32 r = 0u; r < SK_WIDTH && start + r <= last; ++r)
            if (put || sk_still_counts(report)) {
                sk_u32 pairs = 0u;
                for (sk_u32 from = rows.first[r]; from <= rows.last[r]; from += SK_WIDTH) {
                    const sk_columns_lanes columns =
                        sk_enter_columns(grid, t, wide, start + r, rows.low[r], rows.high[r], from);
                    for (sk_u32 c = 0u; c < SK_WIDTH && from + c <= rows.last[r]; ++c) {
                        sk_column column;
                        column.first = columns.first[c];
                        column.last = columns.last[c];
                        pairs += sk_hand_over_column(run, t, from + c, start + r, column, triangle, put);
                    }
                }
                if (!put) sk_add_found(report, pairs);
            }
    }
#else
    for (sk_u32 j = sk_first_row(grid, t); j <= last; ++j)
        if (put || sk_still_counts(report)) {
            const sk_row row = sk_enter_row(grid, t, j);
            sk_u32 pairs = 0u;
            for (sk_u32 i = row.first; i <= row.last; ++i)
                pairs += sk_hand_over_column(run, t, i, j, sk_enter_column(grid, t, row, i), triangle, put);
            if (!put) sk_add_found(report, pairs);
        }
#endif
}

/** Adds up in how many cells large triangles are at least. Whether all known so far are in too many. */
SK_FUNCTION int sk_have_too_many(sk_u64 units, sk_u32 most_units, SK_GLOBAL sk_u32* report) {
    SK_GLOBAL sk_u32* total = report + SK_TOTAL_LONG;
    /* To add 0 is to read what others may be adding to; no work-item adds more than what is too much. */
    if (units != 0u && sk_atomic_add(total, 0u) < most_units)
        (void)sk_atomic_add(total, units < most_units ? (sk_u32)units : most_units);
    return sk_atomic_add(total, 0u) >= most_units;
}

/**
 * Hands over the pairs of the run's triangle i. Those without a mask are counted until they are known to be more than any grid may have: it is refused
 * then, and sk_fill_run() does not put what may not have been counted, so that what other work-items see of that changes nothing else.
 */
SK_FUNCTION void sk_hand_over(sk_run_of_triangles run, sk_u32 i, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                              SK_GLOBAL const sk_reach* reaches, SK_GLOBAL sk_u32* report, const int put) {
    const sk_reach reach = reaches[i];
    if (sk_reach_kind(reach) == SK_REACH_IN_BIN) {
        sk_hand_over_bin(run, reach.corner_xy, reach.corner_z & 0xffffu, sk_reach_mask(reach), i, put);
    } else if (sk_reach_kind(reach) == SK_REACH_MASK) {
        sk_hand_over_mask(run, reach, i, put);
    } else {
        sk_hand_over_rows(run, grid, sk_load_cell_triangle(grid, triangles + (size_t)i * 9u), i, report, put);
    }
}

/** Counts the pairs of the first n triangles: two at a time from far apart, as those beside each other wait for the counter of the same bin. */
SK_FUNCTION void sk_count_pairs(sk_run_of_triangles run, sk_u32 n, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                                SK_GLOBAL const sk_reach* reaches, SK_GLOBAL sk_u32* report) {
    for (sk_u32 k = 0u; k < n / 2u; ++k) {
        sk_hand_over(run, k, grid, triangles, reaches, report, 0);
        sk_hand_over(run, n / 2u + k, grid, triangles, reaches, report, 0);
    }
    if (n % 2u != 0u) sk_hand_over(run, n - 1u, grid, triangles, reaches, report, 0);
}

/** Numbers of pairs become places from `place` on. */
SK_FUNCTION void sk_start_bins(sk_u32 place, sk_u32 bins, SK_GLOBAL sk_u32* next) {
    for (sk_u32 b = 0u; b < bins; ++b) {
        const sk_u32 count = next[b];
        next[b] = place;
        place += count;
    }
}

/** How many pairs of all bins are counted. */
SK_FUNCTION sk_u64 sk_sum_bins(sk_u32 bins, SK_GLOBAL const sk_u32* next) {
    sk_u64 sum = 0u;
    for (sk_u32 b = 0u; b < bins; ++b) sum += next[b];
    return sum;
}

/**
 * Run r of `length` triangles: its pairs bin by bin, those of bin b from bounds[r * (bins + 1) + b] on, behind those of whichever run came before. They
 * are only counted where there is no room for them; and nothing is, where the grid has more bins than that, or where large triangles are known to have
 * too many cells: no bins are made then. `reaches` are the work-item's own, room for those of a run.
 */
SK_FUNCTION void sk_fill_run(sk_u32 r, sk_u32 length, sk_u32 bins, sk_u32 capacity, sk_u32 most_units, SetkaGridHeader grid,
                             SK_GLOBAL const float* triangles, SK_GLOBAL sk_reach* reaches, SK_GLOBAL sk_u32* bounds,
                             SK_GLOBAL sk_u32* pairs, SK_GLOBAL sk_u32* report) {
    SK_GLOBAL sk_u32* own = bounds + (size_t)r * (bins + 1u);
    SK_GLOBAL const float* first = triangles + (size_t)r * length * 9u;
    const sk_u32 before = sk_min_u32(r * length, grid.triangle_count), n = sk_min_u32(length, grid.triangle_count - before);
    const sk_run_of_triangles run = sk_make_run(own + 1, pairs, grid);
    int has_counted = sk_block_count(run.bins) <= bins;
    for (sk_u32 b = 0u; b <= bins; ++b) own[b] = 0u;
    if (has_counted) has_counted = !sk_have_too_many(sk_find_reaches(0u, n, grid, first, reaches), most_units, report);
    if (has_counted) {
        sk_u64 all;
        int is_whole;
        sk_count_pairs(run, n, grid, first, reaches, report);
        all = sk_sum_bins(bins, run.next);
        is_whole = sk_still_counts(report); /* or pairs may be missing, and there is no room for them */
        own[0] = sk_add_to_total(report + SK_TOTAL_BINNED_LOW, report + SK_TOTAL_BINNED_HIGH, all);
        if (is_whole && all <= capacity && own[0] <= capacity - all) {
            sk_start_bins(own[0], bins, run.next);
            for (sk_u32 k = 0u; k < n; ++k) sk_hand_over(run, k, grid, first, reaches, report, 1);
        }
    }
}

/**
 * The next of what the work-items of a launch share: they take one after the other, since not all of it takes equally long, and what each has of its
 * own stays in its cache. `before` is what earlier launches have taken, with one too many for each of their work-items; or no more than `most` each,
 * where drivers may end long loops early.
 */
SK_FUNCTION sk_u32 sk_take_next(SK_GLOBAL sk_u32* report, sk_u32 before) { return sk_atomic_add(report + SK_TOTAL_TAKEN, 1u) - before; }

/** Fills with the runs that the work-item gets, of those below n. */
SK_FUNCTION void sk_fill_runs(sk_u32 n, sk_u32 before, sk_u32 most, sk_u32 length, sk_u32 bins, sk_u32 capacity, sk_u32 most_units, SetkaGridHeader grid,
                              SK_GLOBAL const float* triangles, SK_GLOBAL sk_reach* reaches, SK_GLOBAL sk_u32* bounds,
                              SK_GLOBAL sk_u32* pairs, SK_GLOBAL sk_u32* report) {
    for (sk_u32 k = 0u; k < most; ++k) {
        const sk_u32 r = sk_take_next(report, before);
        if (r >= n) break;
        sk_fill_run(r, length, bins, capacity, most_units, grid, triangles, reaches, bounds, pairs, report);
    }
}

#endif
