/* SPDX-License-Identifier: MIT */
/**
 * Which cells does a ray pass, and what does it hit in them? Two walks through the uniform grid. One leaves a cell by the smallest
 * of three exit parameters (Amanatides & Woo 1987), and empty blocks of cells as if they were one; the other moves from cell to
 * cell by the signs of cross products, without a branch or a division (Maltsev & Mikhaylyuk 2012, section 3). src/README.md
 * ("Traversal") has the argument why neither misses a hit.
 */
#ifndef SETKA_DEVICE_GRID_WALK_H
#define SETKA_DEVICE_GRID_WALK_H

#include "device/grid/cells.h"
#include "device/grid/cell_list.h"

/**
 * The distance in cells to a face that is never reached: far beyond a ray's way through the scene's box, which is a few times
 * 4096 cells, and small enough that a product with a speed in cells cannot overflow (cells are at least 2^-80 wide).
 */
#define SK_NEVER 0x1p30f
/** What turns SK_NEVER into a parameter beyond any other for an axis that the ray is parallel to. */
#define SK_PARALLEL_INVERSE 0x1p90f

/** The most moves that a walk makes before it looks whether others of its group have a list to test. */
#define SK_TURNS 4u

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

/** The way to the face through which the ray leaves the cube of 2^shift cells around its cell. */
SK_FUNCTION float sk_exit_of(sk_axis a, sk_u32 shift) {
    const sk_u32 low = a.index >> shift << shift, high = low + (1u << shift);
    const float face = a.forward ? (float)high - a.origin : a.origin - (float)low;
    const int outermost = a.forward ? high >= a.dim : low == 0u;
    return outermost || a.speed == 0.0f ? SK_NEVER : face;
}

SK_FUNCTION float sk_exit(sk_axis a) { return sk_exit_of(a, 0u); }

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

/** Where a walk is. */
typedef struct sk_place {
    sk_axis x, y, z;
    int walking;
} sk_place;

SK_FUNCTION sk_place sk_enter(SetkaGridHeader grid, sk_working_ray ray, sk_span span) {
    const sk_vec3 o = sk_to_cells(grid, ray.o), d = sk_scale(ray.d, grid.inverse_cell_size);
    sk_place r;
    r.x = sk_make_axis(o.x, d.x, ray.d.x, span.w0, grid.dims[0]);
    r.y = sk_make_axis(o.y, d.y, ray.d.y, span.w0, grid.dims[1]);
    r.z = sk_make_axis(o.z, d.z, ray.d.z, span.w0, grid.dims[2]);
    r.walking = span.meets;
    return r;
}

/** What sk_clearance says of a cell that is not empty. */
#define SK_OCCUPIED 31u

/**
 * How large an empty cube around the cell the ray may leave in one step: 2^n cells wide for the n returned, or SK_OCCUPIED if the
 * cell has a list. Only what lies ahead has to be empty. `block` is the cell's.
 */
SK_FUNCTION sk_u32 sk_clearance(SetkaGridHeader grid, SK_GLOBAL const sk_u32* groups, sk_block block, sk_place at) {
    const sk_u32 x = at.x.index, y = at.y.index, z = at.z.index;
    const sk_u64 bits = sk_mask_of(block);
    sk_u32 shift = 2u;
    if (bits == 0u) {
        const sk_dims dims = sk_block_dims(sk_block_dims(sk_cell_dims(grid)));
        const sk_u32 group = 2u * sk_block_of(dims, x >> 2, y >> 2, z >> 2);
        const sk_u64 coarse = (sk_u64)groups[group] | (sk_u64)groups[group + 1u] << 32;
        const sk_u64 ahead = sk_bits_ahead(x >> 2, y >> 2, z >> 2, at.x.forward, at.y.forward, at.z.forward);
        if ((coarse & ahead) == 0u) shift = 4u;
    } else if (sk_has_bit(bits, sk_bit_in_block(x, y, z))) {
        shift = SK_OCCUPIED;
    } else if ((bits & sk_bits_ahead(x, y, z, at.x.forward, at.y.forward, at.z.forward)) != 0u) {
        shift = 0u;
    }
    return shift;
}

/**
 * The index on an axis at which the ray is at w, when it leaves a cube of 2^shift cells through a face of another axis: in the cube, and
 * never behind the index that it has, whatever rounding says.
 */
SK_FUNCTION sk_u32 sk_land(sk_axis a, sk_u32 shift, float w) {
    const sk_u32 low = a.index >> shift << shift, high = low + (1u << shift) - 1u;
    const float way = w * a.speed;
    const sk_u32 cell = sk_cell(a.forward ? a.origin + way : a.origin - way, a.dim);
    return a.forward ? sk_min_u32(sk_max_u32(cell, a.index), sk_min_u32(high, a.dim - 1u))
                     : sk_max_u32(sk_min_u32(cell, a.index), low);
}

