/* SPDX-License-Identifier: MIT */
/**
 * Does a ray hit a triangle, and where? The shear test of Woop, Benthin & Wald (2013) with edge functions that are recomputed
 * accurately for the few triangles that pass, so that the sign is exact and t is that of a point within a few roundings of the
 * triangle, however thin it is. src/README.md specifies every operation.
 */
#ifndef SETKA_DEVICE_TRACE_TRIANGLE_H
#define SETKA_DEVICE_TRACE_TRIANGLE_H

#include "device/trace/ray.h"

/** The best hit so far, in working parameters. */
typedef struct sk_best {
    float w, u, v;
    sk_u32 triangle; /* SETKA_NO_HIT: none yet */
} sk_best;

/** A value and what rounding took from it. */
typedef struct sk_pair {
    float value, error;
} sk_pair;

SK_FUNCTION sk_pair sk_two_product(float a, float b) {
    sk_pair r;
    const float ca = 4097.0f * a, cb = 4097.0f * b;
    const float ah = ca - (ca - a), bh = cb - (cb - b);
    const float al = a - ah, bl = b - bh;
    r.value = a * b;
    r.error = (((ah * bh - r.value) + ah * bl) + al * bh) + al * bl;
    return r;
}

SK_FUNCTION sk_pair sk_two_difference(float x, float y) {
    sk_pair r;
    r.value = x - y;
    const float t = r.value - x;
    r.error = (x - (r.value - t)) - (y + t);
    return r;
}

SK_FUNCTION sk_pair sk_two_sum(float x, float y) {
    sk_pair r;
    r.value = x + y;
    const float t = r.value - x;
    r.error = (x - (r.value - t)) + (y - t);
    return r;
}

/** a * b - c * d with the exact sign and full relative precision. */
SK_FUNCTION float sk_accurate_difference(float a, float b, float c, float d) {
    const sk_pair p = sk_two_product(a, b), q = sk_two_product(c, d);
    const sk_pair s = sk_two_difference(p.value, q.value);
    const sk_pair f = sk_two_difference(p.error, q.error);
    const sk_pair r = sk_two_sum(s.value, f.value);
    return r.value + (r.error + (s.error + f.error));
}

/** One is below 0 and one above: the ray passes outside. */
SK_FUNCTION int sk_mixed_signs(float u, float v, float w) {
    return (u < 0.0f || v < 0.0f || w < 0.0f) && (u > 0.0f || v > 0.0f || w > 0.0f);
}

/** The same as 1 or 0, without a branch, for loops over triangles side by side. */
SK_FUNCTION sk_u32 sk_mixed_signs_bit(float u, float v, float w) {
    const sk_u32 below = (sk_u32)(u < 0.0f) | (sk_u32)(v < 0.0f) | (sk_u32)(w < 0.0f);
    const sk_u32 above = (sk_u32)(u > 0.0f) | (sk_u32)(v > 0.0f) | (sk_u32)(w > 0.0f);
    return below & above;
}

/**
 * The side of the edge from a to b on which the ray passes, -1 or 1; `edge` has the exact sign of its edge function. A ray that meets
 * the edge's line is treated as if it were moved by an infinitely small step along x and one infinitely smaller along y
 * (Edelsbrunner & Muecke 1990), so that each of two triangles that share an edge answers for the same moved ray. 0 only if a
 * and b coincide.
 */
SK_FUNCTION int sk_side(float edge, float xa, float ya, float xb, float yb) {
    if (edge != 0.0f) return edge > 0.0f ? 1 : -1;
    if (ya != yb) return yb > ya ? 1 : -1;
    return xa > xb ? 1 : xa < xb ? -1 : 0;
}

/** A triangle as the ray sees it: along the ray, and across it with the ray at (0, 0). */
typedef struct sk_view {
    float a0, a1, a2, x0, x1, x2, y0, y1, y2;
} sk_view;

/** The vertices of a triangle along a ray's axes kx, ky and kz, and its number: 48 bytes, so that other work-items can read it from local memory. */
typedef struct SK_ALIGNED(16) sk_corners {
    float x0, x1, x2, y0, y1, y2, z0, z1, z2;
    sk_u32 number, unused_0, unused_1;
} sk_corners;

/**
 * Those of vertices[first + 3 * stride * k], vertices[first + 3 * stride * k + stride], … for vertex k: stride 1 for packed
 * triangles, more where triangles lie side by side.
 */
SK_FUNCTION sk_corners sk_load_corners(sk_u32 kx, sk_u32 ky, sk_u32 kz, SK_GLOBAL const float* vertices, sk_u32 first, sk_u32 stride) {
    SK_GLOBAL const float* x = vertices + (first + kx * stride);
    SK_GLOBAL const float* y = vertices + (first + ky * stride);
    SK_GLOBAL const float* z = vertices + (first + kz * stride);
    const sk_u32 next = 3u * stride;
    sk_corners r;
    r.x0 = x[0];
    r.x1 = x[next];
    r.x2 = x[2u * next];
    r.y0 = y[0];
    r.y1 = y[next];
    r.y2 = y[2u * next];
    r.z0 = z[0];
    r.z1 = z[next];
    r.z2 = z[2u * next];
    r.number = SETKA_NO_HIT;
    r.unused_0 = 0u;
    r.unused_1 = 0u;
    return r;
}

SK_FUNCTION sk_view sk_view_corners(sk_viewpoint from, sk_corners c) {
    sk_view r;
    r.a0 = c.z0 - from.oz;
    r.a1 = c.z1 - from.oz;
    r.a2 = c.z2 - from.oz;
    r.x0 = (c.x0 - from.ox) - from.sx * r.a0;
    r.y0 = (c.y0 - from.oy) - from.sy * r.a0;
    r.x1 = (c.x1 - from.ox) - from.sx * r.a1;
    r.y1 = (c.y1 - from.oy) - from.sy * r.a1;
    r.x2 = (c.x2 - from.ox) - from.sx * r.a2;
    r.y2 = (c.y2 - from.oy) - from.sy * r.a2;
    return r;
}

