/* SPDX-License-Identifier: MIT */
/**
 * Which cells does a triangle reach into? The rasterisation of Maltsev & Mikhaylyuk (2012, section 2.3) - rows, columns and the
 * slab of the plane in each column - tightened by the two other projections and widened by a tolerance, so that it misses
 * nothing under rounding. src/README.md specifies every operation; the order here is part of the result.
 */
#ifndef SETKA_DEVICE_GRID_CELLS_H
#define SETKA_DEVICE_GRID_CELLS_H

#include "device/grid/blocks.h"
#include "device/math.h"

/**
 * What one axis adds to a cell's slot, its number where blocks follow each other and in each of them its 64 bits: of the block, and
 * of the cell in it.
 */
typedef struct sk_slot_stride {
    sk_u32 block, cell;
} sk_slot_stride;

SK_FUNCTION sk_u32 sk_slot_part(sk_slot_stride stride, sk_u32 index) {
    return (index >> 2) * stride.block + (index & 3u) * stride.cell;
}

SK_FUNCTION sk_slot_stride sk_slot_stride_of(SetkaGridHeader grid, sk_u32 axis) {
    const sk_dims blocks = sk_block_dims(sk_cell_dims(grid));
    const sk_u32 row = SK_BLOCK_CELLS * blocks.x, layer = row * blocks.y;
    sk_slot_stride r;
    r.block = axis == 0u ? SK_BLOCK_CELLS : axis == 1u ? row : layer;
    r.cell = 1u << (2u * axis);
    return r;
}

/** A triangle in cell units with axes renamed: w is the dominant axis of its normal. u.x, u.y, u.z belong to vertices 0, 1, 2. */
typedef struct sk_cell_triangle {
    sk_vec3 u, v, w;
    sk_u32 dim_u, dim_v, dim_w;
    sk_u32 stride_u, stride_v, stride_w; /* of the cell number */
    sk_slot_stride slot_u, slot_v, slot_w;
    sk_vec3 u_over_v, w_over_v, w_over_u; /* slopes of the edges (0, 1), (1, 2), (2, 0): du/dv, dw/dv, dw/du */
    float slope_u, slope_v;               /* of the plane: dw/du, dw/dv */
    float half_slab;                      /* of the plane's slab in a column, error included */
} sk_cell_triangle;

typedef struct sk_interval {
    float low, high;
} sk_interval;

/** No plane: any slab of it spans everything. */
#define SK_EVERYTHING 1e30f

SK_FUNCTION sk_u32 sk_cell(float f, sk_u32 dim) { return f >= (float)dim ? dim - 1u : f > 0.0f ? (sk_u32)(sk_i32)f : 0u; }

SK_FUNCTION float sk_min_of3(sk_vec3 a) { return sk_min(sk_min(a.x, a.y), a.z); }
SK_FUNCTION float sk_max_of3(sk_vec3 a) { return sk_max(sk_max(a.x, a.y), a.z); }

SK_FUNCTION sk_vec3 sk_to_cells(SetkaGridHeader grid, sk_vec3 p) {
    return sk_make3((p.x - grid.origin[0]) * grid.inverse_cell_size, (p.y - grid.origin[1]) * grid.inverse_cell_size,
                    (p.z - grid.origin[2]) * grid.inverse_cell_size);
}

/** Slopes of the edges: exchanging an edge's ends changes both signs, and so no bit. Of no use where an edge has p as constant. */
SK_FUNCTION sk_vec3 sk_edge_slopes(sk_vec3 p, sk_vec3 q) {
    return sk_make3((q.y - q.x) / (p.y - p.x), (q.z - q.y) / (p.z - p.y), (q.x - q.z) / (p.x - p.z));
}

/** a or b: without a branch, as a choice of structs may have one. */
SK_FUNCTION sk_vec3 sk_select3(int first, sk_vec3 a, sk_vec3 b) {
    return sk_make3(first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z);
}

/** A triangle's vertices in cell units. */
typedef struct sk_cell_points {
    sk_vec3 p0, p1, p2;
} sk_cell_points;

SK_FUNCTION sk_cell_points sk_load_cell_points(SetkaGridHeader grid, SK_GLOBAL const float* triangle) {
    sk_cell_points r;
    r.p0 = sk_to_cells(grid, sk_load3(triangle));
    r.p1 = sk_to_cells(grid, sk_load3(triangle + 3));
    r.p2 = sk_to_cells(grid, sk_load3(triangle + 6));
    return r;
}

