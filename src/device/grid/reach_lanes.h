/* SPDX-License-Identifier: MIT */
/**
 * Into which cells do SK_WIDTH triangles reach? The rule of cells.h for those that lie in four cells along each axis, a triangle in each
 * lane, by the same operations in the same order. What depends on a row or on a column alone is found once; which cells an interval touches is
 * found by comparing its ends with the planes between cells, which says the same as sk_cell() does.
 */
#ifndef SETKA_DEVICE_GRID_REACH_LANES_H
#define SETKA_DEVICE_GRID_REACH_LANES_H

#include "device/grid/reach.h"
#include "device/lanes.h"

/** Vertices in cell units. */
typedef struct sk_points_lanes {
    sk_vec3N p0, p1, p2;
} sk_points_lanes;

SK_FUNCTION sk_vec3N sk_to_cells_lanes(SetkaGridHeader grid, sk_fN x, sk_fN y, sk_fN z) {
    return sk_make3_f((x - grid.origin[0]) * grid.inverse_cell_size, (y - grid.origin[1]) * grid.inverse_cell_size,
                      (z - grid.origin[2]) * grid.inverse_cell_size);
}

SK_FUNCTION sk_points_lanes sk_make_points(SetkaGridHeader grid, sk_nine_columns v) {
    sk_points_lanes r;
    r.p0 = sk_to_cells_lanes(grid, v.first.a, v.first.b, v.first.c);
    r.p1 = sk_to_cells_lanes(grid, v.first.d, v.next.a, v.next.b);
    r.p2 = sk_to_cells_lanes(grid, v.next.c, v.next.d, v.last);
    return r;
}

/** Of triangles with these numbers, or of SK_WIDTH from the first on. */
SK_FUNCTION sk_points_lanes sk_gather_cell_points(SetkaGridHeader grid, SK_GLOBAL const float* triangles, sk_iN numbers) {
    return sk_make_points(grid, sk_gather9(triangles, numbers));
}
SK_FUNCTION sk_points_lanes sk_load_cell_points_lanes(SetkaGridHeader grid, SK_GLOBAL const float* triangles) {
    return sk_make_points(grid, sk_load_nine_columns(triangles));
}

/** sk_cell(): a bound that is no number is in cell 0 here too. */
SK_FUNCTION sk_iN sk_cells_at(sk_fN f, sk_u32 dim) {
    const sk_fN inside = sk_min_f(sk_max_f(sk_same_f(0.0f), f), sk_same_f((float)dim));
    return sk_min_i(sk_lanes_to_int(inside), sk_same_i((sk_i32)dim - 1));
}

/** One axis of sk_box_of(): the first cell, how many there are, and whether rounding decides about neither end. */
typedef struct sk_extent_lanes {
    sk_iN first, count, is_clear;
} sk_extent_lanes;

SK_FUNCTION sk_extent_lanes sk_extent_along(sk_fN a, sk_fN b, sk_fN c, float around, sk_u32 dim) {
    const sk_fN low = sk_min_f(sk_min_f(a, b), c), high = sk_max_f(sk_max_f(a, b), c);
    const sk_iN last = sk_cells_at(high + around, dim);
    sk_extent_lanes r;
    r.first = sk_cells_at(low - around, dim);
    r.count = last - r.first + 1;
    r.is_clear = (sk_cells_at(low, dim) == r.first) & (sk_cells_at(high, dim) == last);
    return r;
}

SK_FUNCTION void sk_store_lanes(sk_iN v, sk_u32* target) { sk_store_i(v, (sk_i32*)target); }

/** sk_reach_by_box() of each lane as sk_reach_in_bin() has it, what lanes have to wait for the rule, and corners for that. */
typedef struct sk_boxes_lanes {
    sk_iN words[4]; /* of sk_reach */
    sk_iN xy, z, most; /* z + 2^16 times the axis along which a flat one has one cell */
    sk_u32 flats, twos, threes, fours, large; /* bits of lanes: what waits is no more than so many cells wide, flat ones two */
} sk_boxes_lanes;

