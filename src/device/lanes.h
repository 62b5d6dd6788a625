/* SPDX-License-Identifier: MIT */
/**
 * How do kernels calculate with SK_WIDTH numbers side by side? One in each lane of a vector, with the
 * operations of math.h, which round in a lane as they do alone. A mask has all bits of a lane set, or none.
 * Only where SK_WIDTH is 8 or 16: a work-item of a CPU.
 */
#ifndef SETKA_DEVICE_LANES_H
#define SETKA_DEVICE_LANES_H

#include "device/math.h"

typedef struct sk_vec3N {
    sk_fN x, y, z;
} sk_vec3N;

#if SK_WIDTH == 16u
#define SK_EACH_LANE(f) \
    f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7), f(8), f(9), f(10), f(11), f(12), f(13), f(14), f(15)
#else
#define SK_EACH_LANE(f) f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)
#endif

/** f(0) to f(SK_WIDTH - 1), one a lane. */
#define SK_FLOATS(f) sk_make_f(SK_EACH_LANE(f))
#define SK_INTS(f) sk_make_i(SK_EACH_LANE(f))

#define SK_A(k) a
SK_FUNCTION sk_fN sk_same_f(float a) { return SK_FLOATS(SK_A); }
SK_FUNCTION sk_iN sk_same_i(sk_i32 a) { return SK_INTS(SK_A); }
#undef SK_A

/** Each lane's own number. */
#define SK_LANE(k) (k)
SK_FUNCTION sk_iN sk_lane_numbers(void) { return SK_INTS(SK_LANE); }
#undef SK_LANE

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

/* Indices of shuffles, four numbers at a time from number k of both vectors on: each number of the lower or upper two beside the other
 * vector's, or the lower or upper two of each. */
#define SK_LOW_EACH(k) (k), (k) + SK_WIDTH, (k) + 1, (k) + 1 + SK_WIDTH
#define SK_HIGH_EACH(k) (k) + 2, (k) + 2 + SK_WIDTH, (k) + 3, (k) + 3 + SK_WIDTH
#define SK_LOW_TWO(k) (k), (k) + 1, (k) + SK_WIDTH, (k) + 1 + SK_WIDTH
#define SK_HIGH_TWO(k) (k) + 2, (k) + 3, (k) + 2 + SK_WIDTH, (k) + 3 + SK_WIDTH
#if SK_WIDTH == 16u
#define SK_EACH_FOUR(f) f(0), f(4), f(8), f(12)
#else
#define SK_EACH_FOUR(f) f(0), f(4)
#endif

/** Rows k, k + 4, … of four numbers each, for k = 0 to 3, as columns: transpositions of four by four. */
SK_FUNCTION sk_columns sk_turn_rows(sk_fN s0, sk_fN s1, sk_fN s2, sk_fN s3) {
    const sk_fN low01 = sk_shuffle(s0, s1, SK_EACH_FOUR(SK_LOW_EACH)), high01 = sk_shuffle(s0, s1, SK_EACH_FOUR(SK_HIGH_EACH));
    const sk_fN low23 = sk_shuffle(s2, s3, SK_EACH_FOUR(SK_LOW_EACH)), high23 = sk_shuffle(s2, s3, SK_EACH_FOUR(SK_HIGH_EACH));
    sk_columns r;
    r.a = sk_shuffle(low01, low23, SK_EACH_FOUR(SK_LOW_TWO));
    r.b = sk_shuffle(low01, low23, SK_EACH_FOUR(SK_HIGH_TWO));
    r.c = sk_shuffle(high01, high23, SK_EACH_FOUR(SK_LOW_TWO));
    r.d = sk_shuffle(high01, high23, SK_EACH_FOUR(SK_HIGH_TWO));
    return r;
}

/** Four numbers of lane k, one of each vector, to target[4 k] and on. */
SK_FUNCTION void sk_store_rows(sk_iN a, sk_iN b, sk_iN c, sk_iN d, SK_GLOBAL sk_i32* target) {
    const sk_columns rows = sk_turn_rows(sk_lanes_as_float(a), sk_lanes_as_float(b), sk_lanes_as_float(c), sk_lanes_as_float(d));
    const sk_iN row0 = sk_lanes_as_int(rows.a), row1 = sk_lanes_as_int(rows.b), row2 = sk_lanes_as_int(rows.c), row3 = sk_lanes_as_int(rows.d);
#define SK_STORE_FOUR(k)                                                              \
    sk_store_i4(sk_shuffle(row0, row0, (k), (k) + 1, (k) + 2, (k) + 3), target + 4 * (k)),     \
        sk_store_i4(sk_shuffle(row1, row1, (k), (k) + 1, (k) + 2, (k) + 3), target + 4 * (k) + 4), \
        sk_store_i4(sk_shuffle(row2, row2, (k), (k) + 1, (k) + 2, (k) + 3), target + 4 * (k) + 8), \
        sk_store_i4(sk_shuffle(row3, row3, (k), (k) + 1, (k) + 2, (k) + 3), target + 4 * (k) + 12)
    SK_EACH_FOUR(SK_STORE_FOUR);
#undef SK_STORE_FOUR
}

#define SK_TWO_ROWS(row, k) sk_shuffle(row(k), row((k) + 4), 0, 1, 2, 3, 4, 5, 6, 7)
#if SK_WIDTH == 16u
#define SK_ROWS(row, k) \
    sk_shuffle(SK_TWO_ROWS(row, k), SK_TWO_ROWS(row, (k) + 8), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#else
#define SK_ROWS(row, k) SK_TWO_ROWS(row, k)
#endif

/** Four numbers from base[at * stride] on of each lane. */
SK_FUNCTION sk_columns sk_gather4(SK_GLOBAL const float* base, sk_iN at, sk_u32 stride) {
#define SK_ROW(k) sk_load_f4(base + (size_t)(sk_u32)sk_lane(at, k) * stride)
    return sk_turn_rows(SK_ROWS(SK_ROW, 0), SK_ROWS(SK_ROW, 1), SK_ROWS(SK_ROW, 2), SK_ROWS(SK_ROW, 3));
#undef SK_ROW
}

/** The same from base[k * stride] on of lane k. */
SK_FUNCTION sk_columns sk_load_columns(SK_GLOBAL const float* base, const sk_u32 stride) {
#define SK_ROW(k) sk_load_f4(base + (k) * stride)
    return sk_turn_rows(SK_ROWS(SK_ROW, 0), SK_ROWS(SK_ROW, 1), SK_ROWS(SK_ROW, 2), SK_ROWS(SK_ROW, 3));
#undef SK_ROW
}

/** Nine numbers of each lane. */
typedef struct sk_nine_columns {
    sk_columns first, next;
    sk_fN last;
} sk_nine_columns;

/** From base[9 * at] on. To read the last one by one would take longer than as the fourth of a row. */
SK_FUNCTION sk_nine_columns sk_gather9(SK_GLOBAL const float* base, sk_iN at) {
    sk_nine_columns r;
    r.first = sk_gather4(base, at, 9u);
    r.next = sk_gather4(base + 4, at, 9u);
    r.last = sk_gather4(base + 5, at, 9u).d;
    return r;
}

/** From base[9 * k] on of lane k. */
SK_FUNCTION sk_nine_columns sk_load_nine_columns(SK_GLOBAL const float* base) {
    sk_nine_columns r;
    r.first = sk_load_columns(base, 9u);
    r.next = sk_load_columns(base + 4, 9u);
    r.last = sk_load_columns(base + 5, 9u).d;
    return r;
}

#endif