/** No branch: so that several can be made side by side. */
SK_FUNCTION sk_cell_triangle sk_make_cell_triangle(SetkaGridHeader grid, sk_cell_points points) {
    sk_cell_triangle r;
    const sk_vec3 p0 = points.p0, p1 = points.p1, p2 = points.p2;
    const sk_vec3 e1 = sk_sub(p1, p0), e2 = sk_sub(p2, p0), n = sk_cross3(e1, e2);
    const float nx = sk_abs(n.x), ny = sk_abs(n.y), nz = sk_abs(n.z);
    const sk_vec3 x = sk_make3(p0.x, p1.x, p2.x);
    const sk_vec3 y = sk_make3(p0.y, p1.y, p2.y);
    const sk_vec3 z = sk_make3(p0.z, p1.z, p2.z);
    const sk_u32 stride_y = grid.dims[0], stride_z = grid.dims[0] * grid.dims[1];
    const int along_z = nz >= nx && nz >= ny;
    const int along_y = !along_z && ny >= nx;
    const int along_x = !along_z && !along_y;
    const float nu = along_x ? n.y : n.x;
    const float nv = along_z ? n.y : n.z;
    const float nw = along_z ? n.z : along_y ? n.y : n.x;
    const float aw = sk_abs(nw);
    r.u = sk_select3(along_x, y, x);
    r.v = sk_select3(along_z, y, z);
    r.w = sk_select3(along_z, z, sk_select3(along_y, y, x));
    r.dim_u = along_x ? grid.dims[1] : grid.dims[0];
    r.dim_v = along_z ? grid.dims[1] : grid.dims[2];
    r.dim_w = along_z ? grid.dims[2] : along_y ? grid.dims[1] : grid.dims[0];
    r.stride_u = along_x ? stride_y : 1u;
    r.stride_v = along_z ? stride_y : stride_z;
    r.stride_w = along_z ? stride_z : along_y ? stride_y : 1u;
    r.slot_u = sk_slot_stride_of(grid, along_x ? 1u : 0u);
    r.slot_v = sk_slot_stride_of(grid, along_z ? 1u : 2u);
    r.slot_w = sk_slot_stride_of(grid, along_z ? 2u : along_y ? 1u : 0u);
    r.u_over_v = sk_edge_slopes(r.v, r.u);
    r.w_over_v = sk_edge_slopes(r.v, r.w);
    r.w_over_u = sk_edge_slopes(r.u, r.w);
    {
        /* A sliver without a usable normal is bounded by its projections alone. */
        const int has_plane = aw > 1e-30f;
        const float divisor = has_plane ? nw : 1.0f, size1 = sk_largest(e1), size2 = sk_largest(e2);
        const float error = (((size1 * size2) / sk_abs(divisor)) * 0x1p-18f) * (sk_max(size1, size2) + 2.0f);
        r.slope_u = has_plane ? -nu / divisor : 0.0f;
        r.slope_v = has_plane ? -nv / divisor : 0.0f;
        r.half_slab = has_plane ? (0.5f + grid.tolerance) * (sk_abs(r.slope_u) + sk_abs(r.slope_v)) + error
                                : SK_EVERYTHING;
    }
    return r;
}

SK_FUNCTION sk_cell_triangle sk_load_cell_triangle(SetkaGridHeader grid, SK_GLOBAL const float* triangle) {
    return sk_make_cell_triangle(grid, sk_load_cell_points(grid, triangle));
}

/** Widens `interval` by the part of the edge (pa, qa) - (pb, qb) whose p lies in [start, end]. */
SK_FUNCTION sk_interval sk_clip_edge(sk_interval interval, float pa, float qa, float pb, float qb, float slope,
                                     float start, float end) {
    const int swap = pb < pa;
    const float p_low = swap ? pb : pa, q_low = swap ? qb : qa;
    const float p_high = swap ? pa : pb, q_high = swap ? qa : qb;
    const float first = p_low >= start ? q_low : q_low + (start - p_low) * slope;
    const float second = p_high <= end ? q_high : q_low + (end - p_low) * slope;
    const int meets = (int)(p_high >= start) & (int)(p_low <= end);
    const float low = sk_min(first, second), high = sk_max(first, second);
    sk_interval r;
    r.low = (meets & (low < interval.low)) ? low : interval.low;
    r.high = (meets & (high > interval.high)) ? high : interval.high;
    return r;
}

/** The interval of q over the slab [start, end] of p; empty if low > high. `slopes` are sk_edge_slopes(p, q). */
SK_FUNCTION sk_interval sk_clip_triangle(sk_vec3 p, sk_vec3 q, sk_vec3 slopes, float start, float end) {
    sk_interval r;
    r.low = SK_EVERYTHING;
    r.high = -SK_EVERYTHING;
    r = sk_clip_edge(r, p.x, q.x, p.y, q.y, slopes.x, start, end);
    r = sk_clip_edge(r, p.y, q.y, p.z, q.z, slopes.y, start, end);
    return sk_clip_edge(r, p.z, q.z, p.x, q.x, slopes.z, start, end);
}

