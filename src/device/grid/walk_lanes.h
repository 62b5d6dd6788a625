/* SPDX-License-Identifier: MIT */
/**
 * What do SK_WIDTH rays hit in the grid, where one work-item has vector registers for all of them? The walk
 * of walk.h, with a ray in each lane, in a cell and at a list of its own. Lanes that stand at a list wait
 * until all do; then each tests the next triangle of its list until all are through. Every ray and triangle
 * sees the operations of ray.h and triangle.h, so that the hits are the same.
 */
#ifndef SETKA_DEVICE_GRID_WALK_LANES_H
#define SETKA_DEVICE_GRID_WALK_LANES_H

#include "device/grid/walk.h"
#include "device/trace/triangle_lanes.h"

/** sk_axis in lanes. */
typedef struct sk_axis_lanes {
    sk_fN origin, speed, inverse;
    sk_iN index, last, flip;
} sk_axis_lanes;

typedef struct sk_place_lanes {
    sk_axis_lanes x, y, z;
    sk_iN cube; /* the width in cells less one of the cube to leave next: 0, 3 or 15 */
} sk_place_lanes;

/** sk_cell, also of NaN. */
SK_FUNCTION sk_iN sk_cell_lanes(sk_fN f, sk_i32 dim) {
    const sk_fN zero = sk_same_f(0.0f), top = sk_same_f((float)(dim - 1));
    const sk_fN positive = sk_select_f(f > zero, f, zero);
    return sk_lanes_to_int(sk_select_f(positive < top, positive, top));
}

SK_FUNCTION sk_axis_lanes sk_make_axis_lanes(SetkaGridHeader grid, sk_u32 axis, sk_fN o, sk_fN d,
                                             sk_fN inverse, sk_fN start) {
    const sk_i32 dim = (sk_i32)grid.dims[axis];
    const sk_fN zero = sk_same_f(0.0f), direction = d * grid.inverse_cell_size;
    const sk_fN origin = (o - grid.origin[axis]) * grid.inverse_cell_size;
    const sk_iN parallel = d == zero;
    sk_axis_lanes r;
    r.speed = sk_select_f(parallel, zero, sk_abs_f(direction));
    r.inverse = sk_select_f(parallel, sk_same_f(SK_PARALLEL_INVERSE), sk_abs_f(inverse) * grid.cell_size);
    r.flip = direction >= zero;
    r.origin = sk_select_f(r.flip, -origin, origin);
    r.index = sk_cell_lanes(origin + direction * start, dim) ^ r.flip;
    r.last = sk_select_i(parallel, r.index, r.flip & ~(dim - 1));
    return r;
}

/** sk_exit_of, of the cube from `low` on. */
SK_FUNCTION sk_fN sk_exit_lanes(sk_axis_lanes a, sk_iN low) {
    return sk_select_f(low > a.last, a.origin - sk_lanes_to_float(low), sk_same_f(SK_NEVER)) * a.inverse;
}

/** The index after a step: behind the cube's face where the ray leaves it `through` this axis, else as
 * sk_land says. */
SK_FUNCTION sk_iN sk_land_lanes(sk_axis_lanes a, sk_iN low, sk_iN through, sk_fN w) {
    const sk_fN index = sk_lanes_to_float(a.index), end = sk_lanes_to_float(sk_max_i(low, a.last));
    const sk_fN at = a.origin - w * a.speed;
    const sk_fN ahead = sk_select_f(at < index, at, index), inside = sk_select_f(ahead > end, ahead, end);
    const sk_iN cell = sk_lanes_to_int(inside);
    return sk_select_i(through, low - 1,
                       cell + (sk_lanes_to_float(cell) > inside)); /* rounded down: a mask is -1 */
}