/** The lowest `count` bits, 1 to 4, of a mask's word. */
SK_FUNCTION sk_iN sk_run_lanes(sk_iN count, const sk_u32 stride) {
    const sk_iN most = sk_min_i(count, sk_same_i(4));
    return stride == 1u ? (sk_same_i(1) << most) - 1 : 0x1111 & ~(sk_same_i(-2) << (most * 4 - 1));
}

SK_FUNCTION sk_boxes_lanes sk_boxes_of(SetkaGridHeader grid, sk_points_lanes points) {
    const float around = grid.tolerance + grid.tolerance;
    const sk_extent_lanes x = sk_extent_along(points.p0.x, points.p1.x, points.p2.x, around, grid.dims[0]);
    const sk_extent_lanes y = sk_extent_along(points.p0.y, points.p1.y, points.p2.y, around, grid.dims[1]);
    const sk_extent_lanes z = sk_extent_along(points.p0.z, points.p1.z, points.p2.z, around, grid.dims[2]);
    const sk_iN most = sk_max_i(sk_max_i(x.count, y.count), z.count);
    const sk_iN single = (x.count == 1) + (y.count == 1) + (z.count == 1); /* each true one is -1 */
    const sk_iN is_clear = x.is_clear & y.is_clear & z.is_clear;
    const sk_iN is_run = (single <= -2) & (most <= 4) & is_clear, is_flat = (single == -1) & (most == 2) & is_clear;
    const sk_iN is_large = most > (sk_i32)SK_SMALL_BOX, is_rows = (most > 4) & ~is_large;
    const sk_iN low = sk_run_lanes(x.count, 1u) | sk_run_lanes(y.count, 4u) | ((z.count >= 2) & 0x10000);
    const sk_iN high = ((z.count >= 3) & 1) | ((z.count >= 4) & 0x10000);
    const sk_iN xy = x.first | y.first << 16;
    const sk_dims bins = sk_bin_dims(sk_cell_dims(grid));
    const sk_iN in_x = x.first & 15, in_y = y.first & 15, in_z = z.first & 15;
    const sk_iN is_in_bin = (in_x + x.count <= (sk_i32)SK_BIN_SIDE) & (in_y + y.count <= (sk_i32)SK_BIN_SIDE) &
                            (in_z + z.count <= (sk_i32)SK_BIN_SIDE) & (most <= 4);
    const sk_iN bin = ((z.first >> 4) * (sk_i32)bins.y + (y.first >> 4)) * (sk_i32)bins.x + (x.first >> 4);
    const sk_iN kind = (is_in_bin & (sk_i32)SK_REACH_IN_BIN) | (is_rows & (sk_i32)SK_REACH_ROWS) |
                       (is_large & (sk_i32)SK_REACH_LARGE);
    sk_boxes_lanes r;
    r.words[0] = low & is_run;
    r.words[1] = high & is_run;
    r.words[2] = sk_select_i(is_in_bin, bin, xy);
    r.words[3] = sk_select_i(is_in_bin, in_x | in_y << 4 | in_z << 8, z.first) | kind << 16;
    r.xy = xy;
    r.z = z.first | ((y.count == 1) & 1 << 16) | ((z.count == 1) & 2 << 16);
    r.most = most;
    r.flats = sk_lane_bits(is_flat);
    r.twos = sk_lane_bits(~is_run & ~is_flat & (most <= 2));
    r.threes = sk_lane_bits(~is_run & (most == 3));
    r.fours = sk_lane_bits(~is_run & (most == 4));
    r.large = sk_lane_bits(is_large);
    return r;
}

/** An edge, its ends in ascending order of p. */
typedef struct sk_edge_lanes {
    sk_fN p_low, p_high, q_low, q_high, slope;
} sk_edge_lanes;

typedef struct sk_edges_lanes {
    sk_edge_lanes a, b, c;
} sk_edges_lanes;

