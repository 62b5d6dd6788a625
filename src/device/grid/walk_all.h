/* SPDX-License-Identifier: MIT */
/**
 * Which triangles of the grid does a ray hit, each once and in order? A walk in which each cell owns the hits between the
 * parameters at which the ray leaves the cell before it and the cell itself. Exits never decrease, so that intervals follow each
 * other without gap or overlap: a triangle in several lists counts in one cell only, without a memory of those that were tested.
 * src/README.md ("All hits") has the argument why the owner's list holds it.
 */
#ifndef SETKA_DEVICE_GRID_WALK_ALL_H
#define SETKA_DEVICE_GRID_WALK_ALL_H

#include "device/grid/walk.h"
#include "device/trace/hit_list.h"

/**
 * The number of hits of all triangles but `skip`, up to `most`. With `write` not 0, a compile-time choice of the entry,
 * hits[0 .. number) become the first of them, in order, as records of hit_list.h. Later cells own later hits only, so each
 * cell's are ordered for themselves, and the walk ends with the cell that has the last one wanted.
 */
SK_FUNCTION sk_u32 sk_walk_grid_all(SetkaGridHeader grid, sk_trace_params params, sk_working_ray ray,
                                    sk_grid_tables tables, sk_u32 skip, SK_GLOBAL SetkaHit* hits, sk_u32 most,
                                    const int write) {
    const sk_span span = sk_limit(ray);
    const sk_place start = sk_enter(grid, ray, span);
    sk_axis x = start.x, y = start.y, z = start.z;
    int walking = start.walking && most != 0u;
    sk_u32 found = 0u;
    float w_in = sk_bits_float(0xff800000u); /* the first cell owns whatever is before it */
    while (walking) {
        const sk_u32 cx = sk_cell_index(x), cy = sk_cell_index(y), cz = sk_cell_index(z);
        const sk_block block = sk_block_at(grid, tables, cx, cy, cz);
        const sk_u32 bit = sk_bit_in_block(cx, cy, cz);
        const float wx = sk_exit(x) * x.inverse, wy = sk_exit(y) * y.inverse, wz = sk_exit(z) * z.inverse;
        const float w_out = sk_min(wx, sk_min(wy, wz));
        const int is_last = span.w1 <= w_out; /* and owns whatever is behind it */
        if (sk_has_bit(block, bit) && (w_in < w_out || is_last)) {
            const sk_cell_list list = sk_find_list(tables, block, bit);
            const sk_u32 before = found;
            for (sk_u32 k = 0u; k < list.count; ++k) {
                const sk_u32 number = tables.references[list.offset + k];
                const sk_best hit = sk_test_triangle(ray, tables.triangles, number * 9u, 1u, number, sk_no_hit());
                if (hit.triangle != SETKA_NO_HIT && hit.w > w_in && (hit.w <= w_out || is_last) && number != skip &&
                    sk_is_visible(params, tables.instance_starts, tables.instances, number))
                    found = write ? before + sk_list_hit(hits + before, found - before, most - before, hit)
                                  : found + 1u;
            }
            if (write) sk_sort_hits(hits + before, found - before);
        }
        w_in = w_out;
        if (is_last || found >= most) {
            walking = 0;
        } else if (wx <= wy && wx <= wz) {
            x.index -= 1;
        } else if (wy <= wz) {
            y.index -= 1;
        } else {
            z.index -= 1;
        }
    }
    return sk_min_u32(found, most);
}

#endif
