/* SPDX-License-Identifier: MIT */
/**
 * What does a ray look like to the kernels? The working ray: direction scaled by a power of two, origin brought near the scene,
 * interval clipped to the scene's box, constants of the triangle test. Every structure starts from it, so that what a ray hits
 * does not depend on the structure. src/README.md specifies every operation.
 */
#ifndef SETKA_DEVICE_TRACE_RAY_H
#define SETKA_DEVICE_TRACE_RAY_H

#include "device/math.h"
#include "device/trace/params.h"

/** Below this a component of a direction counts as 0 on the way to the scene: its inverse could overflow. */
#define SK_PARALLEL 0x1p-100f
/** Below this it counts as 0 at the scene, where it moves a ray by less than any rounding. */
#define SK_STRAIGHT 0x1p-48f
/** The most times that an origin is moved towards the scene. */
#define SK_APPROACHES 16u

typedef struct sk_working_ray {
    sk_vec3 o, d;
    sk_vec3 inverse;           /* 1 / d, 0 where d is below SK_PARALLEL */
    float w0, w1;              /* where the ray is in the scene's box */
    float pre, scale, shift;   /* t = ((w + shift) * pre) * scale */
    float tmin, tmax;          /* the user's */
    sk_u32 kx, ky, kz;         /* axes: kz is the direction's largest */
    float ox, oy, oz;          /* the origin along them */
    float sx, sy, sz;          /* shear */
    float unit;                /* a power of two that keeps products of coordinates from underflow and overflow */
    int valid;                 /* 0: the ray misses everything */
} sk_working_ray;

/** What the plain test of a triangle needs of a ray: 32 bytes, so that other work-items can read it from local memory. */
typedef struct SK_ALIGNED(16) sk_viewpoint {
    float ox, oy, oz;
    float sx, sy;
    sk_u32 kx, ky, kz;
} sk_viewpoint;

SK_FUNCTION sk_viewpoint sk_viewpoint_of(sk_working_ray ray) {
    sk_viewpoint r;
    r.ox = ray.ox;
    r.oy = ray.oy;
    r.oz = ray.oz;
    r.sx = ray.sx;
    r.sy = ray.sy;
    r.kx = ray.kx;
    r.ky = ray.ky;
    r.kz = ray.kz;
    return r;
}

typedef struct sk_span {
    float w0, w1;
    int meets;
} sk_span;

/** The user's parameter of a working one, never -0. */
SK_FUNCTION float sk_user_t(sk_working_ray r, float w) { return sk_positive_zero(((w + r.shift) * r.pre) * r.scale); }

/** 1 / d, or 0 where it could overflow. */
SK_FUNCTION float sk_inverse_of(float d) { return sk_abs(d) < SK_PARALLEL ? 0.0f : 1.0f / d; }

/** 1 / p for a power of two from 2^-126 to 2^126. */
SK_FUNCTION float sk_inverse_power(float p) { return sk_bits_float((254u << 23) - sk_float_bits(p)); }

/** Narrows `span` to where q + w * d lies in [-pad, size + pad]. `inverse` is sk_inverse_of(d). */
SK_FUNCTION sk_span sk_clip_axis(sk_span span, float q, float d, float inverse, float size, float pad) {
    const float top = size + pad;
    sk_span r = span;
    if (sk_abs(d) < SK_PARALLEL) {
        if (!(-pad <= q && q <= top)) r.meets = 0;
    } else {
        const float a = (-pad - q) * inverse, b = (top - q) * inverse;
        const float low = b < a ? b : a, high = b < a ? a : b;
        r.w0 = sk_max(r.w0, low);
        r.w1 = sk_min(r.w1, high);
    }
    return r;
}

