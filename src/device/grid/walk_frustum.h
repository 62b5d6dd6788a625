/* SPDX-License-Identifier: MIT */
/**
 * What do neighbouring rays hit in the grid? Rays that go much the same way pass the same cells. So the flights of a work-item whose rays all
 * have one largest axis, and go the same way along it, are taken through the grid as one frustum, slice by slice of cells across that axis, with the cells
 * in each that the frustum may touch (Wald, Ize, Kensler, Knoll & Parker 2006). No ray looks for its own cells. Each triangle is loaded once
 * for all rays, and asked first into which flights it reaches; their rays make the tests of triangle.h, so that the hits are the same: more
 * triangles are tested than those in a ray's own cells, but never less (src/README.md, "Traversal").
 */
#ifndef SETKA_DEVICE_GRID_WALK_FRUSTUM_H
#define SETKA_DEVICE_GRID_WALK_FRUSTUM_H

#include "device/grid/frustum.h"
#include "device/grid/walk_lanes.h"

/** The most cells across a frustum that is worth it, for each of its flights and as a mean of both ends. */
#define SK_FRUSTUM_CELLS 12.0f
/** The most blocks that it may touch in one slab of them. */
#define SK_FRUSTUM_BLOCKS 64u
/** How many lists are looked up before the first is read. */
#define SK_LISTS 32u
/** How many triangles a frustum remembers that it has tested, by their lowest bits. */
#define SK_MAILBOX 1024u

typedef struct sk_frustum {
    sk_u32 kx, ky, kz; /* kz: the axis that it goes along */
    sk_i32 flip;       /* -1 where it is mirrored: cell k is slice ~k; else 0 */
    float sign;        /* -1 or 1 */
    float start;       /* in cells along the way */
    sk_flanks x, y;    /* in cells */
    sk_u32 count;      /* of its flights */
    sk_u32 flights[SK_FLIGHTS];                           /* their numbers */
    sk_flanks flight_x[SK_FLIGHTS], flight_y[SK_FLIGHTS]; /* in the scene's units from the grid's origin on */
    sk_fN ends[SK_FLIGHTS];                               /* where each ray ends or has hit, in cells along the way */
    float last[SK_FLIGHTS];                               /* the last of those that walk */
} sk_frustum;

/** The least number of each of SK_FLIGHTS vectors. */
SK_FUNCTION void sk_min_of_each(const sk_fN* a, float* least) {
    for (sk_u32 k = 0u; k < SK_FLIGHTS; k += 4u) {
        const sk_columns turned = sk_turn_rows(a[k], a[k + 1u], a[k + 2u], a[k + 3u]);
        float v[SK_WIDTH];
        sk_store_f(sk_min_f(sk_min_f(turned.a, turned.b), sk_min_f(turned.c, turned.d)), v);
        for (sk_u32 i = 0u; i < 4u; ++i) {
            least[k + i] = v[i];
            for (sk_u32 lane = i + 4u; lane < SK_WIDTH; lane += 4u) least[k + i] = sk_min(least[k + i], v[lane]);
        }
    }
}

/** The least number of a vector. */
SK_FUNCTION float sk_min_lane(sk_fN a) {
    float v[SK_WIDTH];
    sk_store_f(a, v);
    for (sk_u32 n = SK_WIDTH / 2u; n > 0u; n /= 2u)
        for (sk_u32 k = 0u; k < n; ++k) v[k] = sk_min(v[k], v[k + n]);
    return v[0];
}
SK_FUNCTION float sk_max_lane(sk_fN a) { return -sk_min_lane(-a); }

/** The component of the rays along axis k. */
SK_FUNCTION sk_fN sk_along(sk_vec3N a, sk_u32 k) { return k == 0u ? a.x : k == 1u ? a.y : a.z; }

/** Bit 2 * axis + (1 where it goes down) for the ways that rays of a flight go. */
SK_FUNCTION sk_u32 sk_ways_of(const sk_flight* f) {
    const sk_iN way = sk_same_i(1) << (f->kz * 2 - (f->ray.sz < sk_same_f(0.0f))); /* a mask is -1 */
    return (sk_u32)sk_lanes_or(way & f->walking);
}

