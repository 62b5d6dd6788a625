/* SPDX-License-Identifier: MIT */
/**
 * How do kernels calculate with points? Three floats in registers and the few operations that round alike everywhere: each
 * function is a fixed sequence of correctly rounded operations, and minimum and maximum are comparisons of our own, because
 * the built-in ones differ on -0 and NaN.
 */
#ifndef SETKA_DEVICE_MATH_H
#define SETKA_DEVICE_MATH_H

#include "device/dialect.h"

typedef struct sk_vec3 {
    float x, y, z;
} sk_vec3;

SK_FUNCTION float sk_min(float a, float b) { return b < a ? b : a; }
SK_FUNCTION float sk_max(float a, float b) { return a < b ? b : a; }
SK_FUNCTION float sk_abs(float a) { return sk_bits_float(sk_float_bits(a) & 0x7fffffffu); }
SK_FUNCTION sk_u32 sk_min_u32(sk_u32 a, sk_u32 b) { return b < a ? b : a; }
SK_FUNCTION sk_u32 sk_max_u32(sk_u32 a, sk_u32 b) { return a < b ? b : a; }

/**
 * a + 0: -0 becomes 0, all else stays. Written as a choice on its bits, because some compilers (Mesa's of 2022) drop an addition of 0 as if it
 * changed nothing.
 */
SK_FUNCTION float sk_positive_zero(float a) { return (sk_float_bits(a) & 0x7fffffffu) == 0u ? 0.0f : a; }

/** True for numbers, false for NaN and infinities. */
SK_FUNCTION int sk_is_finite(float a) { return (sk_float_bits(a) & 0x7f800000u) != 0x7f800000u; }

SK_FUNCTION sk_vec3 sk_make3(float x, float y, float z) {
    sk_vec3 r;
    r.x = x;
    r.y = y;
    r.z = z;
    return r;
}
SK_FUNCTION sk_vec3 sk_add(sk_vec3 a, sk_vec3 b) { return sk_make3(a.x + b.x, a.y + b.y, a.z + b.z); }
SK_FUNCTION sk_vec3 sk_sub(sk_vec3 a, sk_vec3 b) { return sk_make3(a.x - b.x, a.y - b.y, a.z - b.z); }
SK_FUNCTION sk_vec3 sk_mul(sk_vec3 a, sk_vec3 b) { return sk_make3(a.x * b.x, a.y * b.y, a.z * b.z); }
SK_FUNCTION sk_vec3 sk_scale(sk_vec3 a, float s) { return sk_make3(a.x * s, a.y * s, a.z * s); }
SK_FUNCTION float sk_dot3(sk_vec3 a, sk_vec3 b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
SK_FUNCTION sk_vec3 sk_cross3(sk_vec3 a, sk_vec3 b) {
    return sk_make3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
SK_FUNCTION float sk_length(sk_vec3 a) { return sk_sqrt(sk_dot3(a, a)); }
/** A vector of length 1, or the vector itself where its length is 0 or not finite. */
SK_FUNCTION sk_vec3 sk_unit(sk_vec3 a) {
    const float length = sk_length(a);
    return length > 0.0f && sk_is_finite(length) ? sk_make3(a.x / length, a.y / length, a.z / length) : a;
}
SK_FUNCTION sk_vec3 sk_load3(SK_GLOBAL const float* p) { return sk_make3(p[0], p[1], p[2]); }
/** The largest absolute component. */
SK_FUNCTION float sk_largest(sk_vec3 a) { return sk_max(sk_max(sk_abs(a.x), sk_abs(a.y)), sk_abs(a.z)); }
/** Component 0, 1 or 2. */
SK_FUNCTION float sk_component(sk_vec3 a, sk_u32 axis) { return axis == 0u ? a.x : axis == 1u ? a.y : a.z; }

/** matrix (3 rows of 4) * (p, 1), without -0, so that no table ever holds one. */
SK_FUNCTION sk_vec3 sk_transform_point(SK_GLOBAL const float* m, sk_vec3 p) {
    return sk_make3(sk_positive_zero(((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3]),
                    sk_positive_zero(((m[4] * p.x + m[5] * p.y) + m[6] * p.z) + m[7]),
                    sk_positive_zero(((m[8] * p.x + m[9] * p.y) + m[10] * p.z) + m[11]));
}

/** The index i with starts[i] <= value < starts[i + 1], for starts of count + 1 ascending numbers from 0. */
SK_FUNCTION sk_u32 sk_find_segment(SK_GLOBAL const sk_u32* starts, sk_u32 count, sk_u32 value) {
    sk_u32 low = 0u, high = count;
    while (high - low > 1u) {
        const sk_u32 middle = low + (high - low) / 2u;
        if (starts[middle] <= value)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/** The first of n ascending numbers that is not below `number`, and so how many are. */
SK_FUNCTION sk_u32 sk_lower_bound(SK_GLOBAL const sk_u32* numbers, sk_u32 n, sk_u32 number) {
    sk_u32 low = 0u, high = n;
    while (low < high) {
        const sk_u32 middle = low + (high - low) / 2u;
        if (numbers[middle] < number)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

#endif
