/* SPDX-License-Identifier: MIT */
/**
 * How are pairs brought into the order of their keys without disturbing equal ones? One pass of a least-significant-digit
 * radix sort (Knuth, volume 3, section 5.2.5): count digits, scan, scatter. A work-item owns E consecutive pairs and one
 * column of counters in local memory, so the order within a digit is the order of the input.
 */
#ifndef SETKA_DEVICE_SORT_H
#define SETKA_DEVICE_SORT_H

#include "device/dialect.h"

/** Counters of a group: digits * group size must not exceed it. */
#define SK_SORT_COUNTERS 4096u

/** counters[digit * size + item] = this work-item's pairs with that digit. */
SK_FUNCTION void sk_sort_tally(SK_LOCAL sk_u32* counters, sk_u32 n, sk_u32 elements, sk_u32 shift, sk_u32 digits,
                               SK_GLOBAL const sk_u32* keys) {
    const sk_u32 item = sk_local_id();
    const sk_u32 size = sk_local_size();
    const sk_u64 first = (sk_u64)sk_global_id() * elements;
    for (sk_u32 d = 0u; d < digits; ++d) counters[d * size + item] = 0u;
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) counters[((keys[first + k] >> shift) & (digits - 1u)) * size + item] += 1u;
}

/** histogram[digit * groups + group] = the group's pairs with that digit. */
SK_FUNCTION void sk_sort_count(SK_LOCAL sk_u32* counters, sk_u32 n, sk_u32 elements, sk_u32 shift, sk_u32 digits,
                               sk_u32 groups, SK_GLOBAL const sk_u32* keys, SK_GLOBAL sk_u32* histogram) {
    const sk_u32 size = sk_local_size();
    sk_sort_tally(counters, n, elements, shift, digits, keys);
    SK_BARRIER();
    for (sk_u32 d = sk_local_id(); d < digits; d += size) {
        sk_u32 sum = 0u;
        for (sk_u32 k = 0u; k < size; ++k) sum += counters[d * size + k];
        histogram[d * groups + sk_group_id()] = sum;
    }
}

/** Moves each pair to its place; `starts` is the exclusive scan of the histogram. */
SK_FUNCTION void sk_sort_scatter(SK_LOCAL sk_u32* counters, sk_u32 n, sk_u32 elements, sk_u32 shift, sk_u32 digits,
                                 sk_u32 groups, SK_GLOBAL const sk_u32* keys, SK_GLOBAL const sk_u32* values,
                                 SK_GLOBAL const sk_u32* starts, SK_GLOBAL sk_u32* sorted_keys,
                                 SK_GLOBAL sk_u32* sorted_values) {
    const sk_u32 item = sk_local_id();
    const sk_u32 size = sk_local_size();
    const sk_u64 first = (sk_u64)sk_global_id() * elements;
    sk_sort_tally(counters, n, elements, shift, digits, keys);
    SK_BARRIER();
    for (sk_u32 d = item; d < digits; d += size) {
        sk_u32 place = starts[d * groups + sk_group_id()];
        for (sk_u32 k = 0u; k < size; ++k) {
            const sk_u32 count = counters[d * size + k];
            counters[d * size + k] = place;
            place += count;
        }
    }
    SK_BARRIER();
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) {
            const sk_u32 key = keys[first + k];
            const sk_u32 counter = ((key >> shift) & (digits - 1u)) * size + item;
            const sk_u32 place = counters[counter];
            counters[counter] = place + 1u;
            sorted_keys[place] = key;
            sorted_values[place] = values[first + k];
        }
}

#endif
