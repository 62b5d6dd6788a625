/* SPDX-License-Identifier: MIT */
/**
 * Which cells does a triangle reach into? The rasterisation of Maltsev & Mikhaylyuk (2012, section 2.3) - rows, columns and the
 * slab of the plane in each column - tightened by the two other projections and widened by a tolerance, so that it misses
 * nothing under rounding. src/README.md specifies every operation; the order here is part of the result.
 */
#ifndef SETKA_DEVICE_GRID_CELLS_H
#define SETKA_DEVICE_GRID_CELLS_H

#include "device/dialect.h"
#include "device/math.h"

/** A triangle in cell units with axes renamed: w is the dominant axis of its normal. u.x, u.y, u.z belong to vertices 0, 1, 2. */
typedef struct sk_cell_triangle {
    sk_vec3 u, v, w;
    sk_u32 dim_u, dim_v, dim_w;
    sk_u32 stride_u, stride_v, stride_w; /* of the cell number */
    float slope_u, slope_v;              /* of the plane: dw/du, dw/dv */
    float half_slab;                          /* of the plane's slab in a column, error included */
} sk_cell_triangle;

typedef struct sk_interval {
    float low, high;
} sk_interval;

/** No plane: any slab of it spans everything. */
#define SK_EVERYTHING 1e30f

SK_FUNCTION sk_u32 sk_cell(float f, sk_u32 dim) { return f >= (float)dim ? dim - 1u : f > 0.0f ? (sk_u32)f : 0u; }

SK_FUNCTION float sk_min_of3(sk_vec3 a) { return sk_min(sk_min(a.x, a.y), a.z); }
SK_FUNCTION float sk_max_of3(sk_vec3 a) { return sk_max(sk_max(a.x, a.y), a.z); }

SK_FUNCTION sk_vec3 sk_to_cells(SetkaGridHeader grid, sk_vec3 p) {
    return sk_make3((p.x - grid.origin[0]) * grid.inverse_cell_size, (p.y - grid.origin[1]) * grid.inverse_cell_size,
                    (p.z - grid.origin[2]) * grid.inverse_cell_size);
}

SK_FUNCTION sk_cell_triangle sk_load_cell_triangle(SetkaGridHeader grid, SK_GLOBAL const float* triangle) {
    sk_cell_triangle r;
    const sk_vec3 p0 = sk_to_cells(grid, sk_load3(triangle));
    const sk_vec3 p1 = sk_to_cells(grid, sk_load3(triangle + 3));
    const sk_vec3 p2 = sk_to_cells(grid, sk_load3(triangle + 6));
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
    r.u = along_x ? y : x;
    r.v = along_z ? y : z;
    r.w = along_z ? z : along_y ? y : x;
    r.dim_u = along_x ? grid.dims[1] : grid.dims[0];
    r.dim_v = along_z ? grid.dims[1] : grid.dims[2];
    r.dim_w = along_z ? grid.dims[2] : along_y ? grid.dims[1] : grid.dims[0];
    r.stride_u = along_x ? stride_y : 1u;
    r.stride_v = along_z ? stride_y : stride_z;
    r.stride_w = along_z ? stride_z : along_y ? stride_y : 1u;
    if (aw > 1e-30f) {
        const float size1 = sk_largest(e1), size2 = sk_largest(e2);
        const float error = (((size1 * size2) / aw) * 0x1p-18f) * (sk_max(size1, size2) + 2.0f);
        r.slope_u = -nu / nw;
        r.slope_v = -nv / nw;
        r.half_slab = (0.5f + grid.tolerance) * (sk_abs(r.slope_u) + sk_abs(r.slope_v)) + error;
    } else {
        /* A sliver without a usable normal: its projections alone bound it. */
        r.slope_u = 0.0f;
        r.slope_v = 0.0f;
        r.half_slab = SK_EVERYTHING;
    }
    return r;
}

