/* SPDX-License-Identifier: MIT */
/**
 * Into which cells does a small triangle reach? The rule of cells.h, as a mask of the 4 x 4 x 4 cells at a corner: found once,
 * used when triangles are counted and when they are placed. Triangles that lie in one cell, or in a run of cells along one axis, need no
 * more than their box; src/README.md ("Cell lists") has the argument why that is the same.
 */
#ifndef SETKA_DEVICE_GRID_REACH_H
#define SETKA_DEVICE_GRID_REACH_H

#include "device/grid/cells.h"
#include "device/grid/limits.h"

#define SK_REACH_MASK 0u  /* a mask of cells at a corner */
#define SK_REACH_ROWS 1u  /* more than that, but not much: its rows are gone through again */
#define SK_REACH_LARGE 2u /* its rows are work-items of their own */
/* While it is found out, what a mask is made by: */
#define SK_REACH_PAIR 3u /* the rule, in two cells along each axis at most */
#define SK_REACH_FOUR 4u /* the rule, in four */
/* In builds with bins: a mask of cells in one bin, whose number and cell take the place of the corner's coordinates */
#define SK_REACH_IN_BIN 5u

/** 16 bytes, kept from counting to placing. Bit sk_bit_in_block() of the mask is a cell's, counted from the corner. */
typedef struct SK_ALIGNED(16) sk_reach {
    sk_u32 mask_low, mask_high;
    sk_u32 corner_xy; /* x + 2^16 y */
    sk_u32 corner_z;  /* z + 2^16 kind */
} sk_reach;

SK_FUNCTION sk_u64 sk_reach_mask(sk_reach reach) { return (sk_u64)reach.mask_low | (sk_u64)reach.mask_high << 32; }
SK_FUNCTION sk_u32 sk_reach_kind(sk_reach reach) { return reach.corner_z >> 16; }

/** The cells first to last along each axis that a triangle, widened by twice the tolerance, touches: no list outside has it. */
typedef struct sk_box {
    sk_dims first, last;
    int has_clear_ends; /* the triangle itself touches the first and last cells too: no rounding decides about those */
} sk_box;

SK_FUNCTION sk_box sk_box_of(SetkaGridHeader grid, sk_cell_points points) {
    const sk_vec3 p0 = points.p0, p1 = points.p1, p2 = points.p2;
    const float around = grid.tolerance + grid.tolerance;
    const sk_vec3 low = sk_make3(sk_min(sk_min(p0.x, p1.x), p2.x), sk_min(sk_min(p0.y, p1.y), p2.y),
                                 sk_min(sk_min(p0.z, p1.z), p2.z));
    const sk_vec3 high = sk_make3(sk_max(sk_max(p0.x, p1.x), p2.x), sk_max(sk_max(p0.y, p1.y), p2.y),
                                  sk_max(sk_max(p0.z, p1.z), p2.z));
    sk_box r;
    r.first.x = sk_cell(low.x - around, grid.dims[0]);
    r.first.y = sk_cell(low.y - around, grid.dims[1]);
    r.first.z = sk_cell(low.z - around, grid.dims[2]);
    r.last.x = sk_cell(high.x + around, grid.dims[0]);
    r.last.y = sk_cell(high.y + around, grid.dims[1]);
    r.last.z = sk_cell(high.z + around, grid.dims[2]);
    r.has_clear_ends =
        ((sk_cell(low.x, grid.dims[0]) ^ r.first.x) | (sk_cell(high.x, grid.dims[0]) ^ r.last.x) |
         (sk_cell(low.y, grid.dims[1]) ^ r.first.y) | (sk_cell(high.y, grid.dims[1]) ^ r.last.y) |
         (sk_cell(low.z, grid.dims[2]) ^ r.first.z) | (sk_cell(high.z, grid.dims[2]) ^ r.last.z)) == 0u;
    return r;
}

/** Cells along the longest side. */
SK_FUNCTION sk_u32 sk_longest_side(sk_box box) {
    return sk_max_u32(sk_max_u32(box.last.x - box.first.x, box.last.y - box.first.y), box.last.z - box.first.z) + 1u;
}

