/* SPDX-License-Identifier: MIT */
/**
 * Which words may a kernel body use? C99 as every backend's compiler and host C++ accept it, plus the words below, which
 * the platform.h of each folder translates, and host_platform.h for the host. This file is the list; it fails the build
 * of a platform that lacks one.
 *
 *   SK_KERNEL                a kernel entry point returning void
 *   SK_TEAM_KERNEL           the same, launched in groups of SK_TEAM work-items if that is more than 1
 *   SK_FUNCTION              a helper function, always inlined
 *   SK_GLOBAL, SK_LOCAL      before the type of a pointer to global or local memory
 *   SK_LOCAL_STORAGE         before an array in local memory, at the top of a kernel entry only
 *   SK_RESTRICT              on a pointer that nothing else aliases
 *   SK_ALIGNED(bytes)        before the name of a struct whose members are loaded at once
 *   SK_WIDTH                 how many rays a work-item traces side by side: 1 where work-items run in step, on CPUs whose drivers compile
 *                            vectors well 8, or 16 with AVX-512
 *   SK_TEAM                  how many work-items run in step: 1, or a power of two up to 32 (an integer for #if)
 *   SK_DOUBLE                whether there is `double`, of which + - * / and conversions are correctly rounded too: only what the host does
 *                            again and compares may depend on it (an integer for #if)
 *   SK_UNROLL(times)         before a loop: how often its body is to be written out, 1 or 2
 *   SK_BARRIER()             all work-items of the group; orders local memory; in uniform control flow only
 *   sk_u32 sk_i32 sk_u64     integers
 *   sk_global_id() sk_local_id() sk_group_id() sk_local_size()   as sk_u32
 *   sk_group_count()                                             how many groups the launch has, where SK_TEAM is more than 1
 *   sk_float_bits(f) sk_bits_float(u)                            bit casts
 *   sk_double_bits(d) sk_bits_double(u)                          the same of sk_u64, where SK_DOUBLE
 *   sk_sqrt(f) sk_floor(f)                                       correctly rounded
 *   sk_popcount(u) sk_popcount_u64(u)                            how many bits of a sk_u32 or a sk_u64 are set
 *   sk_atomic_min(p, v) sk_atomic_max(p, v) sk_atomic_add(p, v)  on sk_u32 in global or local memory, return what was there;
 *   sk_atomic_or(p, v) sk_atomic_exchange(p, v)                  order-free uses only
 *
 * Where SK_WIDTH is 8 or 16 (src/device/lanes.h), operators on vectors work on each element, comparisons give masks, scalars on one side
 * included, `mask ? a : b` with a mask of all bits or none, and:
 *   sk_fN sk_iN sk_f4 sk_u4  SK_WIDTH floats, as many sk_i32, 4 floats, 4 sk_u32
 *   sk_make_f(a, …) sk_make_i(a, …) sk_make_u4(a, …) sk_lane(v, k)   k is a constant
 *   sk_prefetch(p)                                               what p points to will be read or written soon
 *   sk_load_f4(p) sk_load_f3(p) sk_store_f4(v, p)                global memory, aligned as one number is; the fourth of three is whatever comes
 *   sk_store_u4(v, p) sk_store_i4(v, p)                          the same; 4 sk_i32, as a shuffle gives them
 *   sk_store_f(v, p) sk_store_i(v, p) sk_load_i(p)               of SK_WIDTH, in private memory too
 *   sk_same_f4(a)                                                four times a
 *   sk_lanes_to_float(i) sk_lanes_to_int(f)                      conversions; f in the range of sk_i32
 *   sk_lanes_as_int(f) sk_lanes_as_float(i)                      bit casts
 *   sk_lanes_or(i)                                               of all lanes
 *   sk_lane_bits(mask)                                           bit k: the mask is set in lane k
 *   sk_put_i(target, bits, i)                                    target[0], … in private memory are the lanes whose bit is set; up to SK_WIDTH
 *                                                                more may be written
 *   sk_put_u4(target, n, v)                                      target[0] to target[n - 1] in global memory are the first of 4; no more is written
 *   sk_shuffle(v, w, i, …)                                       elements of v and w, which are numbered on
 *
 * Not allowed: fma, mad, min, max, clamp, rsqrt, dot, cross, normalize, pow, exp, log, sin, float3, doubles without SK_DOUBLE, sub-groups,
 * float atomics, recursion, `return` before a barrier, a float to integer cast of a value that was not range-checked.
 */
#ifndef SETKA_DEVICE_DIALECT_H
#define SETKA_DEVICE_DIALECT_H

#if !defined(SK_KERNEL) || !defined(SK_TEAM_KERNEL) || !defined(SK_TEAM) || !defined(SK_FUNCTION) || !defined(SK_GLOBAL) || !defined(SK_LOCAL) || \
    !defined(SK_LOCAL_STORAGE) || !defined(SK_RESTRICT) || !defined(SK_BARRIER) || !defined(SK_UNROLL) || !defined(SK_WIDTH) || !defined(SK_DOUBLE) || !defined(SK_ALIGNED)
#error "include a platform.h before dialect.h"
#endif
#if SK_TEAM > 32
#error "the walk of a team keeps a bit for each member in a sk_u32"
#endif

#include "setka/layout.h"

#endif