SK_FUNCTION sk_edge_lanes sk_order_edge(sk_fN pa, sk_fN qa, sk_fN pb, sk_fN qb) {
    const sk_iN swap = pb < pa;
    sk_edge_lanes r;
    r.p_low = sk_select_f(swap, pb, pa);
    r.p_high = sk_select_f(swap, pa, pb);
    r.q_low = sk_select_f(swap, qb, qa);
    r.q_high = sk_select_f(swap, qa, qb);
    r.slope = (qb - qa) / (pb - pa);
    return r;
}

SK_FUNCTION sk_edges_lanes sk_order_edges(sk_vec3N p, sk_vec3N q) {
    sk_edges_lanes r;
    r.a = sk_order_edge(p.x, q.x, p.y, q.y);
    r.b = sk_order_edge(p.y, q.y, p.z, q.z);
    r.c = sk_order_edge(p.z, q.z, p.x, q.x);
    return r;
}

typedef struct sk_interval_lanes {
    sk_fN low, high;
} sk_interval_lanes;

SK_FUNCTION sk_interval_lanes sk_clip_edge_lanes(sk_interval_lanes interval, sk_edge_lanes edge, sk_fN start,
                                                 sk_fN end) {
    const sk_fN first =
        sk_select_f(edge.p_low >= start, edge.q_low, edge.q_low + (start - edge.p_low) * edge.slope);
    const sk_fN second = sk_select_f(edge.p_high <= end, edge.q_high, edge.q_low + (end - edge.p_low) * edge.slope);
    const sk_iN meets = (edge.p_high >= start) & (edge.p_low <= end);
    const sk_fN low = sk_min_f(first, second), high = sk_max_f(first, second);
    sk_interval_lanes r;
    r.low = sk_select_f(meets & (low < interval.low), low, interval.low);
    r.high = sk_select_f(meets & (high > interval.high), high, interval.high);
    return r;
}

/** sk_clip_triangle() */
SK_FUNCTION sk_interval_lanes sk_clip_lanes(sk_edges_lanes edges, sk_fN start, sk_fN end) {
    sk_interval_lanes r;
    r.low = sk_same_f(SK_EVERYTHING);
    r.high = sk_same_f(-SK_EVERYTHING);
    r = sk_clip_edge_lanes(r, edges.a, start, end);
    r = sk_clip_edge_lanes(r, edges.b, start, end);
    return sk_clip_edge_lanes(r, edges.c, start, end);
}

/** Cells along an axis from the box's first one on. An end f of an interval is in cell k or a lower one where f < below, in k or a higher one where f >= from. */
typedef struct sk_planes_lanes {
    sk_fN at[4], from[4], below[4];
} sk_planes_lanes;

SK_FUNCTION sk_planes_lanes sk_planes_of(sk_iN first, sk_iN dim, const int cells) {
    const sk_fN infinity = sk_same_f(sk_bits_float(0x7f800000u));
    sk_planes_lanes r;
    for (int k = 0; k < cells; ++k) {
        const sk_iN cell = first + k;
        r.at[k] = sk_lanes_to_float(cell);
        r.from[k] = sk_select_f(cell >= dim, infinity, sk_select_f(cell == 0, -infinity, r.at[k]));
        r.below[k] = sk_select_f(cell + 1 >= dim, infinity, sk_lanes_to_float(cell + 1));
    }
    return r;
}

/** Masks of the cells at the corner. */
typedef struct sk_masks_lanes {
    sk_iN low, high;
} sk_masks_lanes;

/** Where `where` is set, each of these bits and the one so far above it change places. */
SK_FUNCTION sk_iN sk_exchange_bits(sk_iN a, const sk_i32 bits, const sk_i32 distance, sk_iN where) {
    const sk_iN differ = (a ^ a >> distance) & bits & where;
    return a ^ differ ^ differ << distance;
}

