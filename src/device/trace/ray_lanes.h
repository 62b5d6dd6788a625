/* SPDX-License-Identifier: MIT */
/**
 * What do SK_WIDTH rays look like to the kernels? The working rays of ray.h, one a lane, by the same
 * operations in the same order. Lanes are masked where ray.h branches.
 */
#ifndef SETKA_DEVICE_TRACE_RAY_LANES_H
#define SETKA_DEVICE_TRACE_RAY_LANES_H

#include "device/lanes.h"
#include "device/trace/ray.h"

typedef struct sk_ray_lanes {
    sk_vec3N o, d;
    sk_vec3N inverse;
    sk_fN w0, w1;
    sk_fN pre, scale, shift;
    sk_fN tmin, tmax;
    sk_iN along_x, along_y; /* masks: the direction's largest axis; z if neither */
    sk_fN sx, sy, sz;
    sk_iN valid;
} sk_ray_lanes;

typedef struct sk_span_lanes {
    sk_fN w0, w1;
    sk_iN meets;
} sk_span_lanes;

/** Components along kx, ky and kz. */
SK_FUNCTION sk_vec3N sk_turn_axes(sk_ray_lanes r, sk_vec3N a) {
    return sk_make3_f(sk_select_f(r.along_x, a.y, sk_select_f(r.along_y, a.z, a.x)),
                      sk_select_f(r.along_x, a.z, sk_select_f(r.along_y, a.x, a.y)),
                      sk_select_f(r.along_x, a.x, sk_select_f(r.along_y, a.y, a.z)));
}

SK_FUNCTION sk_fN sk_user_t_lanes(sk_ray_lanes r, sk_fN w) {
    return sk_positive_zero_f(((w + r.shift) * r.pre) * r.scale);
}

SK_FUNCTION sk_fN sk_inverse_lanes(sk_fN d) {
    return sk_select_f(sk_abs_f(d) < sk_same_f(SK_PARALLEL), sk_same_f(0.0f), 1.0f / d);
}

SK_FUNCTION sk_span_lanes sk_clip_axis_lanes(sk_span_lanes span, sk_fN q, sk_fN d, sk_fN inverse, float size,
                                             float pad) {
    const float top = size + pad;
    const sk_iN parallel = sk_abs_f(d) < sk_same_f(SK_PARALLEL);
    const sk_iN inside = (sk_same_f(-pad) <= q) & (q <= sk_same_f(top));
    const sk_fN a = (-pad - q) * inverse, b = (top - q) * inverse;
    const sk_fN low = sk_min_f(a, b), high = sk_select_f(b < a, a, b);
    sk_span_lanes r;
    r.meets = span.meets & (inside | ~parallel);
    r.w0 = sk_select_f(parallel, span.w0, sk_max_f(span.w0, low));
    r.w1 = sk_select_f(parallel, span.w1, sk_min_f(span.w1, high));
    return r;
}

SK_FUNCTION sk_span_lanes sk_clip_box_lanes(sk_trace_params params, sk_vec3N o, sk_vec3N d,
                                            sk_vec3N inverse) {
    sk_span_lanes r;
    r.w0 = sk_same_f(sk_bits_float(0xff800000u));
    r.w1 = sk_same_f(sk_bits_float(0x7f800000u));
    r.meets = sk_same_i(-1);
    r = sk_clip_axis_lanes(r, o.x - params.lower[0], d.x, inverse.x, params.size[0], params.pad);
    r = sk_clip_axis_lanes(r, o.y - params.lower[1], d.y, inverse.y, params.size[1], params.pad);
    r = sk_clip_axis_lanes(r, o.z - params.lower[2], d.z, inverse.z, params.size[2], params.pad);
    r.w0 = r.w0 - sk_abs_f(r.w0) * 0x1p-20f;
    r.w1 = r.w1 + sk_abs_f(r.w1) * 0x1p-20f;
    r.meets = r.meets & (r.w0 <= r.w1);
    return r;
}

SK_FUNCTION sk_iN sk_is_far_lanes(sk_trace_params params, sk_span_lanes span) {
    return (span.w0 > sk_same_f(params.extent)) | (span.w1 < sk_same_f(-params.extent));
}

SK_FUNCTION sk_fN sk_straighten_lanes(sk_fN d) {
    return sk_select_f(sk_abs_f(d) < sk_same_f(SK_STRAIGHT), sk_same_f(0.0f), d);
}