/** Notes where the rays of the frustum's flight j end. */
SK_FUNCTION void sk_note_ends(SetkaGridHeader grid, sk_frustum* t, sk_u32 j, const sk_flight* f) {
    const sk_fN end = (f->o.z - grid.origin[t->kz]) + f->last * sk_along(f->ray.d, t->kz);
    t->ends[j] = end * (grid.inverse_cell_size * t->sign) + SK_SLICE_PAD;
    t->last[j] = sk_max_lane(sk_select_f(f->walking, t->ends[j], sk_same_f(-SK_BEYOND)));
}

/** The last of all flights. */
SK_FUNCTION float sk_last_of(const sk_frustum* t) {
    float r = t->last[0];
    for (sk_u32 j = 1u; j < t->count; ++j) r = sk_max(r, t->last[j]);
    return r;
}

/** Makes a frustum of the flights in `group`, whose rays go `way`, a number of a bit of sk_ways_of(). Whether it is a slim one. */
SK_FUNCTION int sk_make_frustum(SetkaGridHeader grid, const sk_flight* flights, sk_u32 group, sk_u32 way, sk_frustum* t) {
    const sk_fN beyond = sk_same_f(SK_BEYOND);
    sk_fN starts = beyond, sides[8][SK_FLIGHTS]; /* x, -x, y and -y at the start, the same at the end */
    float least[8][SK_FLIGHTS], all[8];
    t->kz = way / 2u;
    t->kx = t->kz == 2u ? 0u : t->kz + 1u;
    t->ky = t->kx == 2u ? 0u : t->kx + 1u;
    t->flip = -(sk_i32)(way & 1u);
    t->sign = t->flip != 0 ? -1.0f : 1.0f;
    t->count = 0u;
    const float gx = grid.origin[t->kx], gy = grid.origin[t->ky], gz = grid.origin[t->kz], inverse = grid.inverse_cell_size;
    for (; group != 0u; group &= group - 1u) {
        const sk_u32 number = sk_lowest_bit(group);
        const sk_flight* const f = flights + number;
        const sk_fN z = ((f->o.z - gz) + f->start * sk_along(f->ray.d, t->kz)) * (inverse * t->sign);
        starts = sk_min_f(starts, sk_select_f(f->walking, z, beyond));
        sk_note_ends(grid, t, t->count, f);
        t->flights[t->count] = number;
        t->count += 1u;
    }
    const float start = sk_min_lane(starts) - SK_SLICE_PAD, length = sk_max(sk_last_of(t) - start, 1.0f), inverse_length = 1.0f / length;
    for (sk_u32 j = 0u; j < SK_FLIGHTS; ++j) {
        const sk_flight* const f = flights + t->flights[j < t->count ? j : 0u];
        const sk_fN to_start = start - (f->o.z - gz) * (inverse * t->sign);
        const sk_fN sx = f->ray.sx * t->sign, sy = f->ray.sy * t->sign;
        const sk_fN x0 = (f->o.x - gx) * inverse + to_start * sx, x1 = x0 + length * sx;
        const sk_fN y0 = (f->o.y - gy) * inverse + to_start * sy, y1 = y0 + length * sy;
        sides[0][j] = sk_select_f(f->walking, x0, beyond);
        sides[1][j] = sk_select_f(f->walking, -x0, beyond);
        sides[2][j] = sk_select_f(f->walking, y0, beyond);
        sides[3][j] = sk_select_f(f->walking, -y0, beyond);
        sides[4][j] = sk_select_f(f->walking, x1, beyond);
        sides[5][j] = sk_select_f(f->walking, -x1, beyond);
        sides[6][j] = sk_select_f(f->walking, y1, beyond);
        sides[7][j] = sk_select_f(f->walking, -y1, beyond);
    }
    for (sk_u32 i = 0u; i < 8u; ++i) {
        sk_min_of_each(sides[i], least[i]);
        all[i] = least[i][0];
        for (sk_u32 j = 1u; j < t->count; ++j) all[i] = sk_min(all[i], least[i][j]);
    }
    for (sk_u32 j = 0u; j < t->count; ++j) {
        t->flight_x[j] = sk_scale_flanks(sk_make_flanks(least[0][j], -least[1][j], least[4][j], -least[5][j], start, inverse_length), grid.cell_size);
        t->flight_y[j] = sk_scale_flanks(sk_make_flanks(least[2][j], -least[3][j], least[6][j], -least[7][j], start, inverse_length), grid.cell_size);
    }
    t->start = start;
    t->x = sk_make_flanks(all[0], -all[1], all[4], -all[5], start, inverse_length);
    t->y = sk_make_flanks(all[2], -all[3], all[6], -all[7], start, inverse_length);
    const float x0 = -all[1] - all[0], x1 = -all[5] - all[4], y0 = -all[3] - all[2], y1 = -all[7] - all[6];
    /* A slab of four slices moves a side by four cells at most, as slopes are up to 1. */
    const float most_x = sk_max(x0, x1) * 0.25f + 4.0f, most_y = sk_max(y0, y1) * 0.25f + 4.0f;
    return most_x * most_y <= (float)SK_FRUSTUM_BLOCKS &&
           (x0 + 1.0f) * (y0 + 1.0f) + (x1 + 1.0f) * (y1 + 1.0f) <= 2.0f * SK_FRUSTUM_CELLS * (float)t->count;
}

