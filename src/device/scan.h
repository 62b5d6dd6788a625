/* SPDX-License-Identifier: MIT */
/**
 * What is the sum of everything before each element? Exclusive scan of u32 by reduce, scan of the block sums, and apply
 * (Ladner & Fischer 1980). A work-item owns E consecutive elements; group size and E are launch parameters that never change
 * the result. Block sums are 64-bit, so that the host sees a total that does not fit.
 */
#ifndef SETKA_DEVICE_SCAN_H
#define SETKA_DEVICE_SCAN_H

#include "device/dialect.h"
#include "device/math.h"

/** The most work-items in a group of a primitive. */
#define SK_MAX_GROUP 256u

/**
 * Sum of `value` over the work-items before this one; after the call scratch[*total_at] is the sum over the group. `scratch`
 * has two halves of SK_MAX_GROUP: each step reads one and writes the other, so that no barrier guards a value that is
 * overwritten behind it.
 */
SK_FUNCTION sk_u64 sk_group_scan(SK_LOCAL sk_u64* scratch, sk_u64 value, sk_u32* total_at) {
    const sk_u32 item = sk_local_id();
    const sk_u32 size = sk_local_size();
    sk_u32 side = 0u;
    scratch[item] = value;
    SK_BARRIER();
    for (sk_u32 distance = 1u; distance < size; distance *= 2u) {
        const sk_u64 before = item >= distance ? scratch[side + item - distance] : 0u;
        scratch[(SK_MAX_GROUP - side) + item] = scratch[side + item] + before;
        side = SK_MAX_GROUP - side;
        SK_BARRIER();
    }
    *total_at = side + size - 1u;
    return scratch[side + item] - value;
}

/** sums[group] = sum of the group's elements. */
SK_FUNCTION void sk_scan_reduce(SK_LOCAL sk_u64* scratch, sk_u32 n, sk_u32 elements, SK_GLOBAL const sk_u32* counts,
                                SK_GLOBAL sk_u64* sums) {
    const sk_u64 first = (sk_u64)sk_global_id() * elements;
    sk_u64 sum = 0u;
    sk_u32 total_at;
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) sum += counts[first + k];
    sk_group_scan(scratch, sum, &total_at);
    if (sk_local_id() == 0u) sums[sk_group_id()] = scratch[total_at];
}

/** One group: sums[i] becomes the sum of those before it, sums[n] the total. */
SK_FUNCTION void sk_scan_spine(SK_LOCAL sk_u64* scratch, sk_u32 n, sk_u32 elements, SK_GLOBAL sk_u64* sums) {
    const sk_u32 first = sk_local_id() * elements;
    sk_u64 sum = 0u, running;
    sk_u32 total_at;
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) sum += sums[first + k];
    running = sk_group_scan(scratch, sum, &total_at);
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) {
            const sk_u64 value = sums[first + k];
            sums[first + k] = running;
            running += value;
        }
    if (sk_local_id() == 0u) sums[n] = scratch[total_at];
}

/** offsets[i] = sum of counts before i, offsets[n] = total. */
SK_FUNCTION void sk_scan_apply(SK_LOCAL sk_u64* scratch, sk_u32 n, sk_u32 elements, sk_u32 groups,
                               SK_GLOBAL const sk_u32* counts, SK_GLOBAL const sk_u64* sums,
                               SK_GLOBAL sk_u32* offsets) {
    const sk_u64 first = (sk_u64)sk_global_id() * elements;
    sk_u64 sum = 0u, running;
    sk_u32 total_at;
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) sum += counts[first + k];
    running = sums[sk_group_id()] + sk_group_scan(scratch, sum, &total_at);
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n) {
            const sk_u32 value = counts[first + k];
            offsets[first + k] = (sk_u32)running;
            running += value;
        }
    if (sk_global_id() == 0u) offsets[n] = (sk_u32)sums[groups];
}

#endif