/** None of them is valid. */
SK_FUNCTION sk_ray_lanes sk_no_rays_lanes(void) {
    const sk_fN zero = sk_same_f(0.0f);
    const sk_iN none = sk_same_i(0);
    sk_ray_lanes r;
    r.o = r.d = r.inverse = sk_make3_f(zero, zero, zero);
    r.w0 = r.w1 = r.shift = r.tmin = r.tmax = r.sx = r.sy = r.sz = zero;
    r.pre = r.scale = sk_same_f(1.0f);
    r.along_x = r.along_y = r.valid = none;
    return r;
}

/** The working rays of rays[at]. */
SK_FUNCTION sk_ray_lanes sk_prepare_ray_lanes(sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                                              sk_iN at) {
    sk_ray_lanes r;
    const sk_columns start = sk_gather4((SK_GLOBAL const float*)rays, at, 8u);
    const sk_columns way_on = sk_gather4((SK_GLOBAL const float*)rays + 4, at, 8u);
    sk_vec3N o = sk_make3_f(start.a, start.b, start.c);
    sk_vec3N d = sk_make3_f(way_on.a, way_on.b, way_on.c);
    const sk_fN largest = sk_max_f(sk_max_f(sk_abs_f(d.x), sk_abs_f(d.y)), sk_abs_f(d.z));
    r.tmin = start.d;
    r.tmax = way_on.d;
    r.valid = sk_finite_f(o.x) & sk_finite_f(o.y) & sk_finite_f(o.z) & sk_finite_f(d.x) & sk_finite_f(d.y) &
              sk_finite_f(d.z) & (largest > sk_same_f(0.0f)) & (r.tmin <= r.tmax);
    if (!sk_any_lane(r.valid)) return sk_no_rays_lanes();
    r.shift = sk_same_f(0.0f);
    r.pre = sk_select_f(largest < sk_same_f(0x1p-64f), sk_same_f(0x1p96f),
                        sk_select_f(largest > sk_same_f(0x1p64f), sk_same_f(0x1p-96f), sk_same_f(1.0f)));
    r.scale = sk_lanes_as_float((254 << 23) - (sk_lanes_as_int(largest * r.pre) & 0x7f800000));
    d = sk_make3_f((d.x * r.pre) * r.scale, (d.y * r.pre) * r.scale, (d.z * r.pre) * r.scale);
    r.inverse = sk_make3_f(sk_inverse_lanes(d.x), sk_inverse_lanes(d.y), sk_inverse_lanes(d.z));
    sk_span_lanes span = sk_clip_box_lanes(params, o, d, r.inverse);
    sk_iN far = r.valid & span.meets & sk_is_far_lanes(params, span);
    for (sk_u32 turn = 0u; turn < SK_APPROACHES && sk_any_lane(far); ++turn) {
        const sk_fN way = sk_select_f(span.w0 > sk_same_f(params.extent), span.w0, span.w1);
        o.x = sk_select_f(far, o.x + d.x * way, o.x);
        o.y = sk_select_f(far, o.y + d.y * way, o.y);
        o.z = sk_select_f(far, o.z + d.z * way, o.z);
        r.shift = sk_select_f(far, r.shift + way, r.shift);
        span = sk_clip_box_lanes(params, o, d, r.inverse); /* the same as before where o is */
        far = far & span.meets & sk_is_far_lanes(params, span);
    }
    r.valid = r.valid & span.meets & ~sk_is_far_lanes(params, span);
    r.w0 = span.w0;
    r.w1 = span.w1;
    r.o = o;
    d = sk_make3_f(sk_straighten_lanes(d.x), sk_straighten_lanes(d.y), sk_straighten_lanes(d.z));
    r.d = d;

    const sk_fN ax = sk_abs_f(d.x), ay = sk_abs_f(d.y), az = sk_abs_f(d.z);
    r.along_x = (ax >= ay) & (ax >= az);
    r.along_y = ~r.along_x & (ay >= az);
    const sk_vec3N turned = sk_turn_axes(r, d);
    r.sx = turned.x / turned.z;
    r.sy = turned.y / turned.z;
    r.sz = sk_turn_axes(r, r.inverse).z;
    return r;
}

#endif