/** Boxes of SK_WIDTH triangles, in the scene's units from the grid's origin on: the least and the greatest, z along the frustum's way. */
typedef struct sk_triangle_boxes {
    sk_fN x[2], y[2], z[2];
} sk_triangle_boxes;

SK_FUNCTION void sk_span_of3(sk_fN a, sk_fN b, sk_fN c, sk_fN* ends) {
    ends[0] = sk_min_f(sk_min_f(a, b), c);
    ends[1] = sk_max_f(sk_max_f(a, b), c);
}

SK_FUNCTION sk_triangle_boxes sk_gather_triangle_boxes(SetkaGridHeader grid, sk_grid_tables tables, const sk_frustum* t,
                                                       const sk_u32* row) {
#define SK_NUMBER(k) (sk_i32)row[k]
    const sk_iN number = SK_INTS(SK_NUMBER);
#undef SK_NUMBER
    const sk_nine_columns c = sk_gather9(tables.triangles, number);
    sk_fN v[3][3]; /* of each axis, of each vertex */
    sk_triangle_boxes r;
    v[0][0] = c.first.a - grid.origin[0];
    v[1][0] = c.first.b - grid.origin[1];
    v[2][0] = c.first.c - grid.origin[2];
    v[0][1] = c.first.d - grid.origin[0];
    v[1][1] = c.next.a - grid.origin[1];
    v[2][1] = c.next.b - grid.origin[2];
    v[0][2] = c.next.c - grid.origin[0];
    v[1][2] = c.next.d - grid.origin[1];
    v[2][2] = c.last - grid.origin[2];
    sk_span_of3(v[t->kx][0], v[t->kx][1], v[t->kx][2], r.x);
    sk_span_of3(v[t->ky][0], v[t->ky][1], v[t->ky][2], r.y);
    sk_span_of3(v[t->kz][0] * t->sign, v[t->kz][1] * t->sign, v[t->kz][2] * t->sign, r.z);
    return r;
}

/** Where boxes lie beyond one side or the other: each side is looked at where the box comes closest to it. */
SK_FUNCTION sk_iN sk_is_outside(sk_flanks s, const sk_fN* x, const sk_fN* z) {
    return (x[1] < s.low + z[s.low_slope < 0.0f ? 1 : 0] * s.low_slope) | (x[0] > s.high + z[s.high_slope < 0.0f ? 0 : 1] * s.high_slope);
}