/** Bits w + 4 u + 16 v as bits x + 4 y + 16 z, where w is an axis, x if neither is told, and u and v are the two others in ascending order. */
SK_FUNCTION sk_masks_lanes sk_turn_masks(sk_masks_lanes masks, sk_iN is_y, sk_iN is_z) {
    const sk_iN is_other = is_y | is_z;
    sk_masks_lanes r;
    sk_iN differ;
    /* w and u change places */
    r.low = sk_exchange_bits(sk_exchange_bits(masks.low, 0x0a0a0a0a, 3, is_other), 0x00cc00cc, 6, is_other);
    r.high = sk_exchange_bits(sk_exchange_bits(masks.high, 0x0a0a0a0a, 3, is_other), 0x00cc00cc, 6, is_other);
    /* then w and v, from word to word at last */
    r.low = sk_exchange_bits(r.low, 0x0000f0f0, 12, is_z);
    r.high = sk_exchange_bits(r.high, 0x0000f0f0, 12, is_z);
    differ = (r.low >> 8 ^ r.high) & 0x00ff00ff & is_z;
    r.low ^= differ << 8;
    r.high ^= differ;
    return r;
}

SK_FUNCTION sk_vec3N sk_choose3(sk_iN first, sk_vec3N a, sk_vec3N b) {
    return sk_make3_f(sk_select_f(first, a.x, b.x), sk_select_f(first, a.y, b.y), sk_select_f(first, a.z, b.z));
}

SK_FUNCTION sk_fN sk_largest_lanes(sk_vec3N a) {
    return sk_max_f(sk_max_f(sk_abs_f(a.x), sk_abs_f(a.y)), sk_abs_f(a.z));
}

/** The normal, and which of its components is the largest, z before y before x where equal. */
typedef struct sk_axes_lanes {
    sk_vec3N e1, e2, n;
    sk_iN along_y, along_z;
} sk_axes_lanes;

SK_FUNCTION sk_axes_lanes sk_axes_of(sk_points_lanes points) {
    const sk_vec3N p0 = points.p0, p1 = points.p1, p2 = points.p2;
    const sk_vec3N e1 = sk_make3_f(p1.x - p0.x, p1.y - p0.y, p1.z - p0.z);
    const sk_vec3N e2 = sk_make3_f(p2.x - p0.x, p2.y - p0.y, p2.z - p0.z);
    const sk_vec3N n = sk_make3_f(e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x);
    const sk_fN nx = sk_abs_f(n.x), ny = sk_abs_f(n.y), nz = sk_abs_f(n.z);
    sk_axes_lanes r;
    r.e1 = e1;
    r.e2 = e2;
    r.n = n;
    r.along_z = (nz >= nx) & (nz >= ny);
    r.along_y = ~r.along_z & (ny >= nx);
    return r;
}

