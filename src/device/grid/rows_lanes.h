/* SPDX-License-Identifier: MIT */
/**
 * Into which cells does one triangle reach that is not small? The rule of cells.h, with SK_WIDTH rows side by side, and then
 * SK_WIDTH columns of one of them, by the same operations in the same order.
 */
#ifndef SETKA_DEVICE_GRID_ROWS_LANES_H
#define SETKA_DEVICE_GRID_ROWS_LANES_H

#include "device/grid/reach_lanes.h"

/** A triangle in all lanes. */
typedef struct sk_wide_triangle {
    sk_edges_lanes u_over_v, w_over_v, w_over_u;
} sk_wide_triangle;

SK_FUNCTION sk_vec3N sk_same3(sk_vec3 a) { return sk_make3_f(sk_same_f(a.x), sk_same_f(a.y), sk_same_f(a.z)); }

SK_FUNCTION sk_wide_triangle sk_widen(sk_cell_triangle t) {
    const sk_vec3N u = sk_same3(t.u), v = sk_same3(t.v), w = sk_same3(t.w);
    sk_wide_triangle r;
    r.u_over_v = sk_order_edges(v, u);
    r.w_over_v = sk_order_edges(v, w);
    r.w_over_u = sk_order_edges(u, w);
    return r;
}

/** first + 0 to first + SK_WIDTH - 1 */
SK_FUNCTION sk_iN sk_numbers_from(sk_u32 first) { return sk_same_i((sk_i32)first) + sk_lane_numbers(); }

/** sk_enter_row() of SK_WIDTH rows from the first on. */
typedef struct sk_rows_lanes {
    sk_u32 first[SK_WIDTH], last[SK_WIDTH];
    float low[SK_WIDTH], high[SK_WIDTH];
} sk_rows_lanes;

SK_FUNCTION sk_rows_lanes sk_enter_rows(SetkaGridHeader grid, sk_cell_triangle t, sk_wide_triangle wide, sk_u32 first) {
    const float tolerance = grid.tolerance;
    const sk_fN j = sk_lanes_to_float(sk_numbers_from(first));
    const sk_fN start = j - tolerance, end = (j + 1.0f) + tolerance;
    const sk_interval_lanes u = sk_clip_lanes(wide.u_over_v, start, end), w = sk_clip_lanes(wide.w_over_v, start, end);
    const sk_iN meets = (u.low <= u.high) & (w.low <= w.high);
    sk_rows_lanes r;
    sk_store_lanes(sk_select_i(meets, sk_cells_at(u.low - tolerance, t.dim_u), sk_same_i(1)), r.first);
    sk_store_lanes(sk_select_i(meets, sk_cells_at(u.high + tolerance, t.dim_u), sk_same_i(0)), r.last);
    sk_store_f(w.low, r.low);
    sk_store_f(w.high, r.high);
    return r;
}

/** sk_enter_column() of SK_WIDTH columns from the first on, of row j, whose interval of w is given. */
typedef struct sk_columns_lanes {
    sk_u32 first[SK_WIDTH], last[SK_WIDTH];
} sk_columns_lanes;

SK_FUNCTION sk_columns_lanes sk_enter_columns(SetkaGridHeader grid, sk_cell_triangle t, sk_wide_triangle wide, sk_u32 j,
                                              float row_low, float row_high, sk_u32 first) {
    const float tolerance = grid.tolerance;
    const sk_fN i = sk_lanes_to_float(sk_numbers_from(first));
    const sk_interval_lanes own = sk_clip_lanes(wide.w_over_u, i - tolerance, (i + 1.0f) + tolerance);
    const sk_fN middle = (t.w.x + ((i + 0.5f) - t.u.x) * t.slope_u) + (((float)j + 0.5f) - t.v.x) * t.slope_v;
    const sk_fN low = sk_max_f(sk_max_f(sk_same_f(row_low), own.low), middle - t.half_slab) - tolerance;
    const sk_fN high = sk_min_f(sk_min_f(sk_same_f(row_high), own.high), middle + t.half_slab) + tolerance;
    const sk_iN meets = (own.low <= own.high) & (low <= high);
    sk_columns_lanes r;
    sk_store_lanes(sk_select_i(meets, sk_cells_at(low, t.dim_w), sk_same_i(1)), r.first);
    sk_store_lanes(sk_select_i(meets, sk_cells_at(high, t.dim_w), sk_same_i(0)), r.last);
    return r;
}

#endif
