/* SPDX-License-Identifier: MIT */
/**
 * How does host C++ spell the words of the dialect (src/device/dialect.h)? The device probe computes with it
 * what a device has to answer, and unit tests run the same bodies under sanitizers. Every group has one
 * work-item, as in PrimitiveShape::Serial, so that a barrier has nobody to wait for; `sk_host_group` is the
 * number of the group that runs.
 */
#ifndef SETKA_PLATFORM_H
#define SETKA_PLATFORM_H

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__FAST_MATH__)
#error "compile the dialect with strict floating point: its results have to be those of every device"
#endif
static_assert(FLT_EVAL_METHOD == 0, "float expressions must be rounded to float after each operation");

#define SK_KERNEL static inline
#define SK_TEAM_KERNEL static inline
#define SK_FUNCTION static inline
#define SK_GLOBAL
#define SK_LOCAL
#define SK_LOCAL_STORAGE
#define SK_RESTRICT __restrict
#define SK_ALIGNED(bytes) alignas(bytes)
#define SK_UNROLL(times)
#define SK_BARRIER() ((void)0)

#ifndef SK_WIDTH
#define SK_WIDTH 1u
#endif
#define SK_TEAM 1
#define SK_DOUBLE 1

typedef std::uint32_t sk_u32;
typedef std::int32_t sk_i32;
typedef std::uint64_t sk_u64;

inline thread_local sk_u32 sk_host_group = 0;

#define sk_global_id() (sk_host_group)
#define sk_local_id() (sk_u32{0})
#define sk_group_id() (sk_host_group)
#define sk_local_size() (sk_u32{1})
#define sk_float_bits(f) (std::bit_cast<sk_u32>(f))
#define sk_bits_float(u) (std::bit_cast<float>(u))
#define sk_double_bits(d) (std::bit_cast<sk_u64>(d))
#define sk_bits_double(u) (std::bit_cast<double>(u))
#define sk_popcount(u) (static_cast<sk_u32>(std::popcount(sk_u32{u})))
#define sk_popcount_u64(u) (static_cast<sk_u32>(std::popcount(sk_u64{u})))
#define sk_sqrt(f) (std::sqrt(f))
#define sk_floor(f) (std::floor(f))

/* Compile with -Wno-psabi: every function with vectors is called in its own file only. */
#if SK_WIDTH > 1
typedef float sk_f4 __attribute__((vector_size(16)));
typedef sk_u32 sk_u4 __attribute__((vector_size(16)));
typedef float sk_fN __attribute__((vector_size(4 * SK_WIDTH)));
typedef sk_i32 sk_iN __attribute__((vector_size(4 * SK_WIDTH)));
#define sk_make_f(...) (sk_fN{__VA_ARGS__})
#define sk_make_i(...) (sk_iN{__VA_ARGS__})
#define sk_make_u4(a, b, c, d) (sk_u4{a, b, c, d})
#define sk_lane(v, k) ((v)[k])
#define sk_prefetch(p) __builtin_prefetch(p)
static inline sk_f4 sk_load_f4(const float* p) {
    sk_f4 r;
    std::memcpy(&r, p, sizeof r);
    return r;
}
static inline sk_f4 sk_load_f3(const float* p) { return sk_f4{p[0], p[1], p[2], p[2]}; }
static inline void sk_store_f4(sk_f4 v, float* p) { std::memcpy(p, &v, sizeof v); }
static inline sk_f4 sk_same_f4(float a) { return sk_f4{a, a, a, a}; }
static inline void sk_store_f(sk_fN v, float* p) { std::memcpy(p, &v, sizeof v); }
static inline void sk_store_i(sk_iN v, sk_i32* p) { std::memcpy(p, &v, sizeof v); }
static inline sk_iN sk_load_i(const sk_i32* p) {
    sk_iN r;
    std::memcpy(&r, p, sizeof r);
    return r;
}
static inline void sk_store_i4(sk_i32 __attribute__((vector_size(16))) v, sk_i32* p) { std::memcpy(p, &v, sizeof v); }
static inline void sk_store_u4(sk_u4 v, sk_u32* p) { std::memcpy(p, &v, sizeof v); }
#define sk_lanes_to_float(i) __builtin_convertvector(i, sk_fN)
#define sk_lanes_to_int(f) __builtin_convertvector(f, sk_iN)
#define sk_lanes_as_int(f) ((sk_iN)(f))
#define sk_lanes_as_float(i) ((sk_fN)(i))
#define sk_shuffle __builtin_shufflevector
static inline sk_i32 sk_lanes_or(sk_iN i) {
    sk_i32 r = 0;
    for (sk_u32 k = 0u; k < SK_WIDTH; ++k) r |= i[k];
    return r;
}
static inline sk_u32 sk_lane_bits(sk_iN mask) {
    sk_u32 r = 0;
    for (sk_u32 k = 0u; k < SK_WIDTH; ++k) r |= (mask[k] != 0 ? 1u : 0u) << k;
    return r;
}
static inline void sk_put_i(sk_i32* target, sk_u32 bits, sk_iN i) {
    for (sk_u32 k = 0u; k < SK_WIDTH; ++k)
        if ((bits >> k & 1u) != 0u) *target++ = i[k];
}
static inline void sk_put_u4(sk_u32* target, sk_u32 n, sk_u4 v) {
    for (sk_u32 k = 0u; k < n; ++k) target[k] = v[k];
}
#endif

static inline sk_u32 sk_atomic_min(sk_u32* target, sk_u32 value) {
    const sk_u32 before = *target;
    *target = value < before ? value : before;
    return before;
}
static inline sk_u32 sk_atomic_max(sk_u32* target, sk_u32 value) {
    const sk_u32 before = *target;
    *target = value > before ? value : before;
    return before;
}
static inline sk_u32 sk_atomic_add(sk_u32* target, sk_u32 value) {
    const sk_u32 before = *target;
    *target = before + value;
    return before;
}
static inline sk_u32 sk_atomic_exchange(sk_u32* target, sk_u32 value) {
    const sk_u32 before = *target;
    *target = value;
    return before;
}
static inline sk_u32 sk_atomic_or(sk_u32* target, sk_u32 value) {
    const sk_u32 before = *target;
    *target = before | value;
    return before;
}

#endif
