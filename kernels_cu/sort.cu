/* SPDX-License-Identifier: MIT */
/** Entries of the stable radix sort; the bodies are in src/device/sort.h. */
#include "platform.h"

#include "device/sort.h"

SK_KERNEL void sort_count(sk_u32 n, sk_u32 elements, sk_u32 shift, sk_u32 digits, sk_u32 groups,
                          SK_GLOBAL const sk_u32* keys, SK_GLOBAL sk_u32* histogram) {
    SK_LOCAL_STORAGE sk_u32 counters[SK_SORT_COUNTERS];
    sk_sort_count(counters, n, elements, shift, digits, groups, keys, histogram);
}

SK_KERNEL void sort_scatter(sk_u32 n, sk_u32 elements, sk_u32 shift, sk_u32 digits, sk_u32 groups,
                            SK_GLOBAL const sk_u32* keys, SK_GLOBAL const sk_u32* values,
                            SK_GLOBAL const sk_u32* starts, SK_GLOBAL sk_u32* sorted_keys,
                            SK_GLOBAL sk_u32* sorted_values) {
    SK_LOCAL_STORAGE sk_u32 counters[SK_SORT_COUNTERS];
    sk_sort_scatter(counters, n, elements, shift, digits, groups, keys, values, starts, sorted_keys, sorted_values);
}