/** Vertices as for sk_load_corners. */
SK_FUNCTION sk_view sk_view_triangle(sk_viewpoint from, SK_GLOBAL const float* vertices, sk_u32 first, sk_u32 stride) {
    return sk_view_corners(from, sk_load_corners(from.kx, from.ky, from.kz, vertices, first, stride));
}

/** 0 if the ray passes beside the triangle, by plain edge functions, whose signs are never wrong. */
SK_FUNCTION int sk_may_pass(sk_view p) {
    return !sk_mixed_signs(p.x2 * p.y1 - p.y2 * p.x1, p.x0 * p.y2 - p.y0 * p.x2, p.x1 * p.y0 - p.y1 * p.x0);
}

/** The best of `best` and the hit of triangle `number`, of which this is the view; that it may be hit is known. */
SK_FUNCTION sk_best sk_test_view(sk_working_ray ray, sk_view p, sk_u32 number, sk_best best) {
    const float unit = ray.unit;
    const float p0 = p.x0 * unit, p1 = p.x1 * unit, p2 = p.x2 * unit;
    const float q0 = p.y0 * unit, q1 = p.y1 * unit, q2 = p.y2 * unit;
    const float u = sk_accurate_difference(p2, q1, q2, p1);
    const float v = sk_accurate_difference(p0, q2, q0, p2);
    const float w = sk_accurate_difference(p1, q0, q1, p0);
    const int side = sk_side(u, p1, q1, p2, q2);
    sk_best r = best;
    if (side != 0 && side == sk_side(v, p2, q2, p0, q0) && side == sk_side(w, p0, q0, p1, q1)) {
        const float det = (u + v) + w;
        const float at = ((u * (ray.sz * p.a0) + v * (ray.sz * p.a1)) + w * (ray.sz * p.a2)) / det;
        const float t = sk_user_t(ray, at);
        if (t >= ray.tmin && t <= ray.tmax && sk_is_finite(t) &&
            (at < best.w || (at == best.w && number < best.triangle) || best.triangle == SETKA_NO_HIT)) {
            r.w = at;
            r.u = sk_positive_zero(v / det);
            r.v = sk_positive_zero(w / det);
            r.triangle = number;
        }
    }
    return r;
}

/** The best of `best` and the hit of triangle `number`, with vertices as for sk_load_corners. */
SK_FUNCTION sk_best sk_test_triangle(sk_working_ray ray, SK_GLOBAL const float* vertices, sk_u32 first, sk_u32 stride,
                                     sk_u32 number, sk_best best) {
    const sk_view p = sk_view_triangle(sk_viewpoint_of(ray), vertices, first, stride);
    sk_best r = best;
    if (sk_may_pass(p)) r = sk_test_view(ray, p, number, best);
    return r;
}

/** 1 if the query sees the instance of this triangle. */
SK_FUNCTION int sk_is_visible(sk_trace_params params, SK_GLOBAL const sk_u32* instance_starts,
                              SK_GLOBAL const SetkaInstance* instances, sk_u32 triangle) {
    int visible = 1;
    if (params.filters != 0u) {
        const sk_u32 instance = sk_find_segment(instance_starts, params.instance_count, triangle);
        visible = (instances[instance].mask & params.mask) != 0u;
    }
    return visible;
}

/** The scene triangle that ray i passes through, or SETKA_NO_HIT: what names no triangle of the scene skips nothing. */
SK_FUNCTION sk_u32 sk_skipped_triangle(sk_trace_params params, SK_GLOBAL const sk_u32* instance_starts,
                                       SK_GLOBAL const SetkaPrimitive* skip, sk_u32 i) {
    sk_u32 triangle = SETKA_NO_HIT;
    if (params.skips != 0u) {
        const sk_u32 instance = skip[i].instance, primitive = skip[i].primitive;
        if (instance < params.instance_count) {
            const sk_u32 first = instance_starts[instance];
            if (primitive < instance_starts[instance + 1u] - first) triangle = first + primitive;
        }
    }
    return triangle;
}

SK_FUNCTION sk_best sk_no_hit(void) {
    sk_best r;
    r.w = 3e38f;
    r.u = 0.0f;
    r.v = 0.0f;
    r.triangle = SETKA_NO_HIT;
    return r;
}

/** The public record of a hit of a scene triangle, or of none. */
SK_FUNCTION SetkaHit sk_name_hit(sk_trace_params params, SK_GLOBAL const sk_u32* instance_starts, float t, float u, float v,
                                 sk_u32 triangle) {
    SetkaHit hit;
    hit.t = sk_bits_float(0x7f800000u);
    hit.u = 0.0f;
    hit.v = 0.0f;
    hit.primitive = SETKA_NO_HIT;
    hit.instance = SETKA_NO_HIT;
    if (triangle != SETKA_NO_HIT) {
        hit.t = t;
        hit.u = u;
        hit.v = v;
        hit.instance = sk_find_segment(instance_starts, params.instance_count, triangle);
        hit.primitive = triangle - instance_starts[hit.instance];
    }
    return hit;
}

/** The same of a best hit. */
SK_FUNCTION SetkaHit sk_make_hit(sk_trace_params params, sk_working_ray ray, SK_GLOBAL const sk_u32* instance_starts,
                                 sk_best best) {
    return sk_name_hit(params, instance_starts, sk_user_t(ray, best.w), best.u, best.v, best.triangle);
}

#endif
