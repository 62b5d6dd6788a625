/* SPDX-License-Identifier: MIT */
/**
 * What do rays hit in the grid, where one work-item has vector registers for SK_WIDTH of them? The walk of walk.h, with a ray in each
 * lane and in a cell of its own. A work-item has SK_FLIGHTS vectors of rays on their way, and takes all of them through one stage of a turn
 * after the other: a look at the cells they have come to, the lists there, the triangles that may be hit, a step on. A stage of one flight
 * waits for memory, and for the one before; those of the others do not depend on it, so that the processor can begin them meanwhile. Every
 * ray and triangle sees the operations of ray.h and triangle.h, so that the hits are the same.
 */
#ifndef SETKA_DEVICE_GRID_WALK_LANES_H
#define SETKA_DEVICE_GRID_WALK_LANES_H

#include "device/grid/walk.h"
#include "device/trace/params.h"
#include "device/trace/triangle_lanes.h"

/** sk_axis in lanes. */
typedef struct sk_axis_lanes {
    sk_fN origin, speed, inverse;
    sk_iN index, last, flip;
} sk_axis_lanes;

typedef struct sk_place_lanes {
    sk_axis_lanes x, y, z;
    sk_iN cube; /* to leave next: that of sk_low_of */
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
    const sk_iN mask = ~(at->cube & 3), back = at->cube & ~3;
    const sk_iN low_x = (at->x.index & mask) - back, low_y = (at->y.index & mask) - back,
                low_z = (at->z.index & mask) - back;
    const sk_fN wx = sk_exit_lanes(at->x, low_x), wy = sk_exit_lanes(at->y, low_y),
                wz = sk_exit_lanes(at->z, low_z);
    const sk_fN w = sk_min_f(sk_min_f(wx, wy), wz);
    const sk_iN through_x = wx == w, through_y = ~through_x & (wy == w);
    const sk_iN goes = moving & ~(last <= w);
    at->x.index = sk_select_i(goes, sk_land_lanes(at->x, low_x, through_x, w), at->x.index);
    at->y.index = sk_select_i(goes, sk_land_lanes(at->y, low_y, through_y, w), at->y.index);
    at->z.index = sk_select_i(goes, sk_land_lanes(at->z, low_z, ~(through_x | through_y), w), at->z.index);
    return goes;
}

/** A cell's block and its bit there. */
typedef struct sk_found_lanes {
    sk_iN mask_low, mask_high, first, clearance;
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
    r.clearance = sk_lanes_as_int(block.d);
    r.bit = (z & 3) * 16 + (y & 3) * 4 + (x & 3);
    return r;
}

/** Which lanes' cells have a list, and where it is. */
typedef struct sk_listed_lanes {
    sk_iN some; /* mask */
    sk_found_lanes in;
} sk_listed_lanes;

/** Looks for lists, and how large a cube the lanes may leave that have none. */
SK_FUNCTION sk_listed_lanes sk_look_lanes(SetkaGridHeader grid, sk_grid_tables tables, sk_place_lanes* at) {
    const sk_iN zero = sk_same_i(0);
    const sk_iN x = at->x.index ^ at->x.flip, y = at->y.index ^ at->y.flip, z = at->z.index ^ at->z.flip;
    sk_listed_lanes r;
    r.in = sk_find_blocks(grid, tables, x, y, z);
    const sk_iN word = sk_select_i(r.in.bit > sk_same_i(31), r.in.mask_high, r.in.mask_low);
    const sk_iN eight = word >> (r.in.bit & SK_FIRST_OF_EIGHT) & SK_EIGHT_CELLS; /* those around the cell */
    at->cube = ((eight == zero) & 1) | r.in.clearance;
    r.some = (word >> (r.in.bit & 31) & 1) != zero;
    return r;
}

