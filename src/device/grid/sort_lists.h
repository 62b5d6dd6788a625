/* SPDX-License-Identifier: MIT */
/**
 * How does a list that was filled in any order become ascending? Short ones are a work-item's each. Longer ones are cut into pieces
 * of 64 numbers: each number finds its place in its piece by counting the smaller ones, then its place in ever longer runs by searching
 * the run beside its own. Numbers of a list are all different, so places are too. What is long depends on the device: a list
 * of 64 keeps a GPU waiting, one of hundreds is nothing to a CPU.
 */
#ifndef SETKA_DEVICE_GRID_SORT_LISTS_H
#define SETKA_DEVICE_GRID_SORT_LISTS_H

#include "device/grid/blocks.h"
#include "device/grid/limits.h"
#include "device/math.h"

/** A list that is cut into pieces: piece p of the scratch holds its numbers from (p - first) * SK_PIECE on. */
typedef struct SK_ALIGNED(16) sk_piece {
    sk_u32 offset, count; /* the list */
    sk_u32 first;         /* its first piece */
    sk_u32 spare;
} sk_piece;

SK_FUNCTION sk_u32 sk_piece_count(sk_u32 count) { return (count + SK_PIECE - 1u) / SK_PIECE; }

/** Shell's sort with the gaps of Gonnet & Baeza-Yates (1991): few steps where most numbers are in order already. */
SK_FUNCTION void sk_sort_numbers(SK_GLOBAL sk_u32* list, sk_u32 count) {
    sk_u32 gap = count <= 12u ? 1u : count * 5u / 11u;
    while (gap != 0u) {
        for (sk_u32 k = gap; k < count; ++k) {
            const sk_u32 number = list[k];
            sk_u32 place = k;
            while (place >= gap && list[place - gap] > number) {
                list[place] = list[place - gap];
                place -= gap;
            }
            if (place != k) list[place] = number;
        }
        gap = gap == 1u ? 0u : sk_max_u32(gap * 5u / 11u, 1u);
    }
}

#if SK_TEAM > 1

/** The most numbers that a work-item holds in registers. */
#define SK_HELD 16u

/** A list of up to SK_HELD numbers: each goes where as many are smaller. Nothing waits for memory but the loads and the stores. */
SK_FUNCTION void sk_rank_numbers(SK_GLOBAL sk_u32* list, sk_u32 count) {
    sk_u32 numbers[SK_HELD], ranks[SK_HELD];
    for (sk_u32 k = 0u; k < SK_HELD; ++k) {
        numbers[k] = k < count ? list[k] : 0xffffffffu;
        ranks[k] = 0u;
    }
    for (sk_u32 k = 1u; k < SK_HELD; ++k)
        for (sk_u32 i = 0u; i < k; ++i) {
            const sk_u32 is_greater = numbers[i] > numbers[k] ? 1u : 0u;
            ranks[i] += is_greater;
            ranks[k] += 1u - is_greater;
        }
    for (sk_u32 k = 0u; k < SK_HELD; ++k)
        if (k < count) list[ranks[k]] = numbers[k];
}

SK_FUNCTION void sk_sort_short(SK_GLOBAL sk_u32* list, sk_u32 count) {
    if (count <= SK_HELD)
        sk_rank_numbers(list, count);
    else
        sk_sort_numbers(list, count);
}

#else

SK_FUNCTION void sk_sort_short(SK_GLOBAL sk_u32* list, sk_u32 count) { sk_sort_numbers(list, count); }

#endif

/** The list of record r, unless it is longer than `alone`. */
SK_FUNCTION void sk_sort_list(sk_u32 r, sk_u32 alone, SK_GLOBAL const sk_cell_list* cells,
                              SK_GLOBAL sk_u32* references) {
    const sk_cell_list list = cells[r];
    if (list.count <= alone) sk_sort_short(references + list.offset, list.count);
}

/** Number e of the scratch, from the unsorted list to its place in its piece. */
SK_FUNCTION void sk_rank_in_piece(sk_u32 e, SK_GLOBAL const sk_piece* pieces, SK_GLOBAL const sk_u32* references,
                                  SK_GLOBAL sk_u32* scratch) {
    const sk_piece piece = pieces[e / SK_PIECE];
    const sk_u32 start = (e / SK_PIECE - piece.first) * SK_PIECE, size = sk_min_u32(piece.count - start, SK_PIECE);
    const sk_u32 own = e % SK_PIECE;
    SK_GLOBAL const sk_u32* numbers = references + piece.offset + start;
    if (own < size) {
        const sk_u32 number = numbers[own];
        sk_u32 rank = 0u;
        for (sk_u32 k = 0u; k < size; ++k) rank += numbers[k] < number ? 1u : 0u;
        scratch[(size_t)(e - own) + rank] = number;
    }
}

/**
 * Number e of the scratch, from a sorted run of `width` numbers of its list to its place in the run of twice that; with `is_last` into
 * the list itself, of which that is all.
 */
SK_FUNCTION void sk_merge_runs(sk_u32 e, sk_u32 width, sk_u32 is_last, SK_GLOBAL const sk_piece* pieces,
                               SK_GLOBAL const sk_u32* from, SK_GLOBAL sk_u32* to, SK_GLOBAL sk_u32* references) {
    const sk_piece piece = pieces[e / SK_PIECE];
    const sk_u32 base = piece.first * SK_PIECE, at = e - base;
    if (at < piece.count) {
        const sk_u32 own_start = at / width * width, other_start = own_start ^ width, start = own_start & ~width;
        const sk_u32 other_count =
            other_start < piece.count ? sk_min_u32(piece.count - other_start, width) : 0u;
        const sk_u32 number = from[e];
        const sk_u32 place =
            start + (at - own_start) + sk_lower_bound(from + (size_t)base + other_start, other_count, number);
        if (is_last)
            references[piece.offset + place] = number;
        else
            to[(size_t)base + place] = number;
    }
}

#endif
