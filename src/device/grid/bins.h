/* SPDX-License-Identifier: MIT */
/**
 * How do lists come about without sorting and without an atomic operation for each pair, where few work-items run at a time? Cells come in bins of 16 x 16 x 16. Each work-item
 * takes a run of triangles and writes its pairs (cell, triangle) bin by bin, in cache from the first to the last; a bin is one work-item's then, whose
 * counters fit the nearest cache and are nobody else's. It takes its pairs from one run after the other, in which they follow the triangles, so that
 * every list comes out in ascending order.
 */
#ifndef SETKA_DEVICE_GRID_BINS_H
#define SETKA_DEVICE_GRID_BINS_H

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

/** What all runs have left. */
typedef struct sk_binned {
    SK_GLOBAL const sk_u32* bounds; /* of run r in bin b: from r * (bins + 1) + b on, up to the next one's */
    SK_GLOBAL const sk_u32* pairs;
    sk_u32 length, runs, bins;
} sk_binned;

SK_FUNCTION sk_binned sk_make_binned(SK_GLOBAL const sk_u32* bounds, SK_GLOBAL const sk_u32* pairs, sk_u32 length, sk_u32 runs,
                                     sk_u32 bins) {
    sk_binned r;
    r.bounds = bounds;
    r.pairs = pairs;
    r.length = length;
    r.runs = runs;
    r.bins = bins;
    return r;
}
SK_FUNCTION SK_GLOBAL const sk_u32* sk_bounds_in_bin(sk_binned all, sk_u32 r, sk_u32 bin) {
    return all.bounds + ((size_t)r * (all.bins + 1u) + bin);
}

/** Whether all pairs are in bins. */
SK_FUNCTION int sk_is_binned(SK_GLOBAL const sk_u32* report, sk_u32 capacity, sk_u32 most_units) {
    return report[SK_TOTAL_LONG] < most_units && report[SK_TOTAL_BINNED_HIGH] == 0u && report[SK_TOTAL_BINNED_LOW] <= capacity;
}

/** The pairs of a bin in run r, if there is one, will be needed soon. They lie far from those of the run before, and processors foresee a line only when they
 * have read some: the first ones are asked for. */
SK_FUNCTION void sk_await_pairs(sk_binned all, sk_u32 r, sk_u32 bin) {
#if SK_WIDTH > 1
    if (r < all.runs && all.runs >= SK_FAR_TRIANGLES / all.length) {
        SK_GLOBAL const sk_u32* bounds = sk_bounds_in_bin(all, r, bin);
        const sk_u32 end = sk_min_u32(bounds[1], bounds[0] + 256u);
        for (sk_u32 p = bounds[0]; p < end; p += 16u) sk_prefetch(all.pairs + p);
    }
#endif
}

/** Counts the pairs of a bin in its cells; how many these are. Where there are none, counters are left as they are. */
SK_FUNCTION sk_u32 sk_count_in_bin(sk_binned all, sk_u32 bin, SK_GLOBAL sk_u32* counters) {
    sk_u32 count = 0u;
    for (sk_u32 r = 0u; r < all.runs; ++r) {
        SK_GLOBAL const sk_u32* bounds = sk_bounds_in_bin(all, r, bin);
        const sk_u32 end = bounds[1];
        sk_u32 p = bounds[0];
        if (p < end && count == 0u) {
            sk_four_counts none;
            none.a = none.b = none.c = none.d = 0u;
            for (sk_u32 c = 0u; c < SK_BIN_CELLS / 4u; ++c) ((SK_GLOBAL sk_four_counts*)counters)[c] = none;
        }
        count += end - p;
        sk_await_pairs(all, r + 1u, bin);
        for (; p < end; ++p) counters[sk_cell_of_pair(all.pairs[p])] += 1u;
    }
    return count;
}

/**
 * What tallying has counted, for placing: SK_KEPT_WORDS for each block that is not empty, one after the other along x, then y, then z of a bin, the first
 * of which is in the place starts[bin]. That is SK_NOT_KEPT where there was no room or a list is longer than SK_KEPT_MOST. Work-items take room for `chunk`
 * blocks at a time.
 */