/** The rule for triangles whose boxes are no more than `cells` wide, 2 to 4, from the corners on. */
SK_FUNCTION sk_masks_lanes sk_rule_of(SetkaGridHeader grid, sk_points_lanes points, sk_iN corner_x, sk_iN corner_y,
                                     sk_iN corner_z, const int cells) {
    const float tolerance = grid.tolerance;
    const sk_vec3N p0 = points.p0, p1 = points.p1, p2 = points.p2;
    const sk_axes_lanes axes = sk_axes_of(points);
    const sk_vec3N e1 = axes.e1, e2 = axes.e2, n = axes.n;
    const sk_iN along_y = axes.along_y, along_z = axes.along_z, along_x = ~along_z & ~along_y;
    const sk_vec3N x = sk_make3_f(p0.x, p1.x, p2.x), y = sk_make3_f(p0.y, p1.y, p2.y), z = sk_make3_f(p0.z, p1.z, p2.z);
    const sk_vec3N u = sk_choose3(along_x, y, x), v = sk_choose3(along_z, y, z);
    const sk_vec3N w = sk_choose3(along_z, z, sk_choose3(along_y, y, x));
    const sk_iN dim_x = sk_same_i((sk_i32)grid.dims[0]), dim_y = sk_same_i((sk_i32)grid.dims[1]), dim_z = sk_same_i((sk_i32)grid.dims[2]);
    const sk_planes_lanes us =
        sk_planes_of(sk_select_i(along_x, corner_y, corner_x), sk_select_i(along_x, dim_y, dim_x), cells);
    const sk_planes_lanes vs =
        sk_planes_of(sk_select_i(along_z, corner_y, corner_z), sk_select_i(along_z, dim_y, dim_z), cells);
    const sk_planes_lanes ws =
        sk_planes_of(sk_select_i(along_z, corner_z, sk_select_i(along_y, corner_y, corner_x)),
                     sk_select_i(along_z, dim_z, sk_select_i(along_y, dim_y, dim_x)), cells);
    const sk_fN nu = sk_select_f(along_x, n.y, n.x), nv = sk_select_f(along_z, n.y, n.z);
    const sk_fN nw = sk_select_f(along_z, n.z, sk_select_f(along_y, n.y, n.x));
    const sk_iN has_plane = sk_abs_f(nw) > 1e-30f;
    const sk_fN divisor = sk_select_f(has_plane, nw, sk_same_f(1.0f));
    const sk_fN size1 = sk_largest_lanes(e1), size2 = sk_largest_lanes(e2);
    const sk_fN error = (((size1 * size2) / sk_abs_f(divisor)) * 0x1p-18f) * (sk_max_f(size1, size2) + 2.0f);
    const sk_fN slope_u = sk_select_f(has_plane, -nu / divisor, sk_same_f(0.0f));
    const sk_fN slope_v = sk_select_f(has_plane, -nv / divisor, sk_same_f(0.0f));
    const sk_fN half_slab =
        sk_select_f(has_plane, (0.5f + tolerance) * (sk_abs_f(slope_u) + sk_abs_f(slope_v)) + error,
                    sk_same_f(SK_EVERYTHING));
    const sk_edges_lanes u_over_v = sk_order_edges(v, u), w_over_v = sk_order_edges(v, w), w_over_u = sk_order_edges(u, w);
    const sk_fN v_low = sk_min_f(sk_min_f(v.x, v.y), v.z) - tolerance, v_high = sk_max_f(sk_max_f(v.x, v.y), v.z) + tolerance;
    sk_interval_lanes columns[4];
    sk_fN middles[4];
    sk_iN words[2];
    sk_masks_lanes r;
    words[0] = sk_same_i(0);
    words[1] = sk_same_i(0);
    for (int i = 0; i < cells; ++i) {
        columns[i] = sk_clip_lanes(w_over_u, us.at[i] - tolerance, (us.at[i] + 1.0f) + tolerance);
        middles[i] = w.x + ((us.at[i] + 0.5f) - u.x) * slope_u;
    }
    for (int j = 0; j < cells; ++j) {
        const sk_fN start = vs.at[j] - tolerance, end = (vs.at[j] + 1.0f) + tolerance;
        const sk_interval_lanes row_u = sk_clip_lanes(u_over_v, start, end), row_w = sk_clip_lanes(w_over_v, start, end);
        const sk_fN row_middle = ((vs.at[j] + 0.5f) - v.x) * slope_v;
        const sk_fN u_low = row_u.low - tolerance, u_high = row_u.high + tolerance;
        const sk_iN is_row = (v_low < vs.below[j]) & (v_high >= vs.from[j]) & (row_u.low <= row_u.high) &
                             (row_w.low <= row_w.high);
        for (int i = 0; i < cells; ++i) {
            const sk_interval_lanes own = columns[i];
            const sk_fN middle = middles[i] + row_middle;
            const sk_fN low = sk_max_f(sk_max_f(row_w.low, own.low), middle - half_slab) - tolerance;
            const sk_fN high = sk_min_f(sk_min_f(row_w.high, own.high), middle + half_slab) + tolerance;
            const sk_iN meets = is_row & (u_low < us.below[i]) & (u_high >= us.from[i]) & (own.low <= own.high) & (low <= high);
            sk_iN bits = sk_same_i(0);
            for (int k = 0; k < cells; ++k)
                bits |= (low < ws.below[k]) & (high >= ws.from[k]) & sk_same_i(1 << (4 * i + 16 * (j & 1) + k));
            words[j >> 1] |= bits & meets;
        }
    }
    r.low = words[0];
    r.high = words[1];
    return sk_turn_masks(r, along_y, along_z);
}

