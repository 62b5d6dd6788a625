/* SPDX-License-Identifier: MIT */
/**
 * Where does the scene end? Minimum and maximum over all vertices, group by group until one is left (Maltsev & Mikhaylyuk
 * 2012, section 2.1). Floats travel as unsigned integers of the same order, whose minimum has one answer in any order.
 */
#ifndef SETKA_DEVICE_REDUCE_H
#define SETKA_DEVICE_REDUCE_H

#include "device/dialect.h"
#include "device/math.h"
#include "device/scan.h"

/** Three minima and three maxima. */
#define SK_BOUNDS_VALUES 6u

/** An unsigned integer that orders as the float does; -0 comes just before 0. */
SK_FUNCTION sk_u32 sk_ordered(float f) {
    const sk_u32 bits = sk_float_bits(f);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

/** Combines the six values of each work-item into partials[6 * group ..]. */
SK_FUNCTION void sk_combine_bounds(SK_LOCAL sk_u32* scratch, SK_GLOBAL sk_u32* partials) {
    const sk_u32 size = sk_local_size();
    SK_BARRIER();
    for (sk_u32 v = sk_local_id(); v < SK_BOUNDS_VALUES; v += size) {
        sk_u32 best = scratch[v * SK_MAX_GROUP];
        for (sk_u32 k = 1u; k < size; ++k) {
            const sk_u32 other = scratch[v * SK_MAX_GROUP + k];
            best = v < 3u ? sk_min_u32(best, other) : sk_max_u32(best, other);
        }
        partials[sk_group_id() * SK_BOUNDS_VALUES + v] = best;
    }
}

/** First pass: over triangles of nine floats. */
SK_FUNCTION void sk_reduce_bounds(SK_LOCAL sk_u32* scratch, sk_u32 n, sk_u32 elements,
                                  SK_GLOBAL const float* triangles, SK_GLOBAL sk_u32* partials) {
    const sk_u32 item = sk_local_id();
    const sk_u64 first = (sk_u64)sk_global_id() * elements;
    sk_u32 lower[3] = {0xffffffffu, 0xffffffffu, 0xffffffffu};
    sk_u32 upper[3] = {0u, 0u, 0u};
    for (sk_u32 k = 0u; k < elements; ++k)
        if (first + k < n)
            for (sk_u32 c = 0u; c < 9u; ++c) {
                const sk_u32 value = sk_ordered(triangles[(first + k) * 9u + c]);
                lower[c % 3u] = sk_min_u32(lower[c % 3u], value);
                upper[c % 3u] = sk_max_u32(upper[c % 3u], value);
            }
    for (sk_u32 axis = 0u; axis < 3u; ++axis) {
        scratch[axis * SK_MAX_GROUP + item] = lower[axis];
        scratch[(axis + 3u) * SK_MAX_GROUP + item] = upper[axis];
    }
    sk_combine_bounds(scratch, partials);
}

/** Later passes: over the partial results of the pass before. */
SK_FUNCTION void sk_reduce_bounds_partial(SK_LOCAL sk_u32* scratch, sk_u32 n, sk_u32 elements,
                                          SK_GLOBAL const sk_u32* sources, SK_GLOBAL sk_u32* partials) {
    const sk_u32 item = sk_local_id();
    const sk_u64 first = (sk_u64)sk_global_id() * elements;
    for (sk_u32 v = 0u; v < SK_BOUNDS_VALUES; ++v) {
        sk_u32 best = v < 3u ? 0xffffffffu : 0u;
        for (sk_u32 k = 0u; k < elements; ++k)
            if (first + k < n) {
                const sk_u32 other = sources[(first + k) * SK_BOUNDS_VALUES + v];
                best = v < 3u ? sk_min_u32(best, other) : sk_max_u32(best, other);
            }
        scratch[v * SK_MAX_GROUP + item] = best;
    }
    sk_combine_bounds(scratch, partials);
}

#endif
