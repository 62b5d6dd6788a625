/* SPDX-License-Identifier: MIT */
/**
 * How many cells has a grid, and how long are they? The one definition (src/README.md, "Resolution"), for the host, which
 * has the last word, and for devices with doubles, so that cells are counted before the host has seen the bounds.
 */
#ifndef SETKA_DEVICE_GRID_RESOLUTION_H
#define SETKA_DEVICE_GRID_RESOLUTION_H

#include "device/grid/blocks.h"
#include "device/grid/limits.h"
#include "device/math.h"
#include "device/root.h"

/** An unsigned integer that orders as the float does, because atomics know no floats; -0 comes just before 0. */
SK_FUNCTION sk_u32 sk_ordered(float f) {
    const sk_u32 bits = sk_float_bits(f);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
SK_FUNCTION float sk_float_of_ordered(sk_u32 ordered) {
    return sk_bits_float((ordered & 0x80000000u) != 0u ? ordered & 0x7fffffffu : ~ordered);
}

/** The bounds that the transform has reported. */
SK_FUNCTION SetkaBounds sk_reported_bounds(SK_GLOBAL const sk_u32* report) {
    SetkaBounds r;
    for (sk_u32 axis = 0u; axis < 3u; ++axis) {
        r.lower[axis] = sk_float_of_ordered(~report[SK_REPORT_LOWER + axis]);
        r.upper[axis] = sk_float_of_ordered(report[SK_REPORT_UPPER + axis]);
    }
    return r;
}

/** The longest side. */
SK_FUNCTION float sk_extent_of(SetkaBounds bounds) {
    return sk_max(sk_max(bounds.upper[0] - bounds.lower[0], bounds.upper[1] - bounds.lower[1]),
                  bounds.upper[2] - bounds.lower[2]);
}

/** True for bounds that cells can be laid out in: finite, the lower ones first, and no longer than can be calculated with. */
SK_FUNCTION int sk_is_box(SetkaBounds bounds) {
    int is_box = sk_extent_of(bounds) <= 1e20f;
    for (sk_u32 axis = 0u; axis < 3u; ++axis)
        is_box = is_box && bounds.lower[axis] <= bounds.upper[axis] &&
                 sk_is_finite(bounds.upper[axis] - bounds.lower[axis]);
    return is_box;
}

typedef struct sk_resolution {
    float cell_size;
    sk_u32 dims[3];
} sk_resolution;

/** What is to be laid out, and how finely: the options of a grid. */
typedef struct sk_cell_wish {
    float density;
    sk_u32 max_cells; /* along an axis */
    sk_u32 triangle_count, instance_count;
} sk_cell_wish;

SK_FUNCTION sk_cell_wish sk_make_cell_wish(float density, sk_u32 max_cells, sk_u32 triangle_count,
                                           sk_u32 instance_count) {
    sk_cell_wish r;
    r.density = density;
    r.max_cells = max_cells;
    r.triangle_count = triangle_count;
    r.instance_count = instance_count;
    return r;
}

/** The grid's header, but for the pairs. Divides and takes a maximum: the same everywhere. */
SK_FUNCTION SetkaGridHeader sk_make_header(SetkaBounds bounds, sk_resolution resolution, sk_cell_wish wish) {
    SetkaGridHeader grid;
    for (sk_u32 axis = 0u; axis < 3u; ++axis) {
        grid.origin[axis] = bounds.lower[axis];
        grid.dims[axis] = resolution.dims[axis];
    }
    grid.cell_size = resolution.cell_size;
    grid.inverse_cell_size = 1.0f / resolution.cell_size;
    grid.tolerance = (float)sk_max_u32(sk_max_u32(grid.dims[0], grid.dims[1]), grid.dims[2]) * 0x1p-17f;
    grid.cell_count = grid.dims[0] * grid.dims[1] * grid.dims[2];
    grid.reference_count = 0u;
    grid.triangle_count = wish.triangle_count;
    grid.instance_count = wish.instance_count;
    grid.extent = sk_extent_of(bounds);
    grid.reserved[0] = 0u;
    grid.reserved[1] = 0u;
    return grid;
}

#if SK_DOUBLE

/** The extents of a box, and which of its axes are more than one cell thick. */
typedef struct sk_sides {
    double extents[3];
    double longest;
    int active[3];
} sk_sides;

/** How long a cell is, before it is made longer for the sake of other limits; axes that are shorter become inactive. */
SK_FUNCTION double sk_side_of_cells(sk_sides* sides, double cells) {
    const double whole = sides->longest > 0.0 ? sides->longest : 1.0; /* one cell holds everything */
    double size = whole;
    for (sk_u32 count = 3u; count > 0u; --count) {
        double volume = 1.0;
        sk_u32 shortest = sides->active[0] ? 0u : sides->active[1] ? 1u : 2u;
        for (sk_u32 axis = 0u; axis < 3u; ++axis)
            if (sides->active[axis]) {
                volume *= sides->extents[axis];
                if (sides->extents[axis] < sides->extents[shortest]) shortest = axis;
            }
        size = sk_root(volume / cells, count);
        if (sides->extents[shortest] > 0.0 && !(sides->extents[shortest] < size)) break;
        sides->active[shortest] = 0; /* one cell thick: the others alone decide how long a cell is */
        size = whole;
    }
    return size;
}

/** So many cells along an extent, from 1 to most: the quotient, rounded up. */
SK_FUNCTION sk_u32 sk_cells_along(double extent, double size, sk_u32 most) {
    const double cells = extent / size;
    if (!(cells > 1.0)) return 1u;
    if (cells >= (double)most) return most;
    return (double)(sk_u32)cells < cells ? (sk_u32)cells + 1u : (sk_u32)cells;
}

/** The resolution for bounds that are a box. */
SK_FUNCTION sk_resolution sk_find_resolution(SetkaBounds bounds, sk_cell_wish wish) {
    sk_sides sides;
    sides.longest = 0.0;
    for (sk_u32 axis = 0u; axis < 3u; ++axis) {
        sides.extents[axis] = (double)bounds.upper[axis] - (double)bounds.lower[axis];
        sides.active[axis] = 1;
        if (sides.longest < sides.extents[axis]) sides.longest = sides.extents[axis];
    }
    double size = sk_side_of_cells(&sides, (double)wish.density * (double)wish.triangle_count);
    if (size < sides.longest / (double)wish.max_cells) size = sides.longest / (double)wish.max_cells;
    if (size < 0x1p-80) size = 0x1p-80;
    sk_resolution r;
    r.cell_size = (float)size;
    for (sk_u32 axis = 0u; axis < 3u; ++axis)
        r.dims[axis] = sides.active[axis]
                           ? sk_cells_along(sides.extents[axis], (double)r.cell_size, wish.max_cells)
                           : 1u;
    return r;
}

#endif

/**
 * Writes the header that the reported bounds ask for into the report. Nothing if there is none, if it has more than `blocks`
 * blocks, or if the device has no doubles: then there stays what is there, the zeros of a grid without triangles and cells, in which
 * nothing is counted.
 */
SK_FUNCTION void sk_grid_resolve(sk_u32 blocks, sk_cell_wish wish, SK_GLOBAL sk_u32* report) {
#if SK_DOUBLE
    const SetkaBounds bounds = sk_reported_bounds(report);
    if (report[SK_REPORT_BAD] == 0u && sk_is_box(bounds)) {
        const SetkaGridHeader grid = sk_make_header(bounds, sk_find_resolution(bounds, wish), wish);
        if (sk_block_count(sk_block_dims(sk_cell_dims(grid))) <= blocks)
            *(SK_GLOBAL SetkaGridHeader*)(report + SK_REPORT_HEADER) = grid;
    }
#else
    (void)blocks;
    (void)wish;
    (void)report;
#endif
}

/** Four of 4 n counters become 0, those of n work-items side by side each time. */
SK_FUNCTION void sk_clear_counters(sk_u32 i, sk_u32 n, SK_GLOBAL sk_u32* counters) {
    for (sk_u32 k = 0u; k < 4u; ++k) counters[(size_t)k * n + i] = 0u;
}

#endif
