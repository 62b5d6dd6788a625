/* SPDX-License-Identifier: MIT */
/**
 * Does each of SK_WIDTH rays hit its triangle, and where? The test of triangle.h, a ray in each lane, by the
 * same operations in the same order. The plain test has one triangle for all of them, as loading one takes as
 * long as testing it; the accurate one a triangle of its own in each lane.
 */
#ifndef SETKA_DEVICE_TRACE_TRIANGLE_LANES_H
#define SETKA_DEVICE_TRACE_TRIANGLE_LANES_H

#include "device/trace/ray_lanes.h"
#include "device/trace/triangle.h"

typedef struct sk_best_lanes {
    sk_fN w, u, v;
    sk_iN triangle; /* SETKA_NO_HIT: none yet */
} sk_best_lanes;

typedef struct sk_pair_lanes {
    sk_fN value, error;
} sk_pair_lanes;

typedef struct sk_view_lanes {
    sk_fN a0, a1, a2, x0, x1, x2, y0, y1, y2;
} sk_view_lanes;

SK_FUNCTION sk_pair_lanes sk_two_product_lanes(sk_fN a, sk_fN b) {
    sk_pair_lanes r;
    const sk_fN ca = 4097.0f * a, cb = 4097.0f * b;
    const sk_fN ah = ca - (ca - a), bh = cb - (cb - b);
    const sk_fN al = a - ah, bl = b - bh;
    r.value = a * b;
    r.error = (((ah * bh - r.value) + ah * bl) + al * bh) + al * bl;
    return r;
}

SK_FUNCTION sk_pair_lanes sk_two_difference_lanes(sk_fN x, sk_fN y) {
    sk_pair_lanes r;
    r.value = x - y;
    const sk_fN t = r.value - x;
    r.error = (x - (r.value - t)) - (y + t);
    return r;
}

SK_FUNCTION sk_pair_lanes sk_two_sum_lanes(sk_fN x, sk_fN y) {
    sk_pair_lanes r;
    r.value = x + y;
    const sk_fN t = r.value - x;
    r.error = (x - (r.value - t)) + (y - t);
    return r;
}

SK_FUNCTION sk_fN sk_accurate_difference_lanes(sk_fN a, sk_fN b, sk_fN c, sk_fN d) {
    const sk_pair_lanes p = sk_two_product_lanes(a, b), q = sk_two_product_lanes(c, d);
    const sk_pair_lanes s = sk_two_difference_lanes(p.value, q.value);
    const sk_pair_lanes f = sk_two_difference_lanes(p.error, q.error);
    const sk_pair_lanes r = sk_two_sum_lanes(s.value, f.value);
    return r.value + (r.error + (s.error + f.error));
}

/** -1 where a < b, 1 where a > b, else 0. */
SK_FUNCTION sk_iN sk_order_lanes(sk_fN a, sk_fN b) { return (a < b) - (a > b); }

SK_FUNCTION sk_iN sk_side_lanes(sk_fN edge, sk_fN xa, sk_fN ya, sk_fN xb, sk_fN yb) {
    const sk_fN zero = sk_same_f(0.0f);
    return sk_select_i(edge != zero, sk_order_lanes(edge, zero),
                       sk_select_i(ya != yb, sk_order_lanes(yb, ya), sk_order_lanes(xa, xb)));
}

/** The view of a triangle whose vertices, seen from the ray's origin, have these components along kx, ky and
 * kz. */
SK_FUNCTION sk_view_lanes sk_shear_lanes(sk_ray_lanes ray, sk_vec3N v0, sk_vec3N v1, sk_vec3N v2) {
    sk_view_lanes r;
    r.a0 = v0.z;
    r.a1 = v1.z;
    r.a2 = v2.z;
    r.x0 = v0.x - ray.sx * v0.z;
    r.y0 = v0.y - ray.sy * v0.z;
    r.x1 = v1.x - ray.sx * v1.z;
    r.y1 = v1.y - ray.sy * v1.z;
    r.x2 = v2.x - ray.sx * v2.z;
    r.y2 = v2.y - ray.sy * v2.z;
    return r;
}

/** Triangles `number` of the table as their rays see them. */
SK_FUNCTION sk_view_lanes sk_view_triangle_lanes(sk_ray_lanes ray, SK_GLOBAL const float* triangles,
                                                 sk_iN number) {
    const sk_columns p = sk_gather4(triangles, number, 9u), q = sk_gather4(triangles + 4, number, 9u);
    const sk_fN last = sk_gather_f(triangles + 8, number, 9u); /* in the midst of a test that is better than sk_gather9() */
    return sk_shear_lanes(ray, sk_turn_axes(ray, sk_make3_f(p.a - ray.o.x, p.b - ray.o.y, p.c - ray.o.z)),
                          sk_turn_axes(ray, sk_make3_f(p.d - ray.o.x, q.a - ray.o.y, q.b - ray.o.z)),
                          sk_turn_axes(ray, sk_make3_f(q.c - ray.o.x, q.d - ray.o.y, last - ray.o.z)));
}

