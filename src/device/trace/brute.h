/* SPDX-License-Identifier: MIT */
/**
 * What does a ray hit if nothing is left out? Every triangle is tested: the definition that structures are held against.
 * Triangles lie SK_LANES at a time with equal components side by side, and the plain test runs over a packet without a branch,
 * so that a CPU's compiler can vectorise it; only packets with a candidate are looked at one by one.
 */
#ifndef SETKA_DEVICE_TRACE_BRUTE_H
#define SETKA_DEVICE_TRACE_BRUTE_H

#include "device/trace/hit_list.h"
#include "device/trace/triangle.h"

#define SK_LANES 16u

/** packets[(9 * packet + component) * SK_LANES + lane]; lanes past the last triangle hold zeros. */
SK_FUNCTION void sk_trace_pack(sk_u32 i, sk_u32 triangle_count, SK_GLOBAL const float* triangles,
                               SK_GLOBAL float* packets) {
    SK_GLOBAL float* packet = packets + (size_t)(i / SK_LANES) * 9u * SK_LANES + i % SK_LANES;
    for (sk_u32 c = 0u; c < 9u; ++c) packet[c * SK_LANES] = i < triangle_count ? triangles[(size_t)i * 9u + c] : 0.0f;
}

/** Not 0 if any triangle of the packet may be hit. */
SK_FUNCTION sk_u32 sk_packet_candidates(sk_working_ray ray, SK_GLOBAL const float* packet) {
    SK_GLOBAL const float* px = packet + ray.kx * SK_LANES;
    SK_GLOBAL const float* py = packet + ray.ky * SK_LANES;
    SK_GLOBAL const float* pz = packet + ray.kz * SK_LANES;
    sk_u32 any = 0u;
    for (sk_u32 k = 0u; k < SK_LANES; ++k) {
        const float a0 = pz[k] - ray.oz, a1 = pz[k + 3u * SK_LANES] - ray.oz, a2 = pz[k + 6u * SK_LANES] - ray.oz;
        const float x0 = (px[k] - ray.ox) - ray.sx * a0, y0 = (py[k] - ray.oy) - ray.sy * a0;
        const float x1 = (px[k + 3u * SK_LANES] - ray.ox) - ray.sx * a1;
        const float y1 = (py[k + 3u * SK_LANES] - ray.oy) - ray.sy * a1;
        const float x2 = (px[k + 6u * SK_LANES] - ray.ox) - ray.sx * a2;
        const float y2 = (py[k + 6u * SK_LANES] - ray.oy) - ray.sy * a2;
        const float u = x2 * y1 - y2 * x1;
        const float v = x0 * y2 - y0 * x2;
        const float w = x1 * y0 - y1 * x0;
        any |= sk_mixed_signs_bit(u, v, w) ^ 1u;
    }
    return any;
}

SK_FUNCTION sk_u32 sk_packet_count(sk_trace_params params) {
    return params.triangle_count / SK_LANES + (params.triangle_count % SK_LANES != 0u);
}

/** The closest hit over all triangles but `skip`; with `any` not 0 the first that is found. */
SK_FUNCTION sk_best sk_brute_force(sk_trace_params params, sk_working_ray ray, SK_GLOBAL const float* packets,
                                   SK_GLOBAL const sk_u32* instance_starts, SK_GLOBAL const SetkaInstance* instances,
                                   sk_u32 skip, const int any) {
    const sk_u32 packet_count = ray.valid ? sk_packet_count(params) : 0u;
    sk_best best = sk_no_hit();
    for (sk_u32 p = 0u; p < packet_count; ++p) {
        SK_GLOBAL const float* packet = packets + (size_t)p * 9u * SK_LANES;
        if (sk_packet_candidates(ray, packet) != 0u)
            for (sk_u32 k = 0u; k < SK_LANES; ++k) {
                const sk_u32 number = p * SK_LANES + k;
                if (number < params.triangle_count) {
                    const sk_best next = sk_test_triangle(ray, packet, k, SK_LANES, number, best);
                    if (next.triangle != best.triangle && number != skip &&
                        sk_is_visible(params, instance_starts, instances, number))
                        best = next;
                }
            }
        if (any && best.triangle != SETKA_NO_HIT) break;
    }
    return best;
}

/**
 * The number of hits over all triangles but `skip`, up to `most`. With `write` not 0 hits[0 .. number) become the first of
 * them, in order, as records of hit_list.h.
 */
SK_FUNCTION sk_u32 sk_brute_force_all(sk_trace_params params, sk_working_ray ray, SK_GLOBAL const float* packets,
                                      SK_GLOBAL const sk_u32* instance_starts,
                                      SK_GLOBAL const SetkaInstance* instances, sk_u32 skip,
                                      SK_GLOBAL SetkaHit* hits, sk_u32 most, const int write) {
    const sk_u32 packet_count = ray.valid && most != 0u ? sk_packet_count(params) : 0u;
    sk_u32 found = 0u;
    for (sk_u32 p = 0u; p < packet_count && (write || found < most); ++p) {
        SK_GLOBAL const float* packet = packets + (size_t)p * 9u * SK_LANES;
        if (sk_packet_candidates(ray, packet) != 0u)
            for (sk_u32 k = 0u; k < SK_LANES; ++k) {
                const sk_u32 number = p * SK_LANES + k;
                if (number < params.triangle_count) {
                    const sk_best hit = sk_test_triangle(ray, packet, k, SK_LANES, number, sk_no_hit());
                    if (hit.triangle != SETKA_NO_HIT && number != skip &&
                        sk_is_visible(params, instance_starts, instances, number))
                        found = write ? sk_list_hit(hits, found, most, hit) : found + 1u;
                }
            }
    }
    if (write) sk_sort_hits(hits, found);
    return sk_min_u32(found, most);
}

#endif