/** The index behind the face through which the ray leaves the cube. */
SK_FUNCTION sk_u32 sk_pass(sk_axis a, sk_u32 shift) {
    const sk_u32 low = a.index >> shift << shift;
    return a.forward ? low + (1u << shift) : low - 1u;
}

/** Leaves the cube of 2^shift cells around the ray's cell, unless nothing of interest is beyond it. */
SK_FUNCTION sk_place sk_leave(sk_place at, sk_u32 shift, float last) {
    const float wx = sk_exit_of(at.x, shift) * at.x.inverse;
    const float wy = sk_exit_of(at.y, shift) * at.y.inverse;
    const float wz = sk_exit_of(at.z, shift) * at.z.inverse;
    const int through_x = wx <= wy && wx <= wz, through_y = !through_x && wy <= wz;
    const float w = through_x ? wx : through_y ? wy : wz;
    sk_place r = at;
    if (last <= w) {
        r.walking = 0;
    } else if (shift == 0u) {
        r.x.index = sk_advance(at.x, (sk_u32)through_x);
        r.y.index = sk_advance(at.y, (sk_u32)through_y);
        r.z.index = sk_advance(at.z, (sk_u32)(!through_x && !through_y));
    } else {
        r.x.index = through_x ? sk_pass(at.x, shift) : sk_land(at.x, shift, w);
        r.y.index = through_y ? sk_pass(at.y, shift) : sk_land(at.y, shift, w);
        r.z.index = through_x || through_y ? sk_land(at.z, shift, w) : sk_pass(at.z, shift);
    }
    return r;
}

/**
 * Walks the grid, past empty space in large steps and past the triangle `skip`. `any`, a compile-time choice of the entry, stops at the
 * first hit. The walk ends: each turn at least one index moves towards its last value, where its exit is out of reach,
 * and none moves back.
 */
SK_FUNCTION sk_walk sk_walk_grid(SetkaGridHeader grid, sk_trace_params params, sk_working_ray ray,
                                 sk_grid_tables tables, sk_u32 skip, const int any) {
    const sk_span span = sk_limit(ray);
    sk_place at = sk_enter(grid, ray, span);
    float last = span.w1; /* nothing beyond this parameter is of interest */
    sk_walk r;
    r.best = sk_no_hit();
    r.cost.steps = 0u;
    r.cost.tests = 0u;
    while (at.walking) {
        sk_u32 shift = 0u;
        sk_block block;
        /* Work-items that run in step wait for the last one here: not for long. */
        for (sk_u32 turn = 0u; turn < SK_TURNS && at.walking && shift != SK_OCCUPIED; ++turn) {
            block = sk_block_at(grid, tables, at.x.index, at.y.index, at.z.index);
            shift = sk_clearance(grid, tables.groups, block, at);
            r.cost.steps += 1u;
            if (shift != SK_OCCUPIED) at = sk_leave(at, shift, last);
        }
        if (shift == SK_OCCUPIED) {
            const sk_cell_list list =
                sk_find_list(tables, block, sk_bit_in_block(at.x.index, at.y.index, at.z.index));
            r.best = sk_test_cell(tables, params, ray, list, skip, r.best);
            r.cost.tests += list.count;
            const int found = r.best.triangle != SETKA_NO_HIT;
            if (found) last = sk_min(r.best.w, span.w1);
            at = sk_leave(at, 0u, last);
            if (any && found) at.walking = 0;
        }
    }
    return r;
}

/** The same from cell to cell, by the paper's rule. */
SK_FUNCTION sk_walk sk_walk_cells(SetkaGridHeader grid, sk_trace_params params, sk_working_ray ray,
                                  sk_grid_tables tables, sk_u32 skip, const int any) {
    const sk_span span = sk_limit(ray);
    sk_place at = sk_enter(grid, ray, span);
    sk_axis x = at.x, y = at.y, z = at.z;
    int walking = at.walking;
    sk_walk r;
    r.best = sk_no_hit();
    r.cost.steps = 0u;
    r.cost.tests = 0u;
    while (walking) {
        const sk_block block = sk_block_at(grid, tables, x.index, y.index, z.index);
        const sk_u32 bit = sk_bit_in_block(x.index, y.index, z.index);
        r.cost.steps += 1u;
        if (sk_has_bit(sk_mask_of(block), bit)) {
            const sk_cell_list list = sk_find_list(tables, block, bit);
            r.best = sk_test_cell(tables, params, ray, list, skip, r.best);
            r.cost.tests += list.count;
        }
        const float ex = sk_exit(x), ey = sk_exit(y), ez = sk_exit(z);
        const int found = r.best.triangle != SETKA_NO_HIT;
        const float last = found ? sk_min(r.best.w, span.w1) : span.w1;
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
        if (any && found) walking = 0;
    }
    return r;
}

#endif