/** Axes of rays that go along the same one, and their origins along them. */
typedef struct sk_viewpoint_lanes {
    sk_vec3N o;
    sk_u32 kx, ky, kz;
} sk_viewpoint_lanes;

/** A vertex as all rays see it. */
SK_FUNCTION sk_vec3N sk_view_vertex(sk_viewpoint_lanes from, SK_GLOBAL const float* vertex) {
    return sk_make3_f(vertex[from.kx] - from.o.x, vertex[from.ky] - from.o.y, vertex[from.kz] - from.o.z);
}

/** One triangle as all rays see it; of use for those that go along `from`'s axis. */
SK_FUNCTION sk_view_lanes sk_view_one_triangle(sk_ray_lanes ray, sk_viewpoint_lanes from,
                                               SK_GLOBAL const float* vertices) {
    return sk_shear_lanes(ray, sk_view_vertex(from, vertices), sk_view_vertex(from, vertices + 3),
                          sk_view_vertex(from, vertices + 6));
}

/** sk_may_pass in a few operations less: set also where U, V or W is NaN, which the accurate test then
 * refuses. */
SK_FUNCTION sk_iN sk_may_pass_lanes(sk_view_lanes p) {
    const sk_fN u = p.x2 * p.y1 - p.y2 * p.x1, v = p.x0 * p.y2 - p.y0 * p.x2, w = p.x1 * p.y0 - p.y1 * p.x0;
    const sk_fN zero = sk_same_f(0.0f);
    return ~((sk_min_f(sk_min_f(u, v), w) < zero) & (sk_max_f(sk_max_f(u, v), w) > zero));
}

/** The parameter of the hit of each view, and whether it is one: that it is the best is not asked here. */
typedef struct sk_hit_lanes {
    sk_fN w, u, v;
    sk_iN hits;
} sk_hit_lanes;

SK_FUNCTION sk_hit_lanes sk_test_view_lanes(sk_ray_lanes ray, float unit, sk_view_lanes p) {
    const sk_fN p0 = p.x0 * unit, p1 = p.x1 * unit, p2 = p.x2 * unit;
    const sk_fN q0 = p.y0 * unit, q1 = p.y1 * unit, q2 = p.y2 * unit;
    const sk_fN u = sk_accurate_difference_lanes(p2, q1, q2, p1);
    const sk_fN v = sk_accurate_difference_lanes(p0, q2, q0, p2);
    const sk_fN w = sk_accurate_difference_lanes(p1, q0, q1, p0);
    const sk_iN side = sk_side_lanes(u, p1, q1, p2, q2);
    const sk_fN det = (u + v) + w;
    const sk_fN at = ((u * (ray.sz * p.a0) + v * (ray.sz * p.a1)) + w * (ray.sz * p.a2)) / det;
    const sk_fN t = sk_user_t_lanes(ray, at);
    sk_hit_lanes r;
    r.w = at;
    r.u = sk_positive_zero_f(v / det);
    r.v = sk_positive_zero_f(w / det);
    r.hits = (side != sk_same_i(0)) & (side == sk_side_lanes(v, p2, q2, p0, q0)) &
             (side == sk_side_lanes(w, p0, q0, p1, q1)) & (t >= ray.tmin) & (t <= ray.tmax) & sk_finite_f(t);
    return r;
}

/** Whether the hit is before the best, or is the first. */
SK_FUNCTION sk_iN sk_is_better_lanes(sk_hit_lanes hit, sk_iN number, sk_best_lanes best) {
    const sk_i32 sign = (sk_i32)0x80000000u; /* numbers are unsigned; lanes compare as signed */
    const sk_iN before = (number ^ sign) < (best.triangle ^ sign);
    return (hit.w < best.w) | ((hit.w == best.w) & before) |
           (best.triangle == sk_same_i((sk_i32)SETKA_NO_HIT));
}

SK_FUNCTION sk_best_lanes sk_no_hit_lanes(void) {
    const sk_best none = sk_no_hit();
    sk_best_lanes r;
    r.w = sk_same_f(none.w);
    r.u = sk_same_f(none.u);
    r.v = sk_same_f(none.v);
    r.triangle = sk_same_i((sk_i32)none.triangle);
    return r;
}

#endif
