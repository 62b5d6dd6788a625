/* SPDX-License-Identifier: MIT */
/**
 * Does a device compute as setka needs it to? Expressions over fixed operands, the layout of every shared
 * record, and values passed around a group between barriers. The host evaluates the same bodies
 * (src/core/probe_expectation.cpp) and compares.
 */
#ifndef SETKA_DEVICE_PROBE_PROBE_H
#define SETKA_DEVICE_PROBE_PROBE_H

#include "device/dialect.h"
#include "device/grid/cells.h"
#include "device/math.h"
#include "device/probe/records.h"
#include "device/scan.h"
#include "device/trace/triangle.h"

/** The low or high end of the edge from (pa, qa) to (pb, qb) over the slab [0, 1], as in the grid build. */
SK_FUNCTION sk_interval sk_probe_clip(float pa, float qa, float pb, float qb) {
    sk_interval nothing;
    nothing.low = SK_EVERYTHING;
    nothing.high = -SK_EVERYTHING;
    return sk_clip_edge(nothing, pa, qa, pb, qb, (qb - qa) / (pb - pa), 0.0f, 1.0f);
}

SK_FUNCTION sk_u32 sk_probe_compare(float a, float b) {
    return (sk_u32)(a < b) | (sk_u32)(a <= b) << 1 | (sk_u32)(a == b) << 2 | (sk_u32)(a != b) << 3 |
           (sk_u32)(a >= b) << 4 | (sk_u32)(a > b) << 5;
}

SK_FUNCTION sk_u32 sk_probe_truncate(float a) { return a >= 0.0f && a < 0x1p31f ? (sk_u32)a : 0xffffffffu; }

/* clang-format off */
/**
 * What is evaluated for each tuple (a, b, c, d): F(name, text, a float) and U(name, text, an integer). Products differ
 * from line to line where a compiler that finds one computed already would not fuse it. `m` is a fixed matrix.
 */
#define SK_PROBE_EXPRESSIONS(F, U)                                                                  \
    F(multiply_add, "a * c + b", a * c + b)                                                         \
    F(products, "a * d - b * c", a * d - b * c)                                                     \
    F(sum, "a + b", a + b)                                                                          \
    F(difference, "a - b", a - b)                                                                   \
    F(product, "a * b", a * b)                                                                      \
    F(quotient, "a / b", a / b)                                                                     \
    F(reciprocal, "1 / c", 1.0f / c)                                                                \
    F(root, "sqrt(|a|)", sk_sqrt(sk_abs(a)))                                                        \
    F(scaled_down, "c * 2^-20", c * 0x1p-20f)                                                       \
    F(scaled_up, "d * 2^30", d * 0x1p30f)                                                           \
    F(three_terms, "(b + c) + d", (b + c) + d)                                                      \
    F(recovered, "(a + c) - a", (a + c) - a)                                                        \
    F(high_part, "4097 * d - (4097 * d - d)", 4097.0f * d - (4097.0f * d - d))                      \
    F(positive_zero, "b * d without -0", sk_positive_zero(b * d))                                    \
    F(negated, "-c / d", -c / d)                                                                    \
    F(whole, "floor(a)", sk_floor(a))                                                               \
    F(minimum, "min(a, b)", sk_min(a, b))                                                           \
    F(maximum, "max(a, b)", sk_max(a, b))                                                           \
    U(comparisons, "comparisons of a and b", sk_probe_compare(a, b))                                \
    U(finite, "finite(b * c)", (sk_u32)sk_is_finite(b * c))                                         \
    U(truncated, "integer part of a", sk_probe_truncate(a))                                         \
    F(converted, "float of the bits of b", (float)sk_float_bits(b))                                 \
    U(cell, "cell(a, 1000)", sk_cell(a, 1000u))                                                     \
    U(cell_of_point, "cell((b - c) * d, 64)", sk_cell((b - c) * d, 64u))                            \
    F(clip_low, "low end of edge (a, b) - (c, d)", sk_probe_clip(a, b, c, d).low)                   \
    F(clip_high, "high end of edge (a, b) - (c, d)", sk_probe_clip(a, b, c, d).high)                \
    F(transformed, "x of matrix * (a, b, c)", sk_transform_point(m, sk_make3(a, b, c)).x)           \
    F(length, "length of (a, b, c)", sk_length(sk_make3(a, b, c)))                                  \
    F(accurate, "accurate a * b - c * d", sk_accurate_difference(a, b, c, d))