/** How many bits are set in each lane. */
SK_FUNCTION sk_iN sk_count_bits(sk_iN a) {
    const sk_iN pairs = a - ((a >> 1) & 0x55555555);
    const sk_iN nibbles = (pairs & 0x33333333) + ((pairs >> 2) & 0x33333333);
    return (((nibbles + (nibbles >> 4)) & 0x0f0f0f0f) * 0x01010101) >> 24;
}

/** The numbers of the lists' records. */
SK_FUNCTION sk_iN sk_records_of(sk_found_lanes in) {
    const sk_iN below = (sk_same_i(1) << (in.bit & 31)) - 1, in_high = in.bit > sk_same_i(31);
    return in.first + sk_count_bits(in.mask_low & (below | in_high)) +
           sk_count_bits(in.mask_high & below & in_high);
}

/** sk_limit in lanes. */
SK_FUNCTION sk_span_lanes sk_limit_lanes(sk_ray_lanes ray) {
    const sk_fN to_w = sk_lanes_as_float((254 << 23) - sk_lanes_as_int(ray.scale));
    const sk_fN pre = sk_lanes_as_float((254 << 23) - sk_lanes_as_int(ray.pre));
    const sk_fN a = (ray.tmin * to_w) * pre, b = (ray.tmax * to_w) * pre;
    const sk_fN step = 0x1p-100f * pre, coarse = step + step * to_w;
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
    sk_iN number; /* of the rays */
    sk_ray_lanes ray;
    sk_vec3N o; /* the ray's, along its kx, ky and kz */
    sk_iN kz;
    sk_iN skip;
    sk_fN start, end, last; /* nothing before or beyond is of interest; the end with the best hit */
    sk_iN walking;
    sk_place_lanes at;
    sk_best_lanes best;
    sk_iN listed;               /* lanes that have come to a list, */
    sk_found_lanes found;       /* and where it is */
    sk_iN candidates, offset;   /* bit k: the lane's ray may hit triangle references[offset + k] */
} sk_flight;

SK_FUNCTION void sk_take_off(sk_flight* f, sk_iN number, sk_ray_lanes ray, sk_iN skip) {
    const sk_span_lanes span = sk_limit_lanes(ray);
    f->number = number;
    f->ray = ray;
    f->o = sk_turn_axes(ray, ray.o);
    f->kz = sk_select_i(ray.along_x, sk_same_i(0), sk_select_i(ray.along_y, sk_same_i(1), sk_same_i(2)));
    f->skip = skip;
    f->start = span.w0;
    f->end = span.w1;
    f->last = span.w1;
    f->walking = span.meets;
    f->best = sk_no_hit_lanes();
}

