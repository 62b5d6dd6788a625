/* SPDX-License-Identifier: MIT */
/**
 * What surface does a hit lie on? Its point, its geometric and its shading normal, and where new rays may
 * start without meeting the surface that they leave.
 */
#ifndef SETKA_DEVICE_SHADE_SURFACE_H
#define SETKA_DEVICE_SHADE_SURFACE_H

#include "device/math.h"
#include "device/shade/layout.h"

/* New rays start this share of the triangle's largest coordinate off it: 64 roundings of a point in it. */
#define SK_OFFSET_SHARE 0x1p-18f
/* The least cosine of the shading normal with the direction to the viewer, unless the triangle's is less. */
#define SK_LEAST_COSINE 0x1p-6f

typedef struct sk_measured {
    sk_vec3 unit;
    float length;
} sk_measured;

SK_FUNCTION sk_vec3 sk_negate(sk_vec3 a) { return sk_make3(-a.x, -a.y, -a.z); }

/** Direction and length of a finite vector; no square overflows or underflows. Both 0 for the zero vector. */
SK_FUNCTION sk_measured sk_measure(sk_vec3 a) {
    sk_measured r;
    const float largest = sk_largest(a);
    r.unit = sk_make3(0.0f, 0.0f, 0.0f);
    r.length = 0.0f;
    if (largest > 0.0f && sk_is_finite(largest)) {
        const sk_vec3 s = sk_make3(a.x / largest, a.y / largest, a.z / largest);
        const float length = sk_length(s);
        r.unit = sk_make3(s.x / length, s.y / length, s.z / length);
        r.length = length * largest;
    }
    return r;
}

/** How normals move with an affine map: by the cofactors of its 3 x 3 part, here up to a positive factor. */
typedef struct sk_normal_map {
    sk_vec3 x, y, z;
    float determinant;
} sk_normal_map;

SK_FUNCTION sk_normal_map sk_make_normal_map(SK_GLOBAL const float* m) {
    sk_normal_map r;
    sk_vec3 a = sk_make3(m[0], m[1], m[2]), b = sk_make3(m[4], m[5], m[6]), c = sk_make3(m[8], m[9], m[10]);
    const float largest = sk_max(sk_max(sk_largest(a), sk_largest(b)), sk_largest(c));
    if (largest > 0.0f) { /* so that products of a very small or large matrix stay in range */
        a = sk_make3(a.x / largest, a.y / largest, a.z / largest);
        b = sk_make3(b.x / largest, b.y / largest, b.z / largest);
        c = sk_make3(c.x / largest, c.y / largest, c.z / largest);
    }
    r.x = sk_cross3(b, c);
    r.y = sk_cross3(c, a);
    r.z = sk_cross3(a, b);
    r.determinant = sk_dot3(a, r.x);
    return r;
}

/** The world-space unit normal of a vertex, or `other` if it has none. */
SK_FUNCTION sk_vec3 sk_vertex_normal(sk_normal_map map, sk_vec3 n, sk_vec3 other) {
    const sk_measured r = sk_measure(sk_make3(sk_dot3(map.x, n), sk_dot3(map.y, n), sk_dot3(map.z, n)));
    return r.length > 0.0f ? r.unit : other;
}

/** How far `p` lies below the plane through a vertex across its normal, along that normal; 0 above it. */
SK_FUNCTION sk_vec3 sk_rise(sk_vec3 p, sk_vec3 vertex, sk_vec3 normal) {
    const float height = sk_dot3(sk_sub(p, vertex), normal);
    return sk_scale(normal, height < 0.0f ? -height : 0.0f);
}

SK_FUNCTION sk_vec3 sk_blend3(sk_vec3 a, float wa, sk_vec3 b, float wb, sk_vec3 c, float wc) {
    return sk_add(sk_add(sk_scale(a, wa), sk_scale(b, wb)), sk_scale(c, wc));
}

/** `v` turned as little as needed for dot(v, axis) >= least; for unit vectors and the least's small values.
 */
SK_FUNCTION sk_vec3 sk_bend_towards(sk_vec3 v, sk_vec3 axis, float least) {
    const float d = sk_dot3(v, axis);
    return d < least ? sk_unit(sk_add(v, sk_scale(axis, least - d))) : v;
}

SK_FUNCTION SkSurfacePoint sk_no_surface(void) {
    SkSurfacePoint r;
    sk_u32 k;
    for (k = 0u; k < 3u; ++k) r.position[k] = r.normal[k] = r.geometric[k] = r.light_origin[k] = 0.0f;
    for (k = 0u; k < 3u; ++k) r.tint[k] = 1.0f;
    r.offset = 0.0f;
    r.cosine = 0.0f;
    r.material = SETKA_NO_HIT;
    r.inside = 0u;
    return r;
}

/**
 * The surface at `hit` of a ray with the unit direction `direction`. `triangles` are the scene's in world
 * space; `offset` is the least distance from the surface at which new rays start.
 *
 * Rays start off the surface by a distance that grows with the coordinates of the triangle, and so with the
 * rounding of the point and of the next intersection test, not with the scene's size alone: small things on a
 * vast ground keep their contact shadows.
 *
 * Shadow rays of a smooth-shaded triangle start from where the smooth surface would bulge out of it, as its
 * vertex normals tell (Hanika, "Hacking the shadow terminator", Ray Tracing Gems II, 2021); starting in the
 * triangle they would draw the polygons' outline where the light grazes the mesh.
 */