SK_FUNCTION sk_span sk_clip_box(sk_trace_params params, sk_vec3 o, sk_vec3 d, sk_vec3 inverse) {
    sk_span r;
    r.w0 = sk_bits_float(0xff800000u); /* -infinity: origins may be as far away as floats go */
    r.w1 = sk_bits_float(0x7f800000u);
    r.meets = 1;
    r = sk_clip_axis(r, o.x - params.lower[0], d.x, inverse.x, params.size[0], params.pad);
    r = sk_clip_axis(r, o.y - params.lower[1], d.y, inverse.y, params.size[1], params.pad);
    r = sk_clip_axis(r, o.z - params.lower[2], d.z, inverse.z, params.size[2], params.pad);
    r.w0 = r.w0 - sk_abs(r.w0) * 0x1p-20f;
    r.w1 = r.w1 + sk_abs(r.w1) * 0x1p-20f;
    if (!(r.w0 <= r.w1)) r.meets = 0;
    return r;
}

/** The origin is more than about the scene's size away from it. */
SK_FUNCTION int sk_is_far(sk_trace_params params, sk_span span) {
    return span.w0 > params.extent || span.w1 < -params.extent;
}

SK_FUNCTION float sk_straighten(float d) { return sk_abs(d) < SK_STRAIGHT ? 0.0f : d; }

SK_FUNCTION sk_working_ray sk_prepare_ray(sk_trace_params params, SetkaRay ray) {
    sk_working_ray r;
    sk_span span;
    sk_vec3 o = sk_make3(ray.origin[0], ray.origin[1], ray.origin[2]);
    sk_vec3 d = sk_make3(ray.direction[0], ray.direction[1], ray.direction[2]);
    const float largest = sk_max(sk_max(sk_abs(d.x), sk_abs(d.y)), sk_abs(d.z));
    r.valid = sk_is_finite(o.x) && sk_is_finite(o.y) && sk_is_finite(o.z) && sk_is_finite(d.x) && sk_is_finite(d.y) &&
              sk_is_finite(d.z) && largest > 0.0f && ray.tmin <= ray.tmax;
    r.tmin = ray.tmin;
    r.tmax = ray.tmax;
    r.shift = 0.0f;
    /* Two exact steps, because 1 / 2^e itself may not be a float. */
    r.pre = largest < 0x1p-64f ? 0x1p96f : largest > 0x1p64f ? 0x1p-96f : 1.0f;
    r.scale = sk_bits_float((254u << 23) - (sk_float_bits(largest * r.pre) & 0x7f800000u));
    d = sk_scale(sk_scale(d, r.pre), r.scale);

    const sk_vec3 inverse = sk_make3(sk_inverse_of(d.x), sk_inverse_of(d.y), sk_inverse_of(d.z));
    span = sk_clip_box(params, o, d, inverse);
    /* A turn leaves an error of some 2^-20 of the distance: sixteen are more than any two floats need. */
    for (sk_u32 turn = 0u; turn < SK_APPROACHES && span.meets && sk_is_far(params, span); ++turn) {
        const float way = span.w0 > params.extent ? span.w0 : span.w1;
        o = sk_add(o, sk_scale(d, way));
        r.shift = r.shift + way;
        span = sk_clip_box(params, o, d, inverse);
    }
    r.valid = r.valid && span.meets && !sk_is_far(params, span);
    r.w0 = span.w0;
    r.w1 = span.w1;
    r.o = o;
    d = sk_make3(sk_straighten(d.x), sk_straighten(d.y), sk_straighten(d.z));
    r.d = d;
    r.inverse = inverse;
    r.unit = params.unit;

    const float ax = sk_abs(d.x), ay = sk_abs(d.y), az = sk_abs(d.z);
    r.kz = ax >= ay && ax >= az ? 0u : ay >= az ? 1u : 2u;
    r.kx = r.kz == 2u ? 0u : r.kz + 1u;
    r.ky = r.kx == 2u ? 0u : r.kx + 1u;
    r.ox = sk_component(o, r.kx);
    r.oy = sk_component(o, r.ky);
    r.oz = sk_component(o, r.kz);
    const float dz = sk_component(d, r.kz);
    r.sx = sk_component(d, r.kx) / dz;
    r.sy = sk_component(d, r.ky) / dz;
    r.sz = sk_component(inverse, r.kz); /* of the largest component, which is what it was */
    return r;
}

#endif