/** The first and last row that the triangle reaches into. */
SK_FUNCTION sk_u32 sk_first_row(SetkaGridHeader grid, sk_cell_triangle t) {
    return sk_cell(sk_min_of3(t.v) - grid.tolerance, t.dim_v);
}
SK_FUNCTION sk_u32 sk_last_row(SetkaGridHeader grid, sk_cell_triangle t) {
    return sk_cell(sk_max_of3(t.v) + grid.tolerance, t.dim_v);
}

/** What the triangle reaches into in row j: columns `first` to `last`, none if last < first, and an interval of w. */
typedef struct sk_row {
    sk_u32 j, first, last;
    sk_interval w;
} sk_row;

SK_FUNCTION sk_row sk_enter_row(SetkaGridHeader grid, sk_cell_triangle t, sk_u32 j) {
    const float tolerance = grid.tolerance;
    const float start = (float)j - tolerance, end = ((float)j + 1.0f) + tolerance;
    const sk_interval u = sk_clip_triangle(t.v, t.u, t.u_over_v, start, end);
    sk_row r;
    r.j = j;
    r.w = sk_clip_triangle(t.v, t.w, t.w_over_v, start, end);
    if (u.low <= u.high && r.w.low <= r.w.high) {
        r.first = sk_cell(u.low - tolerance, t.dim_u);
        r.last = sk_cell(u.high + tolerance, t.dim_u);
    } else {
        r.first = 1u;
        r.last = 0u;
    }
    return r;
}

/** The cells `first` to `last` along w, none if last < first. */
typedef struct sk_column {
    sk_u32 first, last;
} sk_column;

/** What the triangle reaches into in column i of a row. */
SK_FUNCTION sk_column sk_enter_column(SetkaGridHeader grid, sk_cell_triangle t, sk_row row, sk_u32 i) {
    const float tolerance = grid.tolerance;
    const sk_interval own =
        sk_clip_triangle(t.u, t.w, t.w_over_u, (float)i - tolerance, ((float)i + 1.0f) + tolerance);
    const float middle =
        (t.w.x + (((float)i + 0.5f) - t.u.x) * t.slope_u) + (((float)row.j + 0.5f) - t.v.x) * t.slope_v;
    const float low = sk_max(sk_max(row.w.low, own.low), middle - t.half_slab) - tolerance;
    const float high = sk_min(sk_min(row.w.high, own.high), middle + t.half_slab) + tolerance;
    const int meets = own.low <= own.high && low <= high;
    sk_column r;
    r.first = meets ? sk_cell(low, t.dim_w) : 1u;
    r.last = meets ? sk_cell(high, t.dim_w) : 0u;
    return r;
}

/**
 * The number of cells of row j that the triangle reaches into; if `write` is not 0 their numbers go to cells[first ..] and
 * `triangle` to references[first ..]. One body for both passes: what is counted is what is written.
 */
SK_FUNCTION sk_u32 sk_visit_row(SetkaGridHeader grid, sk_cell_triangle t, sk_u32 j, const int write, sk_u32 first,
                                sk_u32 triangle, SK_GLOBAL sk_u32* cells, SK_GLOBAL sk_u32* references) {
    const sk_row row = sk_enter_row(grid, t, j);
    sk_u32 count = 0u;
    for (sk_u32 i = row.first; i <= row.last; ++i) {
        const sk_column column = sk_enter_column(grid, t, row, i);
        if (column.first <= column.last) {
            if (write)
                for (sk_u32 k = column.first; k <= column.last; ++k) {
                    const sk_u32 place = first + count + (k - column.first);
                    cells[place] = i * t.stride_u + j * t.stride_v + k * t.stride_w;
                    references[place] = triangle;
                }
            count += column.last - column.first + 1u;
        }
    }
    return count;
}

/** Counts the triangle in every cell of row j that it reaches into. */
SK_FUNCTION void sk_count_row(SetkaGridHeader grid, sk_cell_triangle t, sk_u32 j, SK_GLOBAL sk_u32* counters) {
    const sk_row row = sk_enter_row(grid, t, j);
    const sk_u32 row_slot = sk_slot_part(t.slot_v, j);
    for (sk_u32 i = row.first; i <= row.last; ++i) {
        const sk_column column = sk_enter_column(grid, t, row, i);
        const sk_u32 slot = row_slot + sk_slot_part(t.slot_u, i);
        for (sk_u32 k = column.first; k <= column.last; ++k)
            sk_atomic_add(counters + (size_t)(slot + sk_slot_part(t.slot_w, k)), 1u);
    }
}

#endif
