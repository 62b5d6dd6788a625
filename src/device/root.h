/* SPDX-License-Identifier: MIT */
/**
 * What is the n-th root of a number in double precision? Of + - * / alone, which round alike on every device that has doubles and on
 * the host (core/exact_math.hpp): nothing of it is left to a library. The error is below 1e-14, relative.
 */
#ifndef SETKA_DEVICE_ROOT_H
#define SETKA_DEVICE_ROOT_H

#include "device/dialect.h"

#if SK_DOUBLE

/** x to a small power by repeated multiplication. */
SK_FUNCTION double sk_power(double x, sk_u32 exponent) {
    double result = 1.0;
    for (; exponent != 0u; exponent >>= 1) {
        if ((exponent & 1u) != 0u) result *= x;
        x *= x;
    }
    return result;
}

/** 2^exponent, or the nearest power of two that is not subnormal. */
SK_FUNCTION double sk_power_of_two(sk_i32 exponent) {
    const sk_i32 near = exponent < -1022 ? -1022 : exponent > 1023 ? 1023 : exponent;
    return sk_bits_double((sk_u64)(near + 1023) << 52);
}

/** The e for which x, which is above 0, lies in [2^(e-1), 2^e). */
SK_FUNCTION sk_i32 sk_exponent_above(double x) {
    const int is_subnormal = x < 0x1p-1022;
    return (sk_i32)(sk_double_bits(is_subnormal ? x * 0x1p64 : x) >> 52) - (is_subnormal ? 1022 + 64 : 1022);
}

/**
 * The n-th root of x >= 0 for a small n, by Newton's method from a power of two at or above the root: the iterates fall until rounding
 * stops them.
 */
SK_FUNCTION double sk_root(double x, sk_u32 n) {
    if (!(x > 0.0)) return 0.0;
    const sk_i32 exponent = sk_exponent_above(x), count = (sk_i32)n;
    double y = sk_power_of_two((exponent >= 0 ? exponent / count : -(-exponent / count)) + 1);
    for (int i = 0; i < 200; ++i) {
        const double next = y - (y - x / sk_power(y, n - 1u)) / (double)n;
        if (!(next < y)) break;
        y = next;
    }
    return y;
}

#endif

#endif