typedef struct sk_kept_counts {
    SK_GLOBAL sk_u32* words; /* null: none are kept */
    SK_GLOBAL sk_u32* starts;
    sk_u32 room, chunk; /* blocks */
} sk_kept_counts;
#define SK_NOT_KEPT 0xffffffffu

/** Chunks are those of a few bins, so that little of one is left over, and no more than each of the work-items can have. */
SK_FUNCTION sk_kept_counts sk_make_kept(SK_GLOBAL sk_u32* words, SK_GLOBAL sk_u32* starts, sk_u32 room, sk_u32 items) {
    sk_kept_counts r;
    r.words = words;
    r.starts = starts;
    r.room = room;
    r.chunk = sk_max_u32(1u, sk_min_u32(4u, room / SK_BIN_BLOCKS / items)) * SK_BIN_BLOCKS;
    return r;
}
/** That of bit `bit` of the block at `place`. */
SK_FUNCTION sk_u32 sk_kept_count(sk_kept_counts kept, sk_u32 place, sk_u32 bit) {
    return kept.words[(size_t)place * SK_KEPT_WORDS + bit / 4u] >> bit % 4u * 8u & SK_KEPT_MOST;
}

/** What a work-item has taken of the room for counts, and not used yet. */
typedef struct sk_kept_room {
    sk_u32 next, end;
} sk_kept_room;

/** The first block of a bin, and how many along each axis are inside the grid. */
typedef struct sk_bin_blocks {
    sk_dims first, count;
} sk_bin_blocks;

SK_FUNCTION sk_bin_blocks sk_blocks_of_bin(sk_dims blocks, sk_dims bins, sk_u32 bin) {
    sk_bin_blocks r;
    r.first.x = bin % bins.x * SK_BIN_SIDE / 4u;
    r.first.y = bin / bins.x % bins.y * SK_BIN_SIDE / 4u;
    r.first.z = bin / bins.x / bins.y * SK_BIN_SIDE / 4u;
    r.count.x = sk_min_u32(blocks.x - r.first.x, SK_BIN_SIDE / 4u);
    r.count.y = sk_min_u32(blocks.y - r.first.y, SK_BIN_SIDE / 4u);
    r.count.z = sk_min_u32(blocks.z - r.first.z, SK_BIN_SIDE / 4u);
    return r;
}

/** The records of a bin's blocks will be needed soon: those of a row are a line of a cache. */
SK_FUNCTION void sk_await_blocks(sk_dims dims, sk_bin_blocks own, SK_GLOBAL const sk_block* blocks) {
#if SK_WIDTH > 1
    for (sk_u32 z = 0u; z < own.count.z; ++z)
        for (sk_u32 y = 0u; y < own.count.y; ++y)
            sk_prefetch(blocks + sk_number_at(dims, own.first.x, own.first.y + y, own.first.z + z));
#endif
}

#if SK_WIDTH > 1

/** Bit 4 k of each lane is bit from + k of `of`, for k = 0 to 7. */
SK_FUNCTION sk_iN sk_spread_bits(sk_iN of, const sk_u32 from) {
    sk_iN r = of >> from & 0xff;
    r = (r | r << 12) & 0x000f000f;
    r = (r | r << 6) & 0x03030303;
    return (r | r << 3) & 0x11111111;
}

/** What four lanes have together, in each of them: all bits, or the sum. */
#define SK_NEXT_LANES(k) (k) + 1, (k) + 2, (k) + 3, (k)
#define SK_OTHER_LANES(k) (k) + 2, (k) + 3, (k), (k) + 1
SK_FUNCTION sk_iN sk_bits_of_four(sk_iN a) {
    const sk_iN r = a | sk_shuffle(a, a, SK_EACH_FOUR(SK_NEXT_LANES));
    return r | sk_shuffle(r, r, SK_EACH_FOUR(SK_OTHER_LANES));
}
SK_FUNCTION sk_iN sk_sum_of_four(sk_iN a) {
    const sk_iN r = a + sk_shuffle(a, a, SK_EACH_FOUR(SK_NEXT_LANES));
    return r + sk_shuffle(r, r, SK_EACH_FOUR(SK_OTHER_LANES));
}