/** sk_leave for the lanes in `moving`. The mask of those that have not come to their end. */
SK_FUNCTION sk_iN sk_leave_lanes(sk_place_lanes* at, sk_iN moving, sk_fN last) {
    const sk_iN low_x = at->x.index & ~at->cube, low_y = at->y.index & ~at->cube,
                low_z = at->z.index & ~at->cube;
    const sk_fN wx = sk_exit_lanes(at->x, low_x), wy = sk_exit_lanes(at->y, low_y),
                wz = sk_exit_lanes(at->z, low_z);
    const sk_iN through_x = (wx <= wy) & (wx <= wz), through_y = ~through_x & (wy <= wz);
    const sk_fN w = sk_select_f(through_x, wx, sk_select_f(through_y, wy, wz));
    const sk_iN goes = moving & ~(last <= w);
    at->x.index = sk_select_i(goes, sk_land_lanes(at->x, low_x, through_x, w), at->x.index);
    at->y.index = sk_select_i(goes, sk_land_lanes(at->y, low_y, through_y, w), at->y.index);
    at->z.index = sk_select_i(goes, sk_land_lanes(at->z, low_z, ~(through_x | through_y), w), at->z.index);
    return goes;
}

/** A cell's block and its bit there. */
typedef struct sk_found_lanes {
    sk_iN mask_low, mask_high, first;
    sk_iN bit;
} sk_found_lanes;

SK_FUNCTION sk_found_lanes sk_find_blocks(SetkaGridHeader grid, sk_grid_tables tables, sk_iN x, sk_iN y,
                                          sk_iN z) {
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid));
    const sk_iN number = ((z >> 2) * (sk_i32)dims.y + (y >> 2)) * (sk_i32)dims.x + (x >> 2);
    const sk_columns block = sk_gather4((SK_GLOBAL const float*)tables.blocks, number, 4u);
    sk_found_lanes r;
    r.mask_low = sk_lanes_as_int(block.a);
    r.mask_high = sk_lanes_as_int(block.b);
    r.first = sk_lanes_as_int(block.c);
    r.bit = (z & 3) * 16 + (y & 3) * 4 + (x & 3);
    return r;
}

/** The mask of lanes whose cell has a list; finds how large a cube the others may leave. */
SK_FUNCTION sk_iN sk_look_lanes(SetkaGridHeader grid, sk_grid_tables tables, sk_place_lanes* at) {
    const sk_iN zero = sk_same_i(0);
    const sk_iN x = at->x.index ^ at->x.flip, y = at->y.index ^ at->y.flip, z = at->z.index ^ at->z.flip;
    const sk_found_lanes in = sk_find_blocks(grid, tables, x, y, z);
    const sk_iN empty = (in.mask_low | in.mask_high) == zero;
    const sk_iN word = sk_select_i(in.bit > sk_same_i(31), in.mask_high, in.mask_low);
    at->cube = empty & 3;
    if (sk_any_lane(empty)) {
        const sk_dims dims = sk_block_dims(sk_block_dims(sk_cell_dims(grid)));
        const sk_iN group = ((z >> 4) * (sk_i32)dims.y + (y >> 4)) * (sk_i32)dims.x + (x >> 4);
        const sk_iN blocks =
            sk_gather_i(tables.groups, group, 2u) | sk_gather_i(tables.groups + 1, group, 2u);
        at->cube = at->cube | ((blocks == zero) & 15);
    }
    return (word >> (in.bit & 31) & 1) != zero;
}

/** How many bits are set in each lane. */
SK_FUNCTION sk_iN sk_count_bits(sk_iN a) {
    const sk_iN pairs = a - ((a >> 1) & 0x55555555);
    const sk_iN nibbles = (pairs & 0x33333333) + ((pairs >> 2) & 0x33333333);
    return (((nibbles + (nibbles >> 4)) & 0x0f0f0f0f) * 0x01010101) >> 24;
}

/** Triangles references[here .. end) for each lane. */
typedef struct sk_lists {
    sk_iN here, end;
} sk_lists;

