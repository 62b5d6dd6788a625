/* SPDX-License-Identifier: MIT */
/**
 * How do the hits of one ray come into order? They gather in a binary heap in global memory, the last along the ray on top, so
 * that a full list lets go of it for a closer one; then the heap is sorted in place (Williams 1964). No step depends on
 * another work-item, and n hits take some n log n steps, however they come.
 *
 * Until the list is finished a record holds the working parameter in `t` and the scene triangle in `primitive`: what hits
 * are ordered by.
 */
#ifndef SETKA_DEVICE_TRACE_HIT_LIST_H
#define SETKA_DEVICE_TRACE_HIT_LIST_H

#include "device/trace/triangle.h"

SK_FUNCTION SetkaHit sk_listed_hit(sk_best hit) {
    SetkaHit r;
    r.t = hit.w;
    r.u = hit.u;
    r.v = hit.v;
    r.primitive = hit.triangle;
    r.instance = 0u;
    return r;
}

/** The hit that a record stands for. */
SK_FUNCTION sk_best sk_unlisted_hit(SetkaHit listed) {
    sk_best r;
    r.w = listed.t;
    r.u = listed.u;
    r.v = listed.v;
    r.triangle = listed.primitive;
    return r;
}

/** The order of hits: along the ray, then by scene triangle. */
SK_FUNCTION int sk_comes_before(SetkaHit a, SetkaHit b) {
    return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
}

/** Puts a record in place of the top of the heap hits[0 .. size). */
SK_FUNCTION void sk_replace_top(SK_GLOBAL SetkaHit* hits, sk_u32 size, SetkaHit record) {
    sk_u32 at = 0u, child = 1u;
    int sinking = 1;
    while (sinking && child < size) {
        if (child + 1u < size && sk_comes_before(hits[child], hits[child + 1u])) child += 1u;
        if (sk_comes_before(record, hits[child])) {
            hits[at] = hits[child];
            at = child;
            child = 2u * at + 1u;
        } else {
            sinking = 0;
        }
    }
    hits[at] = record;
}

/** Puts a record below the heap hits[0 .. size) and lets it rise. */
SK_FUNCTION void sk_grow_heap(SK_GLOBAL SetkaHit* hits, sk_u32 size, SetkaHit record) {
    sk_u32 at = size;
    int rising = 1;
    while (rising && at > 0u) {
        const sk_u32 parent = (at - 1u) / 2u;
        if (sk_comes_before(hits[parent], record)) {
            hits[at] = hits[parent];
            at = parent;
        } else {
            rising = 0;
        }
    }
    hits[at] = record;
}

/** Adds a hit to the heap hits[0 .. size), which keeps the first `capacity` of all that are added. Returns the new size. */
SK_FUNCTION sk_u32 sk_list_hit(SK_GLOBAL SetkaHit* hits, sk_u32 size, sk_u32 capacity, sk_best hit) {
    const SetkaHit record = sk_listed_hit(hit);
    sk_u32 r = size;
    if (size < capacity) {
        sk_grow_heap(hits, size, record);
        r = size + 1u;
    } else if (capacity != 0u && sk_comes_before(record, hits[0])) {
        sk_replace_top(hits, size, record);
    }
    return r;
}

/** Puts the heap hits[0 .. size) into order. */
SK_FUNCTION void sk_sort_hits(SK_GLOBAL SetkaHit* hits, sk_u32 size) {
    for (sk_u32 last = size; last > 1u; --last) {
        const SetkaHit record = hits[last - 1u];
        hits[last - 1u] = hits[0];
        sk_replace_top(hits, last - 1u, record);
    }
}

/** Turns ordered records into hits as users know them. */
SK_FUNCTION void sk_finish_hits(sk_trace_params params, sk_working_ray ray, SK_GLOBAL const sk_u32* instance_starts,
                                SK_GLOBAL SetkaHit* hits, sk_u32 size) {
    for (sk_u32 k = 0u; k < size; ++k)
        hits[k] = sk_make_hit(params, ray, instance_starts, sk_unlisted_hit(hits[k]));
}

#endif
