/* SPDX-License-Identifier: MIT */
/** How does OpenCL C 1.2 spell the words of the dialect (src/device/dialect.h)? */
#ifndef SETKA_PLATFORM_H
#define SETKA_PLATFORM_H

/* Without this a * b + c may be fused, and 4 to 8 % of results differ between devices. */
#pragma OPENCL FP_CONTRACT OFF

#define SK_KERNEL __kernel
#if defined(SK_WIDTH) && SK_WIDTH > 1
/* PoCL's compiler leaves walks of many vectors as calls. */
#define SK_FUNCTION static inline __attribute__((always_inline))
#else
#define SK_FUNCTION static inline
#endif
#define SK_GLOBAL __global
#define SK_LOCAL __local
#define SK_LOCAL_STORAGE __local
#define SK_RESTRICT restrict
#define SK_ALIGNED(bytes) __attribute__((aligned(bytes)))
#define SK_PRAGMA(words) _Pragma(#words)
#define SK_UNROLL(times) SK_PRAGMA(unroll times)
#define SK_BARRIER() barrier(CLK_LOCAL_MEM_FENCE)

/* Given by the host: 8 or 16 and 1 for CPUs, 1 and 32 for GPUs, else 1 and 1. No result depends on them. */
#ifndef SK_WIDTH
#define SK_WIDTH 1u
#endif
#ifndef SK_TEAM
#define SK_TEAM 1
#endif

/* Given by the host as well: 1 for devices with doubles. What depends on it is compared with the host's. */
#ifndef SK_DOUBLE
#define SK_DOUBLE 0
#endif
#if SK_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

/* NVIDIA's compiler takes no limit of registers for kernels that say how large their groups are (SK_LIMITED, opencl_device.cpp). */
#if SK_TEAM > 1 && !defined(SK_LIMITED)
#define SK_TEAM_KERNEL __kernel __attribute__((reqd_work_group_size(SK_TEAM, 1, 1)))
#else
#define SK_TEAM_KERNEL __kernel
#endif

typedef uint sk_u32;
typedef int sk_i32;
typedef ulong sk_u64;

#define sk_global_id() ((sk_u32)get_global_id(0))
#define sk_local_id() ((sk_u32)get_local_id(0))
#define sk_group_id() ((sk_u32)get_group_id(0))
#define sk_group_count() ((sk_u32)get_num_groups(0))
#define sk_local_size() ((sk_u32)get_local_size(0))
#define sk_float_bits(f) as_uint(f)
#define sk_bits_float(u) as_float(u)
#define sk_double_bits(d) as_ulong(d)
#define sk_bits_double(u) as_double(u)
#define sk_sqrt(f) sqrt(f)
#define sk_floor(f) floor(f)
#define sk_popcount(u) popcount(u)
#define sk_popcount_u64(u) ((sk_u32)popcount((sk_u64)(u)))
#define sk_atomic_min(p, v) atomic_min(p, v)
#define sk_atomic_max(p, v) atomic_max(p, v)
#define sk_atomic_add(p, v) atomic_add(p, v)
#define sk_atomic_or(p, v) atomic_or(p, v)
#define sk_atomic_exchange(p, v) atomic_xchg(p, v)