/** Bits 0, 4, 8 and 12, which others are not beside, as bits 0 to 3: the product has each of them four times, and bits 12 to 15 one of each. */
SK_FUNCTION sk_u32 sk_every_fourth(sk_u32 bits) { return (bits & 0x1111u) * 0x1248u >> 12 & 15u; }

/** The records of blocks beside each other, a cell along x in each lane, as words of sk_block; bits of lanes whose block is not empty; the longest lists. */
typedef struct sk_counted_lanes {
    sk_iN words, longest;
    sk_u32 filled;
} sk_counted_lanes;

/** From the counters of the first lane's first cell on, each below 2^31 as all pairs of a bin are together. */
SK_FUNCTION sk_counted_lanes sk_count_lanes(SK_GLOBAL const sk_u32* counters) {
    const sk_iN in_block = sk_lane_numbers() & 3;
    sk_iN rows = sk_same_i(0), pairs = sk_same_i(0), low, high;
    sk_counted_lanes r;
    r.longest = sk_same_i(0);
    for (sk_u32 row = 0u; row < SK_BLOCK_CELLS / 4u; ++row) {
        const sk_iN counts = sk_load_i((SK_GLOBAL const sk_i32*)(counters + SK_BIN_SIDE * ((row & 3u) + SK_BIN_SIDE * (row >> 2))));
        rows |= (counts != 0) & (sk_i32)(1u << row);
        pairs += counts;
        r.longest = sk_max_i(r.longest, counts);
    }
    low = sk_bits_of_four(sk_spread_bits(rows, 0u) << in_block);
    high = sk_bits_of_four(sk_spread_bits(rows, 8u) << in_block);
    pairs = sk_sum_of_four(pairs);
    r.filled = sk_lane_bits(pairs != 0);
    r.words = sk_select_i(in_block == 0, low, sk_select_i(in_block == 1, high, (in_block == 3) & pairs));
    return r;
}

/** Whether there is room for the counts of a bin. A work-item that was refused asks no more, so that what all have asked for stays a number. */
SK_FUNCTION int sk_has_kept_room(sk_kept_room* own, sk_kept_counts kept, SK_GLOBAL sk_u32* report) {
    if (own->next == SK_NOT_KEPT) return 0;
    if (own->end - own->next < SK_BIN_BLOCKS) {
        const sk_u32 first = sk_atomic_add(report + SK_TOTAL_KEPT, kept.chunk);
        if (first != own->end) own->next = first;
        own->end = first + kept.chunk;
        if (own->end > kept.room) own->next = SK_NOT_KEPT;
    }
    return own->next != SK_NOT_KEPT;
}

/**
 * Keeps the counts of those of a row of blocks that are not empty, from place `next` on; the next place. Empty ones are written too, and then over: a bin
 * that has some does not fill its room.
 */
SK_FUNCTION sk_u32 sk_keep_lanes(SK_GLOBAL const sk_u32* counters, sk_u32 filled, SK_GLOBAL sk_u32* words, sk_u32 next) {
    const sk_iN in_block = sk_lane_numbers() & 3;
    const sk_u32 blocks = sk_every_fourth(filled);
    size_t places[SK_WIDTH / 4u];
    for (sk_u32 b = 0u; b < SK_WIDTH / 4u; ++b) {
        places[b] = (size_t)next * SK_KEPT_WORDS;
        next += blocks >> b & 1u;
    }
    for (sk_u32 z = 0u; z < 4u; ++z) {
        sk_iN rows = sk_same_i(0); /* four words a block */
        for (sk_u32 y = 0u; y < 4u; ++y) {
            const sk_iN counts = sk_load_i((SK_GLOBAL const sk_i32*)(counters + SK_BIN_SIDE * (y + SK_BIN_SIDE * z)));
            rows = sk_select_i(in_block == (sk_i32)y, sk_bits_of_four(counts << in_block * 8), rows);
        }
#define SK_STORE_BLOCK(k) sk_store_i4(sk_shuffle(rows, rows, (k), (k) + 1, (k) + 2, (k) + 3), (SK_GLOBAL sk_i32*)(words + (places[(k) / 4] + 4u * z)))
        SK_EACH_FOUR(SK_STORE_BLOCK);
#undef SK_STORE_BLOCK
    }
    return next;
}