/** The triangles of a row that a flight's rays are to be tested with: bit k of reaching[j] for row[k]; of up to SK_ROUND, which fill vectors. */
SK_FUNCTION void sk_find_reaching(SetkaGridHeader grid, sk_grid_tables tables, const sk_frustum* t, const sk_u32* row, sk_u32 count,
                                  sk_u32* reaching) {
    for (sk_u32 j = 0u; j < t->count; ++j) reaching[j] = 0u;
    for (sk_u32 first = 0u; first < count; first += SK_WIDTH) {
        const sk_triangle_boxes boxes = sk_gather_triangle_boxes(grid, tables, t, row + first);
        const sk_u32 in_row = 0xffffffffu >> (32u - sk_min_u32(count - first, SK_WIDTH));
        for (sk_u32 j = 0u; j < t->count; ++j) {
            const sk_iN outside = sk_is_outside(t->flight_x[j], boxes.x, boxes.z) | sk_is_outside(t->flight_y[j], boxes.y, boxes.z) |
                                  (boxes.z[0] > t->last[j] * grid.cell_size);
            reaching[j] |= (~sk_lane_bits(outside) & in_row) << first;
        }
    }
}

/** The plain test of the rays of a flight with triangles `bits` of a row: bit k of a lane is set where its ray may hit row[k]. */
SK_FUNCTION sk_iN sk_test_reaching(sk_grid_tables tables, const sk_frustum* t, const sk_flight* f, const sk_u32* row, sk_u32 bits) {
    const sk_ray_lanes ray = f->ray;
    sk_viewpoint_lanes from;
    sk_iN r = sk_same_i(0);
    from.o = f->o;
    from.kx = t->kx;
    from.ky = t->ky;
    from.kz = t->kz;
    for (; bits != 0u; bits &= bits - 1u) {
        const sk_u32 k = sk_lowest_bit(bits);
        const sk_view_lanes view = sk_view_one_triangle(ray, from, tables.triangles + (size_t)row[k] * 9u);
        r = r | (sk_may_pass_lanes(view) & (sk_i32)(1u << k));
    }
    return r;
}

/** Tests `count` triangles, up to SK_ROUND, that come from slice `slice` on. */
SK_FUNCTION void sk_test_row(SetkaGridHeader grid, sk_grid_tables tables, sk_trace_params params, sk_frustum* t, sk_flight* flights,
                             sk_u32* row, sk_u32 count, sk_i32 slice, const int any) {
    sk_u32 reaching[SK_FLIGHTS];
    for (sk_u32 k = count; k % SK_WIDTH != 0u; ++k) row[k] = row[0];
    sk_find_reaching(grid, tables, t, row, count, reaching);
    for (sk_u32 j = 0u; j < t->count; ++j) {
        sk_flight* const f = flights + t->flights[j];
        if (reaching[j] == 0u) continue;
        sk_iN candidates = f->walking & (t->ends[j] >= (float)slice) & sk_test_reaching(tables, t, f, row, reaching[j]);
        if (!sk_any_lane(candidates)) continue;
        do {
            const sk_iN some = candidates != sk_same_i(0), lowest = sk_lowest_bits(candidates) & some;
#define SK_IN_ROW(k) (sk_i32) row[sk_lane(lowest, k)]
            const sk_iN number = SK_INTS(SK_IN_ROW);
#undef SK_IN_ROW
            f->best = sk_test_candidates(tables, params, f->ray,
                                         sk_select_i(some & (number != f->skip), number, sk_same_i((sk_i32)SETKA_NO_HIT)), f->best);
            candidates = candidates & (candidates - 1);
        } while (sk_any_lane(candidates));
        sk_take_best(f, any);
        sk_note_ends(grid, t, j, f);
    }
}

/** The bits of a block's cells that are in the range along an axis; upto[k]: of those at 0 to k of it. */
SK_FUNCTION sk_u64 sk_range_bits(sk_range cells, sk_i32 block, const sk_u64* upto) {
    const sk_i32 first = cells.first - block * 4, last = cells.last - block * 4;
    const sk_u64 before = first > 0 ? upto[(first < 4 ? first : 4) - 1] : 0u;
    return last < 0 ? 0u : upto[last < 3 ? last : 3] & ~before;
}

/** A block with lists in the frustum's way, and where it is across that. */
typedef struct sk_met_block {
    sk_u64 cells;
    sk_u32 first;
    sk_i32 x, y;
} sk_met_block;