/* clang-format on */

/** words[e * n + i] = expression e of tuple i. Behind the n tuples lies the matrix. */
SK_FUNCTION void sk_probe_rounding(sk_u32 i, sk_u32 n, SK_GLOBAL const float* tuples,
                                   SK_GLOBAL sk_u32* words) {
    SK_GLOBAL const float* m = tuples + 4u * n;
    const float a = tuples[4u * i], b = tuples[4u * i + 1u], c = tuples[4u * i + 2u], d = tuples[4u * i + 3u];
    sk_u32 at = i;
#define SK_WRITE_FLOAT(name, text, value) \
    words[at] = sk_float_bits(value);     \
    at += n;
#define SK_WRITE_INTEGER(name, text, value) \
    words[at] = value;                      \
    at += n;
    SK_PROBE_EXPRESSIONS(SK_WRITE_FLOAT, SK_WRITE_INTEGER)
#undef SK_WRITE_FLOAT
#undef SK_WRITE_INTEGER
}

/* sk_echo_ray and the others: writes the members of a record, returns where the next word goes. */
#define SK_ECHO_FLOAT(member) words[at++] = sk_float_bits(record.member);
#define SK_ECHO_INTEGER(member) words[at++] = record.member;
#define SK_ECHO_FUNCTION(type, variable, members)                                            \
    SK_FUNCTION sk_u32 sk_echo_##variable(type record, sk_u32 at, SK_GLOBAL sk_u32* words) { \
        members(SK_ECHO_FLOAT, SK_ECHO_INTEGER) return at;                                   \
    }
SK_PROBE_RECORDS(SK_ECHO_FUNCTION)
#undef SK_ECHO_FLOAT
#undef SK_ECHO_INTEGER
#undef SK_ECHO_FUNCTION

/** Fills the slot of each record in words[first ..]; `memory` holds as many slots. */
SK_FUNCTION void sk_probe_layout(sk_u32 first, SetkaRay ray, SetkaHit hit, SetkaPrimitive primitive,
                                 SetkaTraceCost cost, SetkaBounds bounds, SetkaInstance instance,
                                 SetkaGridHeader grid, sk_trace_params params, SkCamera camera, SkMaterial material, SkLight light,
                                 SkBackground background, SkSurfacePoint surface,
                                 SK_GLOBAL const char* memory, SK_GLOBAL sk_u32* words) {
    sk_u32 start = first;
#define SK_FILL_SLOT(type, variable, members)                              \
    {                                                                      \
        SK_GLOBAL const type* records = (SK_GLOBAL const type*)memory;     \
        const sk_u32 at = sk_echo_##variable(variable, start + 1u, words); \
        sk_echo_##variable(records[1], at, words);                         \
        words[start] = (sk_u32)sizeof(type);                               \
        start += SK_PROBE_SLOT;                                            \
        memory += SK_PROBE_SLOT * 4u;                                      \
    }
    SK_PROBE_RECORDS(SK_FILL_SLOT)
#undef SK_FILL_SLOT
}

/** What work-item `item` of group `group` puts into local memory before it is passed around. */
SK_FUNCTION sk_u32 sk_probe_token(sk_u32 group, sk_u32 item) { return 0x40000000u + (group << 16) + item; }

/**
 * Passes the tokens of a group around it: a value is read, and its place written by another work-item behind
 * the barrier. Once in straight code, then in `rounds` turns of a loop; turn r moves by r + 2. Some drivers
 * of 2025 read again behind the barrier what was read before it.
 */
SK_FUNCTION void sk_probe_barrier(SK_LOCAL sk_u32* scratch, sk_u32 first, sk_u32 rounds,
                                  SK_GLOBAL sk_u32* words) {
    const sk_u32 item = sk_local_id();
    const sk_u32 size = sk_local_size();
    scratch[item] = sk_probe_token(sk_group_id(), item);
    SK_BARRIER();
    const sk_u32 neighbour = scratch[(item + 1u) % size];
    SK_BARRIER();
    scratch[item] = neighbour;
    SK_BARRIER();
    for (sk_u32 r = 0u; r < rounds; ++r) {
        const sk_u32 other = scratch[(item + r + 2u) % size];
        SK_BARRIER();
        scratch[item] = other;
        SK_BARRIER();
    }
    words[first + sk_global_id()] = scratch[item];
}

#endif