/** Masks of the cells at the corner, in one word, where rounding does not decide. */
typedef struct sk_flat_lanes {
    sk_iN mask, is_certain;
} sk_flat_lanes;

/**
 * The rule for triangles whose boxes have one cell along `axis`, 0 to 2, and two along the others, with clear ends: along the other axes the projection is
 * cut by the slabs of one, and the interval of the other decides alone. Not where an end of it is so near a plane that the roundings of what else
 * the rule asks may count ("Without the rule", src/README.md).
 */
SK_FUNCTION sk_flat_lanes sk_flat_rule_of(SetkaGridHeader grid, sk_points_lanes points, sk_iN corner_x, sk_iN corner_y, sk_iN corner_z,
                                          sk_iN axis) {
    const float tolerance = grid.tolerance, margin = 0.5f * grid.tolerance;
    const sk_points_lanes p = points;
    const sk_iN single_x = axis == 0, single_z = axis == 2;
    const sk_axes_lanes axes = sk_axes_of(points);
    const sk_iN b_leads = sk_select_i(single_z, axes.along_y, axes.along_z); /* of a and b, the axes with two cells each */
    const sk_vec3N x = sk_make3_f(p.p0.x, p.p1.x, p.p2.x), y = sk_make3_f(p.p0.y, p.p1.y, p.p2.y), z = sk_make3_f(p.p0.z, p.p1.z, p.p2.z);
    const sk_vec3N a = sk_choose3(single_x, y, x), b = sk_choose3(single_z, y, z);
    const sk_iN corner_a = sk_select_i(single_x, corner_y, corner_x), corner_b = sk_select_i(single_z, corner_y, corner_z);
    const sk_iN step_a = sk_select_i(single_x, sk_same_i(4), sk_same_i(1)), step_b = sk_select_i(single_z, sk_same_i(4), sk_same_i(16));
    const sk_iN step_across = sk_select_i(b_leads, step_b, step_a), step_slab = sk_select_i(b_leads, step_a, step_b);
    const sk_edges_lanes edges = sk_order_edges(sk_choose3(b_leads, a, b), sk_choose3(b_leads, b, a));
    const sk_fN slab = sk_lanes_to_float(sk_select_i(b_leads, corner_a, corner_b));
    const sk_fN plane = sk_lanes_to_float(sk_select_i(b_leads, corner_b, corner_a) + 1);
    sk_flat_lanes r;
    r.mask = sk_same_i(0);
    r.is_certain = sk_same_i(-1);
    for (int k = 0; k < 2; ++k) {
        const sk_fN at = slab + (float)k;
        const sk_interval_lanes interval = sk_clip_lanes(edges, at - tolerance, (at + 1.0f) + tolerance);
        const sk_fN low = interval.low - tolerance, high = interval.high + tolerance;
        const sk_iN own = ((low < plane) & 1) | ((high >= plane) & (sk_same_i(1) << step_across));
        r.mask |= k == 0 ? own : own << step_slab;
        r.is_certain &= (sk_abs_f(low - plane) > margin) & (sk_abs_f(high - plane) > margin) & (interval.low <= interval.high);
    }
    return r;
}

/** The triangles that are looked at before those that wait have their turn. */
#define SK_CHUNK 128u

/** Triangles that wait for the rule, with the corners of their boxes: fewer than lanes from the last turn, those of a chunk, of flat ones that are not certain fewer than lanes more,
 * and room to write more lanes than count. */
typedef struct sk_waiting {
    sk_u32 count;
    sk_i32 triangles[SK_CHUNK + 3u * SK_WIDTH], xy[SK_CHUNK + 3u * SK_WIDTH], z[SK_CHUNK + 3u * SK_WIDTH];
} sk_waiting;