/** The lowest `count` bits, 1 to 4, of those that are `stride` apart: 1, 4 or 16, along x, y or z. */
SK_FUNCTION sk_u64 sk_run(sk_u32 stride, sk_u32 count) {
    const sk_u64 all = stride == 1u ? 15u : stride == 4u ? 0x1111u : (sk_u64)0x00010001u | (sk_u64)0x00010001u << 32;
    return all & ~(~(sk_u64)0 << 1u << ((stride * count - 1u) & 63u));
}

/** The rule for a triangle whose box is no more than four cells wide. */
SK_FUNCTION sk_u64 sk_rule_mask(SetkaGridHeader grid, sk_cell_triangle t, sk_dims corner) {
    const sk_u32 origin_u = t.slot_u.cell == 1u ? corner.x : corner.y;
    const sk_u32 origin_v = t.slot_v.cell == 4u ? corner.y : corner.z;
    const sk_u32 origin_w = t.slot_w.cell == 1u ? corner.x : t.slot_w.cell == 4u ? corner.y : corner.z;
    const sk_u32 last_row = sk_last_row(grid, t);
    sk_u64 mask = 0u;
    for (sk_u32 j = sk_first_row(grid, t); j <= last_row; ++j) {
        const sk_row row = sk_enter_row(grid, t, j);
        for (sk_u32 i = row.first; i <= row.last; ++i) {
            const sk_column column = sk_enter_column(grid, t, row, i);
            if (column.first <= column.last)
                mask |= sk_run(t.slot_w.cell, column.last - column.first + 1u)
                        << ((i - origin_u) * t.slot_u.cell + (j - origin_v) * t.slot_v.cell +
                            (column.first - origin_w) * t.slot_w.cell);
        }
    }
    return mask;
}

/** The cells w and w + 1 of column i of a row: bit 0 and the bit one cell further along w. */
SK_FUNCTION sk_u32 sk_pair_bits(SetkaGridHeader grid, sk_cell_triangle t, sk_row row, sk_u32 i, sk_u32 w) {
    const sk_column column = sk_enter_column(grid, t, row, i);
    const sk_u32 low = (sk_u32)(column.first <= w) & (sk_u32)(w <= column.last);
    const sk_u32 high = (sk_u32)(column.first <= w + 1u) & (sk_u32)(w + 1u <= column.last);
    return ((int)(i >= row.first) & (int)(i <= row.last)) ? low | high << t.slot_w.cell : 0u;
}

/**
 * The same for one no more than two cells wide, all eight cells at once: without a loop or a branch, so that work-items that run in
 * step stay in step, and others do several triangles side by side.
 */
SK_FUNCTION sk_u32 sk_pair_mask(SetkaGridHeader grid, sk_cell_points points, sk_dims corner) {
    const sk_cell_triangle t = sk_make_cell_triangle(grid, points);
    const sk_u32 u = t.slot_u.cell == 1u ? corner.x : corner.y;
    const sk_u32 v = t.slot_v.cell == 4u ? corner.y : corner.z;
    const sk_u32 w = t.slot_w.cell == 1u ? corner.x : t.slot_w.cell == 4u ? corner.y : corner.z;
    const sk_u32 first_row = sk_first_row(grid, t), last_row = sk_last_row(grid, t);
    const sk_row near = sk_enter_row(grid, t, v), far = sk_enter_row(grid, t, v + 1u);
    sk_u32 mask = sk_pair_bits(grid, t, near, u, w) | sk_pair_bits(grid, t, near, u + 1u, w) << t.slot_u.cell;
    const sk_u32 far_mask = sk_pair_bits(grid, t, far, u, w) | sk_pair_bits(grid, t, far, u + 1u, w) << t.slot_u.cell;
    mask = ((int)(v >= first_row) & (int)(v <= last_row)) ? mask : 0u;
    return mask | (((int)(v + 1u >= first_row) & (int)(v + 1u <= last_row)) ? far_mask << t.slot_v.cell : 0u);
}

SK_FUNCTION sk_reach sk_make_reach(sk_dims corner, sk_u32 kind, sk_u64 mask) {
    sk_reach r;
    r.mask_low = (sk_u32)mask;
    r.mask_high = (sk_u32)(mask >> 32);
    r.corner_xy = corner.x | corner.y << 16;
    r.corner_z = corner.z | kind << 16;
    return r;
}
SK_FUNCTION sk_dims sk_reach_corner(sk_reach reach) {
    sk_dims r;
    r.x = reach.corner_xy & 0xffffu;
    r.y = reach.corner_xy >> 16;
    r.z = reach.corner_z & 0xffffu;
    return r;
}

