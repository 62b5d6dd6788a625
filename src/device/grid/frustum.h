/* SPDX-License-Identifier: MIT */
/**
 * Which cells does a frustum of rays touch, and what lies beside it? A frustum is what lies between two lines across each of two axes, along a third
 * that all of its rays go along most (Wald, Ize, Kensler, Knoll & Parker 2006). Its rays start on one plane across that axis and end on
 * another, or between them; they are straight, so none leaves in between (src/README.md, "Frustums").
 *
 * Along the way things are measured in cells from the grid's origin on, mirrored for rays that go down, so that all frustums go up: slice s has the cells s,
 * or those ~s where it is mirrored.
 */
#ifndef SETKA_DEVICE_GRID_FRUSTUM_H
#define SETKA_DEVICE_GRID_FRUSTUM_H

#include "device/grid/cells.h"

/** In cells: what a frustum is wider than its rays, and a slice thicker. Much more than rounding and the pad of the scene's box take. */
#define SK_FRUSTUM_PAD 0.03125f
#define SK_SLICE_PAD 0.125f

/** In cells: farther than any ray gets. */
#define SK_BEYOND 1e9f

/** The sides of a frustum across one axis, as lines along its way: low + z * low_slope and high + z * high_slope. */
typedef struct sk_flanks {
    float low, low_slope, high, high_slope;
} sk_flanks;

/**
 * From (low0, high0) at `start` to (low1, high1) after a length of 1 / inverse_length: rays are straight, so none that is inside at both ends leaves
 * between.
 */
SK_FUNCTION sk_flanks sk_make_flanks(float low0, float high0, float low1, float high1, float start, float inverse_length) {
    sk_flanks r;
    r.low_slope = (low1 - low0) * inverse_length;
    r.low = (low0 - start * r.low_slope) - SK_FRUSTUM_PAD;
    r.high_slope = (high1 - high0) * inverse_length;
    r.high = (high0 - start * r.high_slope) + SK_FRUSTUM_PAD;
    return r;
}

/** Those in cells in the scene's units. */
SK_FUNCTION sk_flanks sk_scale_flanks(sk_flanks s, float cell_size) {
    sk_flanks r = s;
    r.low = s.low * cell_size;
    r.high = s.high * cell_size;
    return r;
}

/** Cells first to last along an axis. */
typedef struct sk_range {
    sk_i32 first, last;
} sk_range;

/** Those between the flanks, from `from` to `to` along the way. */
SK_FUNCTION sk_range sk_touched(sk_flanks s, float from, float to, sk_u32 dim) {
    sk_range r;
    r.first = (sk_i32)sk_cell(sk_min(s.low + from * s.low_slope, s.low + to * s.low_slope), dim);
    r.last = (sk_i32)sk_cell(sk_max(s.high + from * s.high_slope, s.high + to * s.high_slope), dim);
    return r;
}

/** Of axis 0, 1 or 2: the grid's origin, and its cells. Choices, as an array that is indexed would lie in memory. */
SK_FUNCTION float sk_origin_of(SetkaGridHeader grid, sk_u32 axis) { return axis == 0u ? grid.origin[0] : axis == 1u ? grid.origin[1] : grid.origin[2]; }
SK_FUNCTION sk_u32 sk_dim_of(SetkaGridHeader grid, sk_u32 axis) { return axis == 0u ? grid.dims[0] : axis == 1u ? grid.dims[1] : grid.dims[2]; }

/** How many blocks lie from one with the next one along an axis. */
SK_FUNCTION sk_u32 sk_block_step(sk_dims blocks, sk_u32 axis) { return axis == 0u ? 1u : axis == 1u ? blocks.x : blocks.x * blocks.y; }

#endif