/** Lets those triangles wait whose bits are set. */
SK_FUNCTION void sk_let_wait(sk_waiting* waiting, sk_u32 bits, sk_iN triangles, sk_iN xy, sk_iN z) {
    if (bits != 0u) {
        sk_put_i(waiting->triangles + waiting->count, bits, triangles);
        sk_put_i(waiting->xy + waiting->count, bits, xy);
        sk_put_i(waiting->z + waiting->count, bits, z);
        waiting->count += sk_popcount(bits);
    }
}

/** The end of those that have their turn: as many as fill all lanes, and with `end` the rest too, whose lanes without a triangle of their own do the first one's again. */
SK_FUNCTION sk_u32 sk_end_of_turn(sk_waiting* waiting, const int end) {
    const sk_u32 all = waiting->count;
    if (!end) return all - all % SK_WIDTH;
    if (all % SK_WIDTH != 0u)
        for (sk_u32 k = all; k < all + SK_WIDTH; ++k) {
            waiting->triangles[k] = waiting->triangles[0];
            waiting->xy[k] = waiting->xy[0];
            waiting->z[k] = waiting->z[0];
        }
    return all;
}

/** The rest waits for the next turn. */
SK_FUNCTION void sk_end_turn(sk_waiting* waiting, sk_u32 end) {
    if (end < waiting->count && end != 0u) {
        sk_store_i(sk_load_i(waiting->triangles + end), waiting->triangles);
        sk_store_i(sk_load_i(waiting->xy + end), waiting->xy);
        sk_store_i(sk_load_i(waiting->z + end), waiting->z);
    }
    waiting->count -= end;
}

/** Finds the masks of those that wait, by the rule, while they fill all lanes; and with `end` of the rest too. */
SK_FUNCTION void sk_reach_waiting(sk_waiting* waiting, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                                  SK_GLOBAL sk_reach* reaches, const int cells, const int end) {
    const sk_u32 turn = sk_end_of_turn(waiting, end);
    for (sk_u32 first = 0u; first < turn; first += SK_WIDTH) {
        const sk_iN numbers = sk_load_i(waiting->triangles + first), xy = sk_load_i(waiting->xy + first);
        const sk_masks_lanes masks = sk_rule_of(grid, sk_gather_cell_points(grid, triangles, numbers), xy & 0xffff, xy >> 16 & 0xffff,
                                                sk_load_i(waiting->z + first) & 0xffff, cells);
        sk_u32 low[SK_WIDTH], high[SK_WIDTH];
        sk_store_lanes(masks.low, low);
        sk_store_lanes(masks.high, high);
        for (sk_u32 k = 0u; k < SK_WIDTH; ++k) {
            SK_GLOBAL sk_reach* reach = reaches + (sk_u32)waiting->triangles[first + k];
            reach->mask_low = low[k];
            reach->mask_high = high[k];
        }
    }
    sk_end_turn(waiting, turn);
}

/** The same for flat ones; those that are not certain wait with the `others`. */
SK_FUNCTION void sk_reach_flats(sk_waiting* waiting, SetkaGridHeader grid, SK_GLOBAL const float* triangles, SK_GLOBAL sk_reach* reaches,
                                sk_waiting* others, const int end) {
    const sk_u32 turn = sk_end_of_turn(waiting, end);
    for (sk_u32 first = 0u; first < turn; first += SK_WIDTH) {
        const sk_u32 count = sk_min_u32(turn - first, SK_WIDTH);
        const sk_iN numbers = sk_load_i(waiting->triangles + first), xy = sk_load_i(waiting->xy + first), z = sk_load_i(waiting->z + first);
        const sk_flat_lanes flat = sk_flat_rule_of(grid, sk_gather_cell_points(grid, triangles, numbers), xy & 0xffff, xy >> 16 & 0xffff,
                                                   z & 0xffff, z >> 16);
        sk_u32 low[SK_WIDTH];
        sk_store_lanes(flat.mask, low);
        for (sk_u32 k = 0u; k < SK_WIDTH; ++k) reaches[(sk_u32)waiting->triangles[first + k]].mask_low = low[k];
        sk_let_wait(others, sk_lane_bits(~flat.is_certain) & ((2u << (count - 1u)) - 1u), numbers, xy, z);
    }
    sk_end_turn(waiting, turn);
}

