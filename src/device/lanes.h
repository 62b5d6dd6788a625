/* SPDX-License-Identifier: MIT */
/**
 * How do kernels calculate with SK_WIDTH numbers side by side? One in each lane of a vector, with the
 * operations of math.h, which round in a lane as they do alone. A mask has all bits of a lane set, or none.
 * Only where SK_WIDTH is 8: a work-item of a CPU.
 */
#ifndef SETKA_DEVICE_LANES_H
#define SETKA_DEVICE_LANES_H

#include "device/math.h"

typedef struct sk_vec3N {
    sk_fN x, y, z;
} sk_vec3N;

SK_FUNCTION sk_fN sk_same_f(float a) { return sk_make_f(a, a, a, a, a, a, a, a); }
SK_FUNCTION sk_iN sk_same_i(sk_i32 a) { return sk_make_i(a, a, a, a, a, a, a, a); }

/** Where the mask is set a, else b. */
SK_FUNCTION sk_fN sk_select_f(sk_iN mask, sk_fN a, sk_fN b) { return mask ? a : b; }
SK_FUNCTION sk_iN sk_select_i(sk_iN mask, sk_iN a, sk_iN b) { return mask ? a : b; }

SK_FUNCTION sk_fN sk_min_f(sk_fN a, sk_fN b) { return sk_select_f(b < a, b, a); }
SK_FUNCTION sk_fN sk_max_f(sk_fN a, sk_fN b) { return sk_select_f(a < b, b, a); }
SK_FUNCTION sk_iN sk_min_i(sk_iN a, sk_iN b) { return sk_select_i(b < a, b, a); }
SK_FUNCTION sk_iN sk_max_i(sk_iN a, sk_iN b) { return sk_select_i(a < b, b, a); }
SK_FUNCTION sk_fN sk_abs_f(sk_fN a) { return sk_lanes_as_float(sk_lanes_as_int(a) & 0x7fffffff); }
SK_FUNCTION sk_fN sk_positive_zero_f(sk_fN a) {
    return sk_select_f((sk_lanes_as_int(a) & 0x7fffffff) == sk_same_i(0), sk_same_f(0.0f), a);
}
SK_FUNCTION sk_iN sk_finite_f(sk_fN a) { return (sk_lanes_as_int(a) & 0x7f800000) != sk_same_i(0x7f800000); }

/** Bit k: the mask is set in lane k. */
SK_FUNCTION sk_u32 sk_lane_bits(sk_iN mask) {
    return (sk_u32)sk_lanes_or(mask & sk_make_i(1, 2, 4, 8, 16, 32, 64, 128));
}

/** The number of the lowest bit of each lane that has one. */
SK_FUNCTION sk_iN sk_lowest_bits(sk_iN bits) {
    return (sk_lanes_as_int(sk_lanes_to_float(bits & -bits)) >> 23 & 0xff) -
           127; /* -2^31 too, but for its sign */
}

/** True if the mask is set in any lane. */
SK_FUNCTION int sk_any_lane(sk_iN mask) { return sk_lanes_or(mask) != 0; }

SK_FUNCTION sk_vec3N sk_make3_f(sk_fN x, sk_fN y, sk_fN z) {
    sk_vec3N r;
    r.x = x;
    r.y = y;
    r.z = z;
    return r;
}

/** f(0) to f(SK_WIDTH - 1), one a lane. */
#define SK_FLOATS(f) sk_make_f(f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7))
#define SK_INTS(f) sk_make_i(f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7))

/** base[at * stride] of each lane; `at` is a u32. */
SK_FUNCTION sk_fN sk_gather_f(SK_GLOBAL const float* base, sk_iN at, sk_u32 stride) {
#define SK_AT(k) base[(size_t)(sk_u32)sk_lane(at, k) * stride]
    return SK_FLOATS(SK_AT);
}
SK_FUNCTION sk_iN sk_gather_i(SK_GLOBAL const sk_u32* base, sk_iN at, sk_u32 stride) {
#define SK_INT_AT(k) (sk_i32) SK_AT(k)
    return SK_INTS(SK_INT_AT);
#undef SK_INT_AT
#undef SK_AT
}

/** Four numbers of each lane. */
typedef struct sk_columns {
    sk_fN a, b, c, d;
} sk_columns;

/** Four numbers from base[at * stride] on of each lane: a load of four for each, then a transposition. */
SK_FUNCTION sk_columns sk_gather4(SK_GLOBAL const float* base, sk_iN at, sk_u32 stride) {
#define SK_ROW(k) sk_load_f4(base + (size_t)(sk_u32)sk_lane(at, k) * stride)
    const sk_f4 r0 = SK_ROW(0), r1 = SK_ROW(1), r2 = SK_ROW(2), r3 = SK_ROW(3);
    const sk_f4 r4 = SK_ROW(4), r5 = SK_ROW(5), r6 = SK_ROW(6), r7 = SK_ROW(7);
#undef SK_ROW
    const sk_fN s0 = sk_shuffle(r0, r4, 0, 1, 2, 3, 4, 5, 6, 7),
                s1 = sk_shuffle(r1, r5, 0, 1, 2, 3, 4, 5, 6, 7);
    const sk_fN s2 = sk_shuffle(r2, r6, 0, 1, 2, 3, 4, 5, 6, 7),
                s3 = sk_shuffle(r3, r7, 0, 1, 2, 3, 4, 5, 6, 7);
    const sk_fN low01 = sk_shuffle(s0, s1, 0, 8, 1, 9, 4, 12, 5, 13),
                high01 = sk_shuffle(s0, s1, 2, 10, 3, 11, 6, 14, 7, 15);
    const sk_fN low23 = sk_shuffle(s2, s3, 0, 8, 1, 9, 4, 12, 5, 13),
                high23 = sk_shuffle(s2, s3, 2, 10, 3, 11, 6, 14, 7, 15);
    sk_columns r;
    r.a = sk_shuffle(low01, low23, 0, 1, 8, 9, 4, 5, 12, 13);
    r.b = sk_shuffle(low01, low23, 2, 3, 10, 11, 6, 7, 14, 15);
    r.c = sk_shuffle(high01, high23, 0, 1, 8, 9, 4, 5, 12, 13);
    r.d = sk_shuffle(high01, high23, 2, 3, 10, 11, 6, 7, 14, 15);
    return r;
}

#endif