/** What the box alone says: the mask, or how to find it. */
SK_FUNCTION sk_reach sk_reach_by_box(sk_box box) {
    const sk_u32 nx = box.last.x - box.first.x + 1u, ny = box.last.y - box.first.y + 1u, nz = box.last.z - box.first.z + 1u;
    const sk_u32 most = sk_max_u32(sk_max_u32(nx, ny), nz);
    const int is_run = (int)((nx == 1u) + (ny == 1u) + (nz == 1u) >= 2) & box.has_clear_ends & (int)(most <= 4u);
    const sk_u32 kind = is_run               ? SK_REACH_MASK
                        : most <= 2u         ? SK_REACH_PAIR
                        : most <= 4u         ? SK_REACH_FOUR
                        : most <= SK_SMALL_BOX ? SK_REACH_ROWS
                                             : SK_REACH_LARGE;
    const sk_u64 mask = sk_run(1u, nx & 7u) | sk_run(4u, ny & 7u) | sk_run(16u, nz & 7u);
    return sk_make_reach(box.first, kind, is_run ? mask : 0u);
}

/** The mask by the rule, where the box did not say. */
SK_FUNCTION sk_reach sk_reach_by_rule(SetkaGridHeader grid, sk_cell_points points, sk_reach reach) {
    const sk_dims corner = sk_reach_corner(reach);
    const sk_u32 kind = sk_reach_kind(reach);
    sk_reach r = reach;
    if (kind == SK_REACH_PAIR)
        r = sk_make_reach(corner, SK_REACH_MASK, sk_pair_mask(grid, points, corner));
    else if (kind == SK_REACH_FOUR)
        r = sk_make_reach(corner, SK_REACH_MASK, sk_rule_mask(grid, sk_make_cell_triangle(grid, points), corner));
    return r;
}

/** Bins along the axes, for so many cells (bins.h). */
SK_FUNCTION sk_dims sk_bin_dims(sk_dims cells) {
    sk_dims r;
    r.x = (cells.x + SK_BIN_SIDE - 1u) / SK_BIN_SIDE;
    r.y = (cells.y + SK_BIN_SIDE - 1u) / SK_BIN_SIDE;
    r.z = (cells.z + SK_BIN_SIDE - 1u) / SK_BIN_SIDE;
    return r;
}

/** A cell's number in its bin, x + 16 y + 256 z; and how far on the cell of a mask's bit is. */
SK_FUNCTION sk_u32 sk_cell_in_bin(sk_u32 x, sk_u32 y, sk_u32 z) {
    return (x % SK_BIN_SIDE) + SK_BIN_SIDE * ((y % SK_BIN_SIDE) + SK_BIN_SIDE * (z % SK_BIN_SIDE));
}
SK_FUNCTION sk_u32 sk_bin_step(sk_u32 bit) { return (bit & 3u) | (bit & 12u) << 2 | (bit & 48u) << 4; }

/** A reach by its mask, as SK_REACH_IN_BIN if the box is in one bin. */
SK_FUNCTION sk_reach sk_reach_in_bin(sk_reach reach, sk_box box, sk_dims bins) {
    const int is_in_bin = (int)(box.first.x / SK_BIN_SIDE == box.last.x / SK_BIN_SIDE) &
                          (int)(box.first.y / SK_BIN_SIDE == box.last.y / SK_BIN_SIDE) &
                          (int)(box.first.z / SK_BIN_SIDE == box.last.z / SK_BIN_SIDE);
    sk_reach r = reach;
    if (is_in_bin && sk_reach_kind(reach) == SK_REACH_MASK) {
        r.corner_xy = sk_number_at(bins, box.first.x / SK_BIN_SIDE, box.first.y / SK_BIN_SIDE, box.first.z / SK_BIN_SIDE);
        r.corner_z = sk_cell_in_bin(box.first.x, box.first.y, box.first.z) | SK_REACH_IN_BIN << 16;
    }
    return r;
}

#endif