/** The records of a bin's blocks as sk_count_block() makes them, and which of them are not empty; how long the longest list is. */
SK_FUNCTION sk_u32 sk_count_bin(sk_u32 bin, SetkaGridHeader grid, sk_binned all, SK_GLOBAL sk_u32* counters, SK_GLOBAL sk_block* counted,
                                SK_GLOBAL sk_u64* filled, sk_kept_counts kept, sk_kept_room* own_room, SK_GLOBAL sk_u32* report) {
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid));
    const sk_bin_blocks own = sk_blocks_of_bin(dims, sk_bin_dims(sk_cell_dims(grid)), bin);
    sk_u32 lengths[SK_WIDTH], longest = 0u;
    sk_counted_lanes of_four;
    sk_iN longest_lists = sk_same_i(0);
    sk_u64 own_filled = 0u;
    of_four.words = sk_same_i(0);
    of_four.filled = 0u;
    const sk_u32 pairs = sk_count_in_bin(all, bin, counters);
    const int keeps = pairs != 0u && sk_has_kept_room(own_room, kept, report);
    const sk_u32 start = keeps ? own_room->next : pairs != 0u ? SK_NOT_KEPT : 0u;
    for (sk_u32 z = 0u; z < own.count.z; ++z)
        for (sk_u32 y = 0u; y < own.count.y; ++y)
            for (sk_u32 x = 0u; x < own.count.x; x += SK_WIDTH / 4u) {
                const sk_u32 b = sk_number_at(dims, own.first.x + x, own.first.y + y, own.first.z + z);
                const sk_u32 blocks = sk_min_u32(own.count.x - x, SK_WIDTH / 4u);
                if (pairs != 0u) {
                    SK_GLOBAL const sk_u32* first = counters + sk_cell_in_bin(4u * x, 4u * y, 4u * z);
                    of_four = sk_count_lanes(first);
                    longest_lists = sk_max_i(longest_lists, of_four.longest);
                    if (keeps && of_four.filled != 0u) own_room->next = sk_keep_lanes(first, of_four.filled, kept.words, own_room->next);
                }
                own_filled |= (sk_u64)sk_every_fourth(of_four.filled) << sk_bit_in_block(x, y, z);
                if (blocks == SK_WIDTH / 4u) {
                    sk_store_i(of_four.words, (SK_GLOBAL sk_i32*)(counted + b));
                } else {
                    sk_u32 words[SK_WIDTH];
                    sk_store_lanes(of_four.words, words);
                    for (sk_u32 k = 0u; k < 4u * blocks; ++k) ((SK_GLOBAL sk_u32*)(counted + b))[k] = words[k];
                }
            }
    filled[bin] = own_filled;
    sk_store_lanes(longest_lists, lengths);
    for (sk_u32 k = 0u; k < SK_WIDTH; ++k) longest = sk_max_u32(longest, lengths[k]);
    kept.starts[bin] = longest <= SK_KEPT_MOST ? start : SK_NOT_KEPT;
    return longest;
}

#else

/** What the counters of a block say, from that of its first cell on. */
SK_FUNCTION sk_tally sk_tally_in_bin(SK_GLOBAL const sk_u32* counters) {
    sk_tally r = sk_no_tally();
    for (sk_u32 row = 0u; row < SK_BLOCK_CELLS / 4u; ++row)
        r = sk_tally_row(r, row, *(SK_GLOBAL const sk_four_counts*)(counters + SK_BIN_SIDE * ((row & 3u) + SK_BIN_SIDE * (row >> 2))));
    return r;
}