SK_FUNCTION SkSurfacePoint sk_surface_point(sk_vec3 direction, SetkaHit hit,
                                            SK_GLOBAL const SetkaInstance* instances,
                                            SK_GLOBAL const sk_u32* instance_starts,
                                            SK_GLOBAL const sk_u32* indices, SK_GLOBAL const float* normals,
                                            SK_GLOBAL const float* colors, SK_GLOBAL const float* triangles,
                                            float offset) {
    SkSurfacePoint r;
    SK_GLOBAL const SetkaInstance* instance = instances + hit.instance;
    SK_GLOBAL const float* corners = triangles + (size_t)(instance_starts[hit.instance] + hit.primitive) * 9u;
    const sk_vec3 a = sk_load3(corners), b = sk_load3(corners + 3), c = sk_load3(corners + 6);
    const sk_vec3 ab = sk_sub(b, a), ac = sk_sub(c, a), viewer = sk_negate(direction);
    const float w = (1.0f - hit.u) - hit.v;
    const sk_vec3 position = sk_add(a, sk_add(sk_scale(ab, hit.u), sk_scale(ac, hit.v)));
    const sk_normal_map map = sk_make_normal_map(instance->matrix);
    /* Unit edges: their product keeps its direction for triangles of any size. */
    const sk_measured across = sk_measure(sk_cross3(sk_measure(ab).unit, sk_measure(ac).unit));
    const int back = sk_dot3(across.unit, direction) > 0.0f;
    sk_vec3 geometric = back ? sk_negate(across.unit) : across.unit;
    sk_vec3 normal, rise = sk_make3(0.0f, 0.0f, 0.0f), tint = sk_make3(1.0f, 1.0f, 1.0f);
    SK_GLOBAL const sk_u32* corner = indices + (size_t)(instance->first_index + hit.primitive) * 3u;
    const sk_u32 first = instance->first_vertex;
    float reach;
    if (!(across.length > 0.0f)) geometric = viewer;
    normal = geometric;

    if (instance->flags & SETKA_INSTANCE_HAS_NORMALS) {
        sk_vec3 na = sk_vertex_normal(map, sk_load3(normals + (size_t)(first + corner[0]) * 3u), geometric);
        sk_vec3 nb = sk_vertex_normal(map, sk_load3(normals + (size_t)(first + corner[1]) * 3u), geometric);
        sk_vec3 nc = sk_vertex_normal(map, sk_load3(normals + (size_t)(first + corner[2]) * 3u), geometric);
        const sk_measured mean = sk_measure(sk_blend3(na, w, nb, hit.u, nc, hit.v));
        if (mean.length > 0.0f) {
            /* Files disagree about which way normals point; the side that is seen decides. */
            const int flip = sk_dot3(mean.unit, geometric) < 0.0f;
            normal = flip ? sk_negate(mean.unit) : mean.unit;
            na = flip ? sk_negate(na) : na;
            nb = flip ? sk_negate(nb) : nb;
            nc = flip ? sk_negate(nc) : nc;
            /* Where a normal turns away from its own triangle there is no smooth surface to rise to. */
            if (sk_dot3(na, geometric) > 0.0f && sk_dot3(nb, geometric) > 0.0f &&
                sk_dot3(nc, geometric) > 0.0f)
                rise = sk_blend3(sk_rise(position, a, na), w, sk_rise(position, b, nb), hit.u,
                                 sk_rise(position, c, nc), hit.v);
        }
    }
    if (instance->flags & SETKA_INSTANCE_HAS_COLORS)
        tint = sk_blend3(sk_load3(colors + (size_t)(first + corner[0]) * 3u), w,
                         sk_load3(colors + (size_t)(first + corner[1]) * 3u), hit.u,
                         sk_load3(colors + (size_t)(first + corner[2]) * 3u), hit.v);
    /* A flat surface is never bent: it has no other side to show. */
    normal = sk_bend_towards(normal, viewer, sk_min(SK_LEAST_COSINE, sk_dot3(geometric, viewer)));

    reach = offset + SK_OFFSET_SHARE * sk_max(sk_max(sk_largest(a), sk_largest(b)), sk_largest(c));
    r.position[0] = position.x;
    r.position[1] = position.y;
    r.position[2] = position.z;
    r.offset = reach;
    r.normal[0] = normal.x;
    r.normal[1] = normal.y;
    r.normal[2] = normal.z;
    r.cosine = sk_dot3(normal, viewer);
    r.geometric[0] = geometric.x;
    r.geometric[1] = geometric.y;
    r.geometric[2] = geometric.z;
    r.material = instance->material;
    r.light_origin[0] = (position.x + rise.x) + geometric.x * reach;
    r.light_origin[1] = (position.y + rise.y) + geometric.y * reach;
    r.light_origin[2] = (position.z + rise.z) + geometric.z * reach;
    /* A reflecting matrix turns every triangle's winding around, but not the mesh inside out. */
    r.inside = (back != 0) != (map.determinant < 0.0f) ? 1u : 0u;
    r.tint[0] = tint.x;
    r.tint[1] = tint.y;
    r.tint[2] = tint.z;
    return r;
}

#endif