/** Of a slab of blocks across the way. */
typedef struct sk_slab {
    sk_met_block blocks[SK_FRUSTUM_BLOCKS];
    sk_u32 count;
    sk_i32 clearance; /* where the count is 0: so many slabs from this one on are empty, wherever rays go from here */
} sk_slab;

SK_FUNCTION void sk_meet_slab(SetkaGridHeader grid, sk_grid_tables tables, const sk_frustum* t, sk_i32 number, sk_range x, sk_range y,
                              sk_slab* slab) {
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid));
    const sk_u32 step_x = sk_block_step(dims, t->kx), step_y = sk_block_step(dims, t->ky), step_z = sk_block_step(dims, t->kz);
    sk_u32 clearance = 15u;
    slab->count = 0u;
    for (sk_i32 by = y.first >> 2; by <= y.last >> 2; ++by)
        for (sk_i32 bx = x.first >> 2; bx <= x.last >> 2; ++bx) {
            const sk_block block = tables.blocks[(sk_u32)(number ^ t->flip) * step_z + (sk_u32)by * step_y + (sk_u32)bx * step_x];
            sk_met_block* const next = slab->blocks + slab->count;
            next->cells = (sk_u64)block.mask_high << 32 | block.mask_low;
            next->first = block.first;
            next->x = bx;
            next->y = by;
            slab->count += next->cells != 0u ? 1u : 0u;
            sk_prefetch(tables.cells + next->first);
            clearance = sk_min_u32(clearance, block.clearance);
        }
    slab->clearance = (sk_i32)((clearance + 4u) / 4u);
}

/** The cells of a slice whose lists are to be looked up. */
typedef struct sk_cells_ahead {
    sk_u64 slice; /* the bits of a block's cells that are in it */
    sk_u32 next;  /* block of the slab, */
    sk_u64 cells; /* and those of the one before that are left */
} sk_cells_ahead;

/** The next lists of a slice, up to SK_LISTS: how many. What they refer to is on its way before the first is read. */
SK_FUNCTION sk_u32 sk_find_lists(sk_grid_tables tables, const sk_frustum* t, const sk_slab* slab, sk_range x, sk_range y, sk_u64 (*upto)[4],
                                 sk_cells_ahead* ahead, sk_cell_list* lists) {
    sk_u32 found = 0u;
    while (found < SK_LISTS && (ahead->cells != 0u || ahead->next < slab->count)) {
        if (ahead->cells == 0u) {
            const sk_met_block block = slab->blocks[ahead->next];
            ahead->cells = block.cells & ahead->slice & sk_range_bits(x, block.x, upto[t->kx]) & sk_range_bits(y, block.y, upto[t->ky]);
            ahead->next += 1u;
        } else {
            const sk_met_block block = slab->blocks[ahead->next - 1u];
            const sk_u64 before = ~ahead->cells & (ahead->cells - 1u);
            lists[found] = tables.cells[block.first + sk_popcount_u64(block.cells & before)];
            sk_prefetch(tables.references + lists[found].offset);
            found += 1u;
            ahead->cells &= ahead->cells - 1u;
        }
    }
    return found;
}