/** Puts the rays into their first cells. */
SK_FUNCTION void sk_enter_lanes(sk_flight* f, SetkaGridHeader grid) {
    f->at.x = sk_make_axis_lanes(grid, 0u, f->ray.o.x, f->ray.d.x, f->ray.inverse.x, f->start);
    f->at.y = sk_make_axis_lanes(grid, 1u, f->ray.o.y, f->ray.d.y, f->ray.inverse.y, f->start);
    f->at.z = sk_make_axis_lanes(grid, 2u, f->ray.o.z, f->ray.d.z, f->ray.inverse.z, f->start);
    f->at.cube = sk_same_i(0);
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

/** Nothing behind the best hits is of interest; with `any` nothing at all. */
SK_FUNCTION void sk_take_best(sk_flight* f, const int any) {
    const sk_iN found = f->best.triangle != sk_same_i((sk_i32)SETKA_NO_HIT);
    f->last = sk_select_f(found, sk_min_f(f->best.w, f->end), f->end);
    if (any) f->walking = f->walking & ~found;
}

/** Bit k of a lane: its ray may hit triangle references[k]; of `count` triangles, up to 32. */
SK_FUNCTION sk_iN sk_test_one_list(sk_grid_tables tables, sk_ray_lanes ray, sk_viewpoint_lanes from,
                                   SK_GLOBAL const sk_u32* references, sk_u32 count) {
    sk_iN r = sk_same_i(0);
    for (sk_u32 k = 0u; k < count; ++k) {
        SK_GLOBAL const float* vertices = tables.triangles + (size_t)references[k] * 9u;
        r = r | (sk_may_pass_lanes(sk_view_one_triangle(ray, from, vertices)) & (sk_i32)(1u << k));
    }
    return r;
}

/** Tests the candidates of each lane, each in its turn. */
SK_FUNCTION void sk_test_all_candidates(sk_grid_tables tables, sk_trace_params params, sk_flight* f, sk_iN candidates,
                                        sk_iN offset) {
    while (sk_any_lane(candidates)) {
        const sk_iN some = candidates != sk_same_i(0);
        const sk_iN number = sk_gather_i(tables.references, (offset + sk_lowest_bits(candidates)) & some, 1u);
        f->best = sk_test_candidates(
            tables, params, f->ray,
            sk_select_i(some & (number != f->skip), number, sk_same_i((sk_i32)SETKA_NO_HIT)), f->best);
        candidates = candidates & (candidates - 1);
    }
}

/** A list that rays of a flight have come to whose directions have the same largest axis. */
typedef struct sk_task {
    sk_cell_list list;
    sk_u32 flight, kz;
    sk_u32 lanes; /* bits: who is to be tested, if walking and of this axis */
} sk_task;

/** Adds the lists of flight `number` to `count` tasks; up to SK_WIDTH. Their number then. */
SK_FUNCTION sk_u32 sk_add_tasks(sk_grid_tables tables, sk_flight* flights, sk_u32 number, sk_task* tasks, sk_u32 count) {
    sk_flight* const f = flights + number;
    const sk_iN all_records = sk_records_of(f->found);
    sk_u32 waiting = sk_lane_bits(f->listed);
    sk_i32 axes[SK_WIDTH], records[SK_WIDTH];
    sk_store_i(f->kz, axes);
    sk_store_i(all_records, records);
    f->candidates = sk_same_i(0);
    f->offset = sk_same_i(0);
    while (waiting != 0u) {
        const sk_u32 lane = sk_popcount((waiting - 1u) & ~waiting), record = (sk_u32)records[lane];
        const sk_u32 lanes = waiting & sk_lane_bits((all_records == records[lane]) & (f->kz == axes[lane]));
        tasks[count].list = tables.cells[record];
        sk_prefetch(tables.references + tasks[count].list.offset);
        tasks[count].flight = number;
        tasks[count].kz = (sk_u32)axes[lane];
        tasks[count].lanes = lanes;
        count += 1u;
        waiting &= ~lanes;
    }
    return count;
}

/** The tasks between the one that is done and the one whose triangles are asked for. */
#define SK_TASKS_AHEAD 2u

SK_FUNCTION void sk_prefetch_list(sk_grid_tables tables, sk_cell_list list) {
    for (sk_u32 k = 0u; k < list.count && k < SK_ROUND; ++k) sk_prefetch(tables.triangles + (size_t)tables.references[list.offset + k] * 9u);
}

/**
 * Tests a list: which triangles are candidates. They go to the accurate test later, with those of the flight's other lists, since that is long
 * and few triangles come to it; at once only where a lane has some already, of another list or of triangles before.
 */
SK_FUNCTION void sk_do_task(sk_grid_tables tables, sk_trace_params params, sk_flight* flights, sk_task task) {
    sk_flight* const f = flights + task.flight;
#define SK_BIT_OF(k) 1 << (k)
    const sk_iN of_task = (sk_same_i((sk_i32)task.lanes) & SK_INTS(SK_BIT_OF)) != sk_same_i(0);
#undef SK_BIT_OF
    const sk_iN lanes = f->walking & of_task & (f->kz == (sk_i32)task.kz);
    sk_viewpoint_lanes from;
    from.o = f->o;
    from.kz = task.kz;
    from.kx = from.kz == 2u ? 0u : from.kz + 1u;
    from.ky = from.kx == 2u ? 0u : from.kx + 1u;
    for (sk_u32 first = 0u; first < task.list.count; first += SK_ROUND) {
        const sk_u32 start = task.list.offset + first, count = sk_min_u32(task.list.count - first, SK_ROUND);
        const sk_iN found = lanes & sk_test_one_list(tables, f->ray, from, tables.references + start, count);
        const sk_iN has_found = found != sk_same_i(0);
        if (sk_any_lane(f->candidates & has_found)) {
            sk_test_all_candidates(tables, params, f, f->candidates, f->offset);
            f->candidates = sk_same_i(0);
        }
        f->candidates = f->candidates | found;
        f->offset = sk_select_i(has_found, sk_same_i((sk_i32)start), f->offset);
    }
}

/**
 * Walks the grid with the first `count` flights, past empty space in large steps and past the triangle that each ray skips. `any`, a compile-time choice
 * of the entry, ends a lane at the first hit it finds. Which flights go through a stage is written down without branches.
 */
SK_FUNCTION void sk_walk_grid_lanes(SetkaGridHeader grid, sk_trace_params params, sk_flight* flights, sk_u32 count,
                                    sk_grid_tables tables, const int any) {
    sk_u32 walking[SK_FLIGHTS + 1u], listed[SK_FLIGHTS + 1u], hopeful[SK_FLIGHTS + 1u];
    sk_task tasks[SK_FLIGHTS * SK_WIDTH];
    sk_u32 walking_count = 0u;
    for (sk_u32 k = 0u; k < count; ++k) {
        const int walks = sk_any_lane(flights[k].walking);
        if (walks) sk_enter_lanes(flights + k, grid);
        walking[walking_count] = k;
        walking_count += walks ? 1u : 0u;
    }
    while (walking_count != 0u) {
        sk_u32 listed_count = 0u, task_count = 0u, hopeful_count = 0u, still_count = 0u;
        for (sk_u32 k = 0u; k < walking_count; ++k) {
            sk_flight* const f = flights + walking[k];
            const sk_listed_lanes lists = sk_look_lanes(grid, tables, &f->at);
            f->listed = f->walking & lists.some;
            f->found = lists.in;
            listed[listed_count] = walking[k];
            listed_count += sk_any_lane(f->listed) ? 1u : 0u;
        }
        for (sk_u32 k = 0u; k < listed_count; ++k)
            task_count = sk_add_tasks(tables, flights, listed[k], tasks, task_count);
        for (sk_u32 k = 0u; k < task_count; ++k) {
            if (params.triangle_count >= SK_FAR_TRIANGLES && k + SK_TASKS_AHEAD < task_count)
                sk_prefetch_list(tables, tasks[k + SK_TASKS_AHEAD].list);
            sk_do_task(tables, params, flights, tasks[k]);
        }
        for (sk_u32 k = 0u; k < listed_count; ++k) {
            hopeful[hopeful_count] = listed[k];
            hopeful_count += sk_any_lane(flights[listed[k]].candidates) ? 1u : 0u;
        }
        for (sk_u32 k = 0u; k < hopeful_count; ++k) {
            sk_flight* const f = flights + hopeful[k];
            sk_test_all_candidates(tables, params, f, f->candidates, f->offset);
        }
        for (sk_u32 k = 0u; k < listed_count; ++k) sk_take_best(flights + listed[k], any);
        for (sk_u32 k = 0u; k < walking_count; ++k) {
            const sk_u32 number = walking[k];
            sk_flight* const f = flights + number;
            f->walking = sk_leave_lanes(&f->at, f->walking, f->last);
            walking[still_count] = number;
            still_count += sk_any_lane(f->walking) ? 1u : 0u;
        }
        walking_count = still_count;
    }
}

#endif