#if SK_WIDTH > 1
typedef float4 sk_f4;
typedef uint4 sk_u4;
#define sk_make_u4(a, b, c, d) ((uint4)((a), (b), (c), (d)))
#if SK_WIDTH == 16u
typedef float16 sk_fN;
typedef int16 sk_iN;
#define sk_make_f(...) ((float16)(__VA_ARGS__))
#define sk_make_i(...) ((int16)(__VA_ARGS__))
#define sk_store_f(v, p) vstore16(v, 0, p)
#define sk_store_i(v, p) vstore16(v, 0, p)
#define sk_load_i(p) vload16(0, p)
#define sk_lanes_to_float(i) convert_float16(i)
#define sk_lanes_to_int(f) convert_int16(f)
#define sk_lanes_as_int(f) as_int16(f)
#define sk_lanes_as_float(i) as_float16(i)
#else
typedef float8 sk_fN;
typedef int8 sk_iN;
#define sk_make_f(...) ((float8)(__VA_ARGS__))
#define sk_make_i(...) ((int8)(__VA_ARGS__))
#define sk_store_f(v, p) vstore8(v, 0, p)
#define sk_store_i(v, p) vstore8(v, 0, p)
#define sk_load_i(p) vload8(0, p)
#define sk_lanes_to_float(i) convert_float8(i)
#define sk_lanes_to_int(f) convert_int8(f)
#define sk_lanes_as_int(f) as_int8(f)
#define sk_lanes_as_float(i) as_float8(i)
#endif
#define sk_prefetch(p) __builtin_prefetch(p)
#define sk_load_f4(p) vload4(0, p)
#define sk_load_f3(p) (vload3(0, p).xyzz)
#define sk_store_f4(v, p) vstore4(v, 0, p)
#define sk_store_i4(v, p) vstore4(v, 0, p)
#define sk_store_u4(v, p) vstore4(v, 0, p)
#define sk_same_f4(a) ((float4)(a))
/* Compilers of OpenCL C are made of Clang, which has subscripts and shuffles of vectors. */
#define sk_lane(v, k) ((v)[k])
#define sk_shuffle __builtin_shufflevector
#if __has_builtin(__builtin_reduce_or) /* Clang 15: one instruction */
#define sk_lanes_or(i) __builtin_reduce_or(i)
#else
#define sk_or_of_4(i) (((i).s0 | (i).s1) | ((i).s2 | (i).s3))
#define sk_or_of_8(i) sk_or_of_4((i).lo | (i).hi)
#if SK_WIDTH == 16u
#define sk_lanes_or(i) sk_or_of_8((i).lo | (i).hi)
#else
#define sk_lanes_or(i) sk_or_of_8(i)
#endif
#endif
/* One instruction where the compiler is known to be for such a processor. */
#if SK_WIDTH == 16u && defined(__AVX512DQ__)
#define sk_lane_bits(mask) ((sk_u32)(ushort)__builtin_ia32_cvtd2mask512(mask))
#elif SK_WIDTH == 8u && defined(__AVX__)
#define sk_lane_bits(mask) ((sk_u32)__builtin_ia32_movmskps256(as_float8(mask)))
#elif SK_WIDTH == 16u
#define sk_lane_bits(mask) \
    ((sk_u32)sk_lanes_or((mask) & (int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768)))
#else
#define sk_lane_bits(mask) ((sk_u32)sk_lanes_or((mask) & (int8)(1, 2, 4, 8, 16, 32, 64, 128)))
#endif
#if SK_WIDTH == 16u && defined(__AVX512F__) && __has_builtin(__builtin_ia32_compresssi512_mask)
/* vstore16 is four parts here. */
typedef int16 sk_iN_anywhere __attribute__((aligned(4)));
#define sk_put_i(target, bits, i) \
    (*(sk_iN_anywhere*)(target) = __builtin_ia32_compresssi512_mask((i), (int16)(0), (ushort)(bits)))
#else
#define sk_put_i(target, bits, i)                                             \
    for (uint sk_rest = (bits), sk_n = 0u; sk_rest != 0u; sk_rest &= sk_rest - 1u) \
    (target)[sk_n++] = (i)[popcount((sk_rest & (0u - sk_rest)) - 1u)]
#endif
#if defined(__AVX512VL__) && __has_builtin(__builtin_ia32_storedqusi128_mask)
/* This instruction writes no element but those asked for. Its function knows no address spaces. */
#define sk_put_u4(target, n, v) __builtin_ia32_storedqusi128_mask((void*)(uintptr_t)(target), as_int4(v), (uchar)((1u << (n)) - 1u))
#elif defined(__AVX2__) && __has_builtin(__builtin_ia32_maskstored)
#define sk_put_u4(target, n, v) __builtin_ia32_maskstored((void*)(uintptr_t)(target), (int4)((int)(n)) > (int4)(0, 1, 2, 3), as_int4(v))
#else
SK_FUNCTION void sk_put_u4(__global uint* target, uint n, sk_u4 v) {
    if (n == 4u) {
        vstore4(v, 0, target);
    } else {
        if (n >= 2u) vstore2(v.lo, 0, target);
        if ((n & 1u) != 0u) target[n - 1u] = n == 1u ? v.x : v.z;
    }
}
#endif
#endif

#endif
