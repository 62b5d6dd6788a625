/* SPDX-License-Identifier: MIT */
/**
 * Which cells does a ray pass, and what does it hit in them? The walk through the uniform grid, with two rules for the next
 * cell: the smallest of three exit parameters (Amanatides & Woo 1987), and the signs of cross products without a branch or a
 * division (Maltsev & Mikhaylyuk 2012, section 3). src/README.md ("Traversal") has the argument why neither misses a hit.
 */
#ifndef SETKA_DEVICE_GRID_WALK_H
#define SETKA_DEVICE_GRID_WALK_H

#include "device/grid/cells.h"
#include "device/trace/triangle.h"

/**
 * The distance in cells to a face that is never reached: far beyond a ray's way through the scene's box, which is a few times
 * 4096 cells, and small enough that a product with a speed in cells cannot overflow (cells are at least 2^-80 wide).
 */
#define SK_NEVER 0x1p30f
/** What turns SK_NEVER into a parameter beyond any other for an axis that the ray is parallel to. */
#define SK_PARALLEL_INVERSE 0x1p90f

typedef struct sk_walk {
    sk_best best;
    SetkaTraceCost cost;
} sk_walk;

/**
 * One axis of the walk: o + w * d in cells. `exit` is the way to the face through which the ray leaves cell `index`, measured from the
 * origin and so without accumulated error. Outermost cells reach on forever: what lies in the scene's padded box but
 * outside the grid belongs to them.
 */
typedef struct sk_axis {
    float origin;
    float speed;    /* |d|, 0 if parallel */
    float inverse;  /* 1 / |d|, huge if parallel */
    int forward;
    sk_u32 dim, index;
} sk_axis;

SK_FUNCTION sk_axis sk_make_axis(float origin, float direction, float working_direction, float start, sk_u32 dim) {
    sk_axis r;
    const int parallel = working_direction == 0.0f;
    r.origin = origin;
    r.speed = parallel ? 0.0f : sk_abs(direction);
    r.inverse = parallel ? SK_PARALLEL_INVERSE : 1.0f / r.speed;
    r.forward = direction >= 0.0f;
    r.dim = dim;
    r.index = sk_cell(origin + direction * start, dim);
    return r;
}

SK_FUNCTION float sk_exit(sk_axis a) {
    const float face = a.forward ? (float)(a.index + 1u) - a.origin : a.origin - (float)a.index;
    const int outermost = a.index == (a.forward ? a.dim - 1u : 0u);
    return outermost || a.speed == 0.0f ? SK_NEVER : face;
}

/** The paper's S: 1 for negative numbers, else 0. */
SK_FUNCTION sk_u32 sk_negative(float f) { return (sk_u32)(f < 0.0f); }

SK_FUNCTION sk_u32 sk_advance(sk_axis a, sk_u32 steps) { return a.forward ? a.index + steps : a.index - steps; }

/** The working interval that the user's tmin and tmax leave, widened by what rounding may take. */
SK_FUNCTION sk_span sk_limit(sk_working_ray ray) {
    sk_span r;
    const float to_w = 1.0f / ray.scale, pre = 1.0f / ray.pre;
    const float a = (ray.tmin * to_w) * pre, b = (ray.tmax * to_w) * pre;
    /* Where t is subnormal its rounding is absolute; in working parameters that may be much. */
    const float step = 0x1p-148f * pre, coarse = step + step * to_w;
    const float start = (a - ray.shift) - ((sk_abs(a) + sk_abs(ray.shift)) * 0x1p-20f + coarse);
    const float end = (b - ray.shift) + ((sk_abs(b) + sk_abs(ray.shift)) * 0x1p-20f + coarse);
    /* NaN from infinite limits compares false and leaves the box's interval. */
    r.w0 = start > ray.w0 ? start : ray.w0;
    r.w1 = end < ray.w1 ? end : ray.w1;
    r.meets = ray.valid && r.w0 <= r.w1;
    return r;
}

/**
 * Walks the grid, past the triangle `skip`. `branch_free` and `any` are compile-time choices of the entry: the paper's step, and to stop at the first
 * hit. The loop ends: each turn at least one index moves towards its last value, where its exit is out of reach.
 */
SK_FUNCTION sk_walk sk_walk_grid(SetkaGridHeader grid, sk_trace_params params, sk_working_ray ray,
                                 SK_GLOBAL const sk_i32* offsets, SK_GLOBAL const sk_u32* counts,
                                 SK_GLOBAL const sk_u32* references, SK_GLOBAL const float* triangles,
                                 SK_GLOBAL const sk_u32* instance_starts, SK_GLOBAL const SetkaInstance* instances,
                                 sk_u32 skip, const int branch_free, const int any) {
    const sk_span span = sk_limit(ray);
    const sk_vec3 o = sk_to_cells(grid, ray.o), d = sk_scale(ray.d, grid.inverse_cell_size);
    sk_axis x = sk_make_axis(o.x, d.x, ray.d.x, span.w0, grid.dims[0]);
    sk_axis y = sk_make_axis(o.y, d.y, ray.d.y, span.w0, grid.dims[1]);
    sk_axis z = sk_make_axis(o.z, d.z, ray.d.z, span.w0, grid.dims[2]);
    int walking = span.meets;
    sk_walk r;
    r.best = sk_no_hit();
    r.cost.steps = 0u;
    r.cost.tests = 0u;
    while (walking) {
        const sk_u32 cell = (z.index * grid.dims[1] + y.index) * grid.dims[0] + x.index;
        const sk_i32 offset = offsets[cell];
        r.cost.steps += 1u;
        if (offset >= 0) {
            const sk_u32 count = counts[cell];
            for (sk_u32 k = 0u; k < count; ++k) {
                const sk_u32 number = references[(sk_u32)offset + k];
                const sk_best next = sk_test_triangle(ray, triangles + (size_t)number * 9u, 1u, number, r.best);
                if (next.triangle != r.best.triangle && number != skip &&
                    sk_is_visible(params, instance_starts, instances, number))
                    r.best = next;
            }
            r.cost.tests += count;
        }
        const float ex = sk_exit(x), ey = sk_exit(y), ez = sk_exit(z);
        const int found = r.best.triangle != SETKA_NO_HIT;
        /* Nothing beyond this parameter is of interest. */
        const float last = found ? sk_min(r.best.w, span.w1) : span.w1;
        if (branch_free) {
            const float xy = x.speed * ey - y.speed * ex;
            const float xz = x.speed * ez - z.speed * ex;
            const float yz = y.speed * ez - z.speed * ey;
            if (last * x.speed <= ex && last * y.speed <= ey && last * z.speed <= ez) {
                walking = 0;
            } else {
                x.index = sk_advance(x, (1u - sk_negative(xy)) * (1u - sk_negative(xz)));
                y.index = sk_advance(y, (1u - sk_negative(-xy)) * (1u - sk_negative(yz)));
                z.index = sk_advance(z, (1u - sk_negative(-xz)) * (1u - sk_negative(-yz)));
            }
        } else {
            const float wx = ex * x.inverse, wy = ey * y.inverse, wz = ez * z.inverse;
            if (last <= wx && last <= wy && last <= wz) {
                walking = 0;
            } else if (wx <= wy && wx <= wz) {
                x.index = sk_advance(x, 1u);
            } else if (wy <= wz) {
                y.index = sk_advance(y, 1u);
            } else {
                z.index = sk_advance(z, 1u);
            }
        }
        if (any && found) walking = 0;
    }
    return r;
}

#endif