/** The records of a bin's blocks as sk_count_block() makes them, and which of them are not empty; how long the longest list is. */
SK_FUNCTION sk_u32 sk_count_bin(sk_u32 bin, SetkaGridHeader grid, sk_binned all, SK_GLOBAL sk_u32* counters, SK_GLOBAL sk_block* counted,
                                SK_GLOBAL sk_u64* filled, sk_kept_counts kept, sk_kept_room* own_room, SK_GLOBAL sk_u32* report) {
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid));
    const sk_bin_blocks own = sk_blocks_of_bin(dims, sk_bin_dims(sk_cell_dims(grid)), bin);
    sk_u64 own_filled = 0u;
    sk_u32 longest = 0u;
    const sk_u32 pairs = sk_count_in_bin(all, bin, counters);
    for (sk_u32 z = 0u; z < own.count.z; ++z)
        for (sk_u32 y = 0u; y < own.count.y; ++y)
            for (sk_u32 x = 0u; x < own.count.x; ++x) {
                const sk_u32 b = sk_number_at(dims, own.first.x + x, own.first.y + y, own.first.z + z);
                sk_tally tally = sk_no_tally();
                if (pairs != 0u) tally = sk_tally_in_bin(counters + sk_cell_in_bin(4u * x, 4u * y, 4u * z));
                if (tally.mask != 0u) own_filled |= (sk_u64)1 << sk_bit_in_block(x, y, z);
                longest = sk_max_u32(longest, tally.longest);
                counted[b] = sk_counted_block(tally);
            }
    filled[bin] = own_filled;
    kept.starts[bin] = SK_NOT_KEPT; /* only lanes keep counts */
    (void)own_room, (void)report;
    return longest;
}

#endif

/**
 * The same for the bins that the work-item gets, of n groups of `together` bins, whose bounds lie beside each other. Of `blocks` records, those that the
 * grid has no block for are empty ones, or all if not all pairs are in bins or the grid has more blocks: each group has its share of them.
 */
SK_FUNCTION void sk_tally_bins(sk_u32 n, sk_u32 before, sk_u32 most, sk_u32 together, sk_u32 capacity, sk_u32 most_units, sk_u32 blocks, SetkaGridHeader grid,
                               sk_binned all, SK_GLOBAL sk_u32* counters, SK_GLOBAL sk_block* counted, SK_GLOBAL sk_u64* filled,
                               sk_kept_counts kept, SK_GLOBAL sk_u32* report) {
    const sk_u32 blocks_of_grid = sk_block_count(sk_block_dims(sk_cell_dims(grid)));
    const sk_u32 bins_of_grid = sk_block_count(sk_bin_dims(sk_cell_dims(grid)));
    const sk_u32 groups = (all.bins + together - 1u) / together, share = (blocks + groups - 1u) / groups;
    const int has_all = sk_is_binned(report, capacity, most_units) && blocks_of_grid <= blocks;
    const sk_u32 bins = has_all ? sk_min_u32(bins_of_grid, all.bins) : 0u, of_grid = has_all ? blocks_of_grid : 0u;
    sk_u32 longest = 0u;
    sk_kept_room own_room;
    own_room.next = own_room.end = 0u;
    for (sk_u32 k = 0u; k < most; ++k) {
        const sk_u32 group = sk_take_next(report, before);
        if (group >= n) break;
        for (sk_u32 b = group * together; b < sk_min_u32(group * together + together, bins); ++b) {
            const sk_u32 longest_of_bin = sk_count_bin(b, grid, all, counters, counted, filled, kept, &own_room, report);
            longest = sk_max_u32(longest, longest_of_bin);
        }
        for (sk_u32 b = sk_max_u32(group * share, of_grid); b < sk_min_u32(group * share + share, blocks); ++b)
            counted[b] = sk_counted_block(sk_no_tally());
    }
    if (longest > SK_LONG_LIST) (void)sk_atomic_max(report + SK_TOTAL_LONGEST, longest);
}

