/* SPDX-License-Identifier: MIT */
/**
 * How do lists come about without sorting and without an atomic operation for each pair, where few work-items run at a time? Cells come in bins of
 * 16 x 16 x 16. Each work-item takes a run of triangles and writes its pairs (cell, triangle) bin by bin (bin_runs.h); a bin is one work-item's then, whose
 * counters fit the nearest cache and are nobody else's. It takes its pairs from one run after the other, in which they follow the triangles, so that
 * every list comes out in ascending order. Tallying counts them for the records of blocks; when the host knows the sizes, placing makes the lists.
 */
#ifndef SETKA_DEVICE_GRID_BINS_H
#define SETKA_DEVICE_GRID_BINS_H

#include "device/grid/bin_runs.h"

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
