/* SPDX-License-Identifier: MIT */
/** How does CUDA C++ spell the words of the dialect (src/device/dialect.h)? */
#ifndef SETKA_PLATFORM_H
#define SETKA_PLATFORM_H

#define SK_KERNEL extern "C" __global__
#define SK_FUNCTION static __device__ __forceinline__
#define SK_GLOBAL
#define SK_LOCAL
#define SK_LOCAL_STORAGE __shared__
#define SK_RESTRICT __restrict__
#define SK_ALIGNED(bytes) __align__(bytes)
#define SK_PRAGMA(words) _Pragma(#words)
#define SK_UNROLL(times) SK_PRAGMA(unroll times)
#define SK_BARRIER() __syncthreads()

#define SK_WIDTH 1u
#define SK_TEAM 32
#define SK_DOUBLE 1
/* So many teams on a multiprocessor leave 72 registers for a work-item: 1.0 to 1.07 times the rate of 32 with 64, on an H200. */
#define SK_TEAM_KERNEL extern "C" __global__ __launch_bounds__(SK_TEAM, 28)

typedef unsigned int sk_u32;
typedef int sk_i32;
typedef unsigned long long sk_u64;

#define sk_global_id() (blockIdx.x * blockDim.x + threadIdx.x)
#define sk_local_id() (threadIdx.x)
#define sk_group_id() (blockIdx.x)
#define sk_group_count() (gridDim.x)
#define sk_local_size() (blockDim.x)
#define sk_float_bits(f) __float_as_uint(f)
#define sk_bits_float(u) __uint_as_float(u)
#define sk_double_bits(d) ((sk_u64)__double_as_longlong(d))
#define sk_bits_double(u) __longlong_as_double((long long)(u))
#define sk_sqrt(f) __fsqrt_rn(f)
#define sk_floor(f) floorf(f)
#define sk_popcount(u) ((sk_u32)__popc(u))
#define sk_popcount_u64(u) ((sk_u32)__popcll(u))
#define sk_atomic_min(p, v) atomicMin(p, v)
#define sk_atomic_max(p, v) atomicMax(p, v)
#define sk_atomic_add(p, v) atomicAdd(p, v)
#define sk_atomic_or(p, v) atomicOr(p, v)
#define sk_atomic_exchange(p, v) atomicExch(p, v)

#endif