/** Blocks of a bin, by sk_bit_in_block(), that have a block that is not empty up to 1, 2 and 3 blocks away. */
typedef struct sk_rings {
    sk_u64 near1, near2, near3;
} sk_rings;

/** Of 4 x 4 x 4, those that lie less than `count` from the corner along the axis of that stride: 1, 4 or 16. */
SK_FUNCTION sk_u64 sk_near(sk_u32 stride, sk_u32 count) {
    return stride == 1u ? sk_near_x(count) : stride == 4u ? sk_near_y(count) : sk_near_z(count);
}

/** What is up to `around` away from `own` along an axis, on which another bin lies before it and another behind it. */
SK_FUNCTION sk_u64 sk_widen_blocks(sk_u64 before, sk_u64 own, sk_u64 after, const sk_u32 stride, const sk_u32 around) {
    sk_u64 some = own;
    for (sk_u32 d = 1u; d <= around; ++d) {
        const sk_u64 near = sk_near(stride, d), far = ~sk_near(stride, 4u - d);
        some |= (own << stride * d & ~near) | (before >> stride * (4u - d) & near);
        some |= (own >> stride * d & ~far) | (after << stride * (4u - d) & far);
    }
    return some;
}
SK_FUNCTION sk_rings sk_widen_rings(sk_rings before, sk_rings own, sk_rings after, const sk_u32 stride) {
    sk_rings r;
    r.near1 = sk_widen_blocks(before.near1, own.near1, after.near1, stride, 1u);
    r.near2 = sk_widen_blocks(before.near2, own.near2, after.near2, stride, 2u);
    r.near3 = sk_widen_blocks(before.near3, own.near3, after.near3, stride, 3u);
    return r;
}

/** What is filled of a bin, which may lie outside. */
SK_FUNCTION sk_rings sk_filled_at(sk_dims bins, sk_u32 x, sk_u32 y, sk_u32 z, SK_GLOBAL const sk_u64* filled) {
    sk_rings r;
    r.near1 = x < bins.x && y < bins.y && z < bins.z ? filled[sk_number_at(bins, x, y, z)] : 0u;
    r.near2 = r.near3 = r.near1;
    return r;
}

/** A bin is as many blocks wide as is looked around an empty one, and one more: its neighbours are all that counts. */
SK_FUNCTION sk_rings sk_rings_of(sk_dims bins, sk_u32 bin, SK_GLOBAL const sk_u64* filled) {
    const sk_u32 x = bin % bins.x, y = bin / bins.x % bins.y, z = bin / bins.x / bins.y;
    sk_rings layers[3];
    for (sk_u32 k = 0u; k < 3u; ++k) {
        sk_rings rows[3];
        for (sk_u32 j = 0u; j < 3u; ++j)
            rows[j] = sk_widen_rings(sk_filled_at(bins, x - 1u, y + j - 1u, z + k - 1u, filled),
                                     sk_filled_at(bins, x, y + j - 1u, z + k - 1u, filled),
                                     sk_filled_at(bins, x + 1u, y + j - 1u, z + k - 1u, filled), 1u);
        layers[k] = sk_widen_rings(rows[0], rows[1], rows[2], 4u);
    }
    return sk_widen_rings(layers[0], layers[1], layers[2], 16u);
}

/** The clearance of an empty block, as sk_find_clearance() says. */
SK_FUNCTION sk_u32 sk_clearance_in(sk_rings rings, sk_u32 bit) {
    return 15u - 4u * (sk_u32)((rings.near1 >> bit & 1u) + (rings.near2 >> bit & 1u) + (rings.near3 >> bit & 1u));
}