/** Widens `interval` by the part of the edge (pa, qa) - (pb, qb) whose p lies in [start, end]. */
SK_FUNCTION sk_interval sk_clip_edge(sk_interval interval, float pa, float qa, float pb, float qb, float start,
                                     float end) {
    const int swap = pb < pa;
    const float p_low = swap ? pb : pa, q_low = swap ? qb : qa;
    const float p_high = swap ? pa : pb, q_high = swap ? qa : qb;
    const float slope = (q_high - q_low) / (p_high - p_low);
    const float first = p_low >= start ? q_low : q_low + (start - p_low) * slope;
    const float second = p_high <= end ? q_high : q_low + (end - p_low) * slope;
    const int meets = !(p_high < start || p_low > end);
    const float low = sk_min(first, second), high = sk_max(first, second);
    sk_interval r;
    r.low = meets && low < interval.low ? low : interval.low;
    r.high = meets && high > interval.high ? high : interval.high;
    return r;
}

/** The interval of q over the slab [start, end] of p; empty if low > high. */
SK_FUNCTION sk_interval sk_clip_triangle(sk_vec3 p, sk_vec3 q, float start, float end) {
    sk_interval r;
    r.low = SK_EVERYTHING;
    r.high = -SK_EVERYTHING;
    r = sk_clip_edge(r, p.x, q.x, p.y, q.y, start, end);
    r = sk_clip_edge(r, p.y, q.y, p.z, q.z, start, end);
    return sk_clip_edge(r, p.z, q.z, p.x, q.x, start, end);
}

/** The first and last row that the triangle reaches into. */
SK_FUNCTION sk_u32 sk_first_row(SetkaGridHeader grid, sk_cell_triangle t) {
    return sk_cell(sk_min_of3(t.v) - grid.tolerance, t.dim_v);
}
SK_FUNCTION sk_u32 sk_last_row(SetkaGridHeader grid, sk_cell_triangle t) {
    return sk_cell(sk_max_of3(t.v) + grid.tolerance, t.dim_v);
}

/**
 * The number of cells of row j that the triangle reaches into; if `write` is not 0 their numbers go to cells[first ..] and
 * `triangle` to references[first ..]. One body for both passes: what is counted is what is written.
 */
SK_FUNCTION sk_u32 sk_visit_row(SetkaGridHeader grid, sk_cell_triangle t, sk_u32 j, const int write, sk_u32 first,
                                sk_u32 triangle, SK_GLOBAL sk_u32* cells, SK_GLOBAL sk_u32* references) {
    const float tolerance = grid.tolerance;
    const float row_start = (float)j - tolerance, row_end = ((float)j + 1.0f) + tolerance;
    const sk_interval row_u = sk_clip_triangle(t.v, t.u, row_start, row_end);
    const sk_interval row_w = sk_clip_triangle(t.v, t.w, row_start, row_end);
    sk_u32 count = 0u;
    if (row_u.low <= row_u.high && row_w.low <= row_w.high) {
        const sk_u32 last = sk_cell(row_u.high + tolerance, t.dim_u);
        for (sk_u32 i = sk_cell(row_u.low - tolerance, t.dim_u); i <= last; ++i) {
            const sk_interval column =
                sk_clip_triangle(t.u, t.w, (float)i - tolerance, ((float)i + 1.0f) + tolerance);
            const float middle = (t.w.x + (((float)i + 0.5f) - t.u.x) * t.slope_u) +
                                 (((float)j + 0.5f) - t.v.x) * t.slope_v;
            const float low = sk_max(sk_max(row_w.low, column.low), middle - t.half_slab) - tolerance;
            const float high = sk_min(sk_min(row_w.high, column.high), middle + t.half_slab) + tolerance;
            if (column.low <= column.high && low <= high) {
                const sk_u32 k_first = sk_cell(low, t.dim_w), k_last = sk_cell(high, t.dim_w);
                if (write)
                    for (sk_u32 k = k_first; k <= k_last; ++k) {
                        const sk_u32 place = first + count + (k - k_first);
                        cells[place] = i * t.stride_u + j * t.stride_v + k * t.stride_w;
                        references[place] = triangle;
                    }
                count += k_last - k_first + 1u;
            }
        }
    }
    return count;
}

#endif