/** The lists of the lanes that have one, else empty ones. */
SK_FUNCTION sk_lists sk_open_lists(SetkaGridHeader grid, sk_grid_tables tables, sk_place_lanes at,
                                   sk_iN listed) {
    const sk_found_lanes in =
        sk_find_blocks(grid, tables, at.x.index ^ at.x.flip, at.y.index ^ at.y.flip, at.z.index ^ at.z.flip);
    const sk_iN below = (sk_same_i(1) << (in.bit & 31)) - 1, in_high = in.bit > sk_same_i(31);
    const sk_iN rank =
        sk_count_bits(in.mask_low & (below | in_high)) + sk_count_bits(in.mask_high & below & in_high);
    const sk_iN record = listed & (in.first + rank);
    SK_GLOBAL const sk_u32* records = (SK_GLOBAL const sk_u32*)tables.cells;
    sk_lists r;
    r.here = listed & sk_gather_i(records, record, 2u);
    r.end = r.here + (listed & sk_gather_i(records + 1, record, 2u));
    return r;
}

/** sk_limit in lanes. */
SK_FUNCTION sk_span_lanes sk_limit_lanes(sk_ray_lanes ray) {
    const sk_fN to_w = sk_lanes_as_float((254 << 23) - sk_lanes_as_int(ray.scale));
    const sk_fN pre = sk_lanes_as_float((254 << 23) - sk_lanes_as_int(ray.pre));
    const sk_fN a = (ray.tmin * to_w) * pre, b = (ray.tmax * to_w) * pre;
    const sk_fN step = 0x1p-148f * pre, coarse = step + step * to_w;
    const sk_fN start = (a - ray.shift) - ((sk_abs_f(a) + sk_abs_f(ray.shift)) * 0x1p-20f + coarse);
    const sk_fN end = (b - ray.shift) + ((sk_abs_f(b) + sk_abs_f(ray.shift)) * 0x1p-20f + coarse);
    sk_span_lanes r;
    r.w0 = sk_select_f(start > ray.w0, start, ray.w0);
    r.w1 = sk_select_f(end < ray.w1, end, ray.w1);
    r.meets = ray.valid & (r.w0 <= r.w1);
    return r;
}

/** SK_WIDTH rays on their way. */
typedef struct sk_flight {
    sk_ray_lanes ray;
    sk_place_lanes at;
    sk_best_lanes best;
    sk_fN w1, last; /* the end of the ray; nothing beyond `last` is of interest */
    sk_iN walking;  /* mask: has not come to its end */
    sk_iN listed;   /* mask: stands at a cell with a list that is not tested */
    sk_iN skip;
} sk_flight;

SK_FUNCTION sk_flight sk_take_off(SetkaGridHeader grid, sk_grid_tables tables, sk_ray_lanes ray, sk_iN skip) {
    const sk_span_lanes span = sk_limit_lanes(ray);
    sk_flight r;
    r.ray = ray;
    r.at.x = sk_make_axis_lanes(grid, 0u, ray.o.x, ray.d.x, ray.inverse.x, span.w0);
    r.at.y = sk_make_axis_lanes(grid, 1u, ray.o.y, ray.d.y, ray.inverse.y, span.w0);
    r.at.z = sk_make_axis_lanes(grid, 2u, ray.o.z, ray.d.z, ray.inverse.z, span.w0);
    r.at.cube = sk_same_i(0);
    r.best = sk_no_hit_lanes();
    r.w1 = span.w1;
    r.last = span.w1;
    r.walking = span.meets;
    r.listed = sk_same_i(0);
    r.skip = skip;
    if (sk_any_lane(r.walking)) r.listed = r.walking & sk_look_lanes(grid, tables, &r.at);
    return r;
}

/** Moves each lane to a cell with a list, or to its end. */
SK_FUNCTION void sk_step_lanes(SetkaGridHeader grid, sk_grid_tables tables, sk_flight* f) {
    sk_iN moving = f->walking & ~f->listed;
    while (sk_any_lane(moving)) {
        const sk_iN goes = sk_leave_lanes(&f->at, moving, f->last);
        const sk_iN cube = f->at.cube;
        const sk_iN found = goes & sk_look_lanes(grid, tables, &f->at);
        f->at.cube = sk_select_i(goes, f->at.cube, cube);
        f->walking = f->walking & (goes | ~moving);
        f->listed = f->listed | found;
        moving = goes & ~found;
    }
}