/** The lists of a bin: records of blocks and cells, and references. */
SK_FUNCTION void sk_place_bin(sk_u32 bin, SetkaGridHeader grid, sk_binned all, SK_GLOBAL sk_u32* counters,
                              SK_GLOBAL const sk_block* counted, SK_GLOBAL const sk_u64* filled, sk_kept_counts kept, SK_GLOBAL sk_block* blocks,
                              SK_GLOBAL sk_cell_list* lists, SK_GLOBAL sk_u32* references) {
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid)), bin_dims = sk_bin_dims(sk_cell_dims(grid));
    const sk_bin_blocks own = sk_blocks_of_bin(dims, bin_dims, bin);
    const sk_rings rings = sk_rings_of(bin_dims, bin, filled);
    sk_await_blocks(dims, own, counted);
    sk_await_blocks(dims, own, blocks);
    const sk_u32 start = kept.starts[bin], runs = filled[bin] != 0u ? all.runs : 0u;
    const int is_kept = kept.words != (SK_GLOBAL sk_u32*)0 && start != SK_NOT_KEPT;
    sk_u32 place_kept = start;
    if (!is_kept) (void)sk_count_in_bin(all, bin, counters);
    for (sk_u32 z = 0u; z < own.count.z; ++z)
        for (sk_u32 y = 0u; y < own.count.y; ++y)
            for (sk_u32 x = 0u; x < own.count.x; ++x) {
                const sk_u32 b = sk_number_at(dims, own.first.x + x, own.first.y + y, own.first.z + z);
                const sk_u32 corner = sk_cell_in_bin(4u * x, 4u * y, 4u * z);
                sk_block block = counted[b];
                sk_u32 r = block.first;
                sk_cell_list list;
                list.offset = block.clearance;
                for (sk_u64 rest = sk_mask_of(block); rest != 0u; rest &= rest - 1u) {
                    const sk_u32 bit = sk_lowest_bit(rest);
                    SK_GLOBAL sk_u32* counter = counters + (corner + sk_bin_step(bit));
                    list.count = is_kept ? sk_kept_count(kept, place_kept, bit) : *counter;
                    *counter = list.offset;
                    lists[r] = list;
                    list.offset += list.count;
                    r += 1u;
                }
                place_kept += sk_mask_of(block) != 0u ? 1u : 0u;
#if SK_WIDTH > 1
                for (sk_u32 place = block.clearance; place < list.offset; place += 16u) sk_prefetch(references + place);
#endif
                block.clearance = sk_mask_of(block) != 0u ? 0u : sk_clearance_in(rings, sk_bit_in_block(x, y, z));
                blocks[b] = block;
            }
    for (sk_u32 r = 0u; r < runs; ++r) {
        SK_GLOBAL const sk_u32* bounds = sk_bounds_in_bin(all, r, bin);
        const sk_u32 end = bounds[1], before = r * all.length;
        if (is_kept) sk_await_pairs(all, r + 1u, bin);
        for (sk_u32 p = bounds[0]; p < end; ++p) {
            SK_GLOBAL sk_u32* counter = counters + sk_cell_of_pair(all.pairs[p]);
            const sk_u32 place = *counter;
            *counter = place + 1u;
            references[place] = before + sk_triangle_of_pair(all.pairs[p]);
        }
    }
}

/** The same for the bins that the work-item gets, of n groups of `together` bins. */
SK_FUNCTION void sk_place_bins(sk_u32 n, sk_u32 before, sk_u32 most, sk_u32 together, SetkaGridHeader grid, sk_binned all, SK_GLOBAL sk_u32* counters,
                               SK_GLOBAL const sk_block* counted, SK_GLOBAL const sk_u64* filled, sk_kept_counts kept, SK_GLOBAL sk_block* blocks,
                               SK_GLOBAL sk_cell_list* lists, SK_GLOBAL sk_u32* references, SK_GLOBAL sk_u32* report) {
    const sk_u32 bins = sk_block_count(sk_bin_dims(sk_cell_dims(grid)));
    for (sk_u32 k = 0u; k < most; ++k) {
        const sk_u32 group = sk_take_next(report, before);
        if (group >= n) break;
        for (sk_u32 b = group * together; b < sk_min_u32(group * together + together, bins); ++b)
            sk_place_bin(b, grid, all, counters, counted, filled, kept, blocks, lists, references);
    }
}

#endif