/** Stores the records of SK_WIDTH triangles, or of the first `count`. */
SK_FUNCTION void sk_store_reaches(const sk_iN* words, sk_u32 count, SK_GLOBAL sk_reach* reaches) {
    if (count == SK_WIDTH) {
        sk_store_rows(words[0], words[1], words[2], words[3], (SK_GLOBAL sk_i32*)reaches);
    } else {
        sk_u32 lanes[4][SK_WIDTH];
        for (sk_u32 w = 0u; w < 4u; ++w) sk_store_lanes(words[w], lanes[w]);
        for (sk_u32 k = 0u; k < count; ++k) {
            sk_reach reach;
            reach.mask_low = lanes[0][k];
            reach.mask_high = lanes[1][k];
            reach.corner_xy = lanes[2][k];
            reach.corner_z = lanes[3][k];
            reaches[k] = reach;
        }
    }
}

/** How many cells wide the triangles of these lanes are, in units of SK_LONG_ROW. */
SK_FUNCTION sk_u32 sk_units_of(sk_iN most, sk_u32 lanes) {
    sk_u32 wide[SK_WIDTH], units = 0u;
    sk_store_lanes(most, wide);
    for (sk_u32 rest = lanes; rest != 0u; rest &= rest - 1u) units += wide[sk_lowest_bit(rest)] / SK_LONG_ROW;
    return units;
}

/** The reaches of triangles first to end - 1, and in how many cells large ones are at least, in units of SK_LONG_ROW. */
SK_FUNCTION sk_u64 sk_find_reaches(sk_u32 first, sk_u32 end, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                                   SK_GLOBAL sk_reach* reaches) {
    const sk_iN lane = sk_lane_numbers();
    sk_waiting flats, twos, threes, fours;
    sk_u64 units = 0u;
    flats.count = 0u;
    twos.count = 0u;
    threes.count = 0u;
    fours.count = 0u;
    for (sk_u32 start = first; start < end; start += SK_WIDTH) {
        const sk_u32 count = sk_min_u32(end - start, SK_WIDTH), lanes = (2u << (count - 1u)) - 1u;
        const sk_iN numbers = (lane & (lane < (sk_i32)count)) + (sk_i32)start;
        const sk_points_lanes points = count == SK_WIDTH ? sk_load_cell_points_lanes(grid, triangles + (size_t)start * 9u)
                                                         : sk_gather_cell_points(grid, triangles, numbers);
        const sk_boxes_lanes boxes = sk_boxes_of(grid, points);
        const int is_last = start + SK_WIDTH >= end;
        /* Line by line: what the next chunk reads, and what is written the time after next. */
        for (sk_u32 k = 0u; k < 9u * SK_WIDTH; k += 16u) sk_prefetch(triangles + ((size_t)(start + SK_CHUNK) * 9u + k));
        sk_store_reaches(boxes.words, count, reaches + start);
        if ((boxes.large & lanes) != 0u) units += sk_units_of(boxes.most, boxes.large & lanes);
        sk_let_wait(&flats, boxes.flats & lanes, numbers, boxes.xy, boxes.z);
        sk_let_wait(&twos, boxes.twos & lanes, numbers, boxes.xy, boxes.z);
        sk_let_wait(&threes, boxes.threes & lanes, numbers, boxes.xy, boxes.z);
        sk_let_wait(&fours, boxes.fours & lanes, numbers, boxes.xy, boxes.z);
        if (is_last || (start + SK_WIDTH - first) % SK_CHUNK == 0u) {
            sk_reach_flats(&flats, grid, triangles, reaches, &twos, is_last);
            sk_reach_waiting(&twos, grid, triangles, reaches, 2, is_last);
            sk_reach_waiting(&threes, grid, triangles, reaches, 3, is_last);
            sk_reach_waiting(&fours, grid, triangles, reaches, 4, is_last);
        }
    }
    return units;
}

#endif