/** The best of `best` and the hits of the triangles `number`; none where that is SETKA_NO_HIT. */
SK_FUNCTION sk_best_lanes sk_test_candidates(sk_grid_tables tables, sk_trace_params params, sk_ray_lanes ray,
                                             sk_iN number, sk_best_lanes best) {
    const sk_iN some = number != sk_same_i((sk_i32)SETKA_NO_HIT);
    const sk_hit_lanes hit =
        sk_test_view_lanes(ray, params.unit, sk_view_triangle_lanes(ray, tables.triangles, number & some));
    sk_iN better = some & hit.hits & sk_is_better_lanes(hit, number, best);
    if (params.filters != 0u) {
#define SK_VISIBLE(k)                                                                             \
    (sk_lane(better, k) != 0 &&                                                                   \
     sk_is_visible(params, tables.instance_starts, tables.instances, (sk_u32)sk_lane(number, k))) \
        ? -1                                                                                      \
        : 0
        better = SK_INTS(SK_VISIBLE);
#undef SK_VISIBLE
    }
    sk_best_lanes r;
    r.w = sk_select_f(better, hit.w, best.w);
    r.u = sk_select_f(better, hit.u, best.u);
    r.v = sk_select_f(better, hit.v, best.v);
    r.triangle = sk_select_i(better, number, best.triangle);
    return r;
}

/**
 * Tests the lists of all lanes, the next triangle of each at a time. The accurate test is long and few
 * triangles come to it, so a lane's candidate waits until the lists are through, or the lane has another.
 */
SK_FUNCTION sk_best_lanes sk_test_lists(sk_grid_tables tables, sk_trace_params params, sk_ray_lanes ray,
                                        sk_iN skip, sk_lists lists, sk_best_lanes best) {
    const sk_iN none = sk_same_i((sk_i32)SETKA_NO_HIT);
    sk_best_lanes r = best;
    sk_iN candidate = none, here = lists.here, testing = here != lists.end;
    do {
        sk_iN next = none;
        while (sk_any_lane(testing) && !sk_any_lane(next != none)) {
            const sk_iN number = sk_gather_i(tables.references, here & testing, 1u);
            const sk_iN passes = testing & (number != skip) &
                                 sk_may_pass_lanes(sk_view_triangle_lanes(ray, tables.triangles, number));
            next = sk_select_i(passes & (candidate != none), number, none);
            candidate = sk_select_i(passes & (candidate == none), number, candidate);
            here = here - testing; /* a mask is -1 */
            testing = here != lists.end;
        }
        if (sk_any_lane(candidate != none)) r = sk_test_candidates(tables, params, ray, candidate, r);
        candidate = next;
    } while (sk_any_lane(testing) || sk_any_lane(candidate != none));
    return r;
}

/**
 * Walks the grid, past empty space in large steps and past the triangles `skip`. `any`, a compile-time choice
 * of the entry, ends a lane at the first hit it finds.
 */
SK_FUNCTION sk_best_lanes sk_walk_grid_lanes(SetkaGridHeader grid, sk_trace_params params, sk_ray_lanes ray,
                                             sk_grid_tables tables, sk_iN skip, const int any) {
    sk_flight f = sk_take_off(grid, tables, ray, skip);
    while (sk_any_lane(f.walking)) {
        sk_step_lanes(grid, tables, &f);
        if (sk_any_lane(f.listed)) {
            const sk_lists lists = sk_open_lists(grid, tables, f.at, f.listed);
            f.best = sk_test_lists(tables, params, f.ray, f.skip, lists, f.best);
            f.listed = sk_same_i(0);
            const sk_iN found = f.best.triangle != sk_same_i((sk_i32)SETKA_NO_HIT);
            f.last = sk_select_f(found, sk_min_f(f.best.w, f.w1), f.w1);
            if (any) f.walking = f.walking & ~found;
        }
    }
    return f.best;
}

#endif