/** Takes a frustum through the grid. The walk ends: each turn goes one slice on, or more. */
SK_FUNCTION void sk_walk_frustum(SetkaGridHeader grid, sk_trace_params params, sk_flight* flights, sk_frustum* t, sk_grid_tables tables,
                                 const int any) {
    const sk_u32 dim_x = grid.dims[t->kx], dim_y = grid.dims[t->ky];
    const sk_i32 dim_z = (sk_i32)grid.dims[t->kz], lowest = t->flip & -dim_z, highest = lowest + dim_z - 1;
    sk_u64 upto[3][4]; /* of each axis: the bits of a block's cells at 0 to k of it */
    sk_u32 mailbox[SK_MAILBOX], row[SK_ROUND + 1u];
    sk_slab slab;
    sk_cell_list lists[SK_LISTS];
    for (sk_u32 k = 0u; k < SK_MAILBOX; ++k) mailbox[k] = SETKA_NO_HIT;
    for (sk_u32 axis = 0u; axis < 3u; ++axis) {
        const sk_u64 at_0 = axis == 0u ? 0x1111111111111111u : axis == 1u ? 0x000f000f000f000fu : 0xffffu;
        upto[axis][0] = at_0;
        for (sk_u32 k = 1u; k < 4u; ++k) upto[axis][k] = upto[axis][k - 1u] | at_0 << (k << 2u * axis);
    }
    /* The first slice reaches back, and the last one on, to what lies in the scene's padded box but outside the grid. */
    float last = sk_last_of(t);
    sk_i32 slice = (sk_i32)sk_floor(sk_max(sk_min(t->start, (float)highest), (float)lowest));
    while (slice <= highest && (slice == lowest || (float)slice <= last)) {
        const sk_i32 number = slice >> 2, end = number * 4 + 3 < highest ? number * 4 + 3 : highest, first = slice;
        const float from = sk_max((float)slice, t->start) - SK_SLICE_PAD, to = sk_min((float)end + 1.0f, last) + SK_SLICE_PAD;
        sk_u32 count = 0u;
        sk_meet_slab(grid, tables, t, number, sk_touched(t->x, from, to, dim_x), sk_touched(t->y, from, to, dim_y), &slab);
        for (; slab.count != 0u && slice <= end && (slice == lowest || (float)slice <= last); ++slice) {
            const float near = sk_max((float)slice, t->start) - SK_SLICE_PAD, far = sk_min((float)slice + 1.0f, last) + SK_SLICE_PAD;
            const sk_range x = sk_touched(t->x, near, far, dim_x), y = sk_touched(t->y, near, far, dim_y);
            sk_range z;
            z.first = z.last = (slice ^ t->flip) & 3;
            const sk_u64 in_slice = sk_range_bits(z, 0, upto[t->kz]);
            sk_cells_ahead ahead;
            ahead.slice = in_slice;
            ahead.next = 0u;
            ahead.cells = 0u;
            sk_u32 found;
            do {
                found = sk_find_lists(tables, t, &slab, x, y, upto, &ahead, lists);
                for (sk_u32 l = 0u; l < found; ++l) {
                    for (sk_u32 k = 0u; k < lists[l].count; ++k) {
                        const sk_u32 triangle = tables.references[lists[l].offset + k], known = mailbox[triangle % SK_MAILBOX];
                        mailbox[triangle % SK_MAILBOX] = triangle;
                        row[count] = triangle;
                        sk_prefetch(tables.triangles + (size_t)triangle * 9u);
                        count += known != triangle ? 1u : 0u;
                        if (count == SK_ROUND) {
                            sk_test_row(grid, tables, params, t, flights, row, count, first, any);
                            count = 0u;
                            last = sk_last_of(t);
                        }
                    }
                }
            } while (found != 0u);
        }
        if (count != 0u) sk_test_row(grid, tables, params, t, flights, row, count, first, any);
        last = sk_last_of(t);
        if (slab.count == 0u) slice = (number + slab.clearance) * 4;
    }
    for (sk_u32 j = 0u; j < t->count; ++j) flights[t->flights[j]].walking = sk_same_i(0);
}

/** Takes those of `count` flights through the grid that make slim frustums. The others still walk. */
SK_FUNCTION void sk_walk_frustums(SetkaGridHeader grid, sk_trace_params params, sk_flight* flights, sk_u32 count, sk_grid_tables tables,
                                  const int any) {
    sk_u32 ways[SK_FLIGHTS], waiting = 0u;
    for (sk_u32 k = 0u; k < count; ++k) {
        ways[k] = sk_ways_of(flights + k);
        waiting |= ways[k] != 0u && (ways[k] & (ways[k] - 1u)) == 0u ? 1u << k : 0u;
    }
    while (waiting != 0u) {
        const sk_u32 way = ways[sk_lowest_bit(waiting)];
        sk_u32 group = 0u;
        sk_frustum frustum;
        for (sk_u32 k = 0u; k < count; ++k) group |= ways[k] == way ? 1u << k : 0u;
        if (sk_make_frustum(grid, flights, group, sk_lowest_bit(way), &frustum))
            sk_walk_frustum(grid, params, flights, &frustum, tables, any);
        waiting &= ~group;
    }
}

#endif
