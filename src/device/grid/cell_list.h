/* SPDX-License-Identifier: MIT */
/**
 * What does a ray hit of a cell's list? The plain test for all triangles of it, one after the other, and the accurate test for the
 * few that pass.
 */
#ifndef SETKA_DEVICE_GRID_CELL_LIST_H
#define SETKA_DEVICE_GRID_CELL_LIST_H

#include "device/grid/blocks.h"
#include "device/trace/triangle.h"

/** The tables of a grid and what its walks need of the scene. */
typedef struct sk_grid_tables {
    SK_GLOBAL const sk_block* blocks;
    SK_GLOBAL const sk_cell_list* cells;
    SK_GLOBAL const sk_u32* references;
    SK_GLOBAL const float* triangles;
    SK_GLOBAL const sk_u32* instance_starts;
    SK_GLOBAL const SetkaInstance* instances;
} sk_grid_tables;

SK_FUNCTION sk_grid_tables sk_make_tables(SK_GLOBAL const sk_block* blocks,
                                          SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL const sk_u32* references,
                                          SK_GLOBAL const float* triangles,
                                          SK_GLOBAL const sk_u32* instance_starts,
                                          SK_GLOBAL const SetkaInstance* instances) {
    sk_grid_tables r;
    r.blocks = blocks;
    r.cells = cells;
    r.references = references;
    r.triangles = triangles;
    r.instance_starts = instance_starts;
    r.instances = instances;
    return r;
}

/** The block that holds the cell (x, y, z). */
SK_FUNCTION sk_block sk_block_at(SetkaGridHeader grid, sk_grid_tables tables, sk_u32 x, sk_u32 y, sk_u32 z) {
    return tables.blocks[sk_block_of(sk_block_dims(sk_cell_dims(grid)), x, y, z)];
}

/** The list of a non-empty cell. */
SK_FUNCTION sk_cell_list sk_find_list(sk_grid_tables tables, sk_block block, sk_u32 bit) {
    return tables.cells[block.first + sk_rank_of(block, bit)];
}

/** The best of `best` and the hit of triangle `number`, which may be hit and of which this is the view, unless it is `skip` or hidden. */
SK_FUNCTION sk_best sk_test_candidate_view(sk_grid_tables grid, sk_trace_params params, sk_working_ray ray, sk_view view, sk_u32 number,
                                           sk_u32 skip, sk_best best) {
    const sk_best hit = sk_test_view(ray, view, number, best);
    const int counts = hit.triangle != best.triangle && number != skip &&
                       sk_is_visible(params, grid.instance_starts, grid.instances, number);
    return counts ? hit : best;
}

/**
 * The same of one in the table. It asks once more whether the triangle may be hit, and is written out: without that the walks of teams
 * need more registers (0.94 of the rate of diffuse rays on an H200).
 */
SK_FUNCTION sk_best sk_test_candidate(sk_grid_tables grid, sk_trace_params params, sk_working_ray ray, sk_u32 number,
                                      sk_u32 skip, sk_best best) {
    const sk_best hit = sk_test_triangle(ray, grid.triangles, number * 9u, 1u, number, best);
    const int counts = hit.triangle != best.triangle && number != skip &&
                       sk_is_visible(params, grid.instance_starts, grid.instances, number);
    return counts ? hit : best;
}

/**
 * The best of `best` and the hits in a cell's list, past the triangle `skip`. The accurate test is long and few triangles come to it, so
 * it waits until the list is through or the next candidate is there: work-items that run in step do it together.
 */
SK_FUNCTION sk_best sk_test_cell(sk_grid_tables grid, sk_trace_params params, sk_working_ray ray,
                                 sk_cell_list in, sk_u32 skip, sk_best best) {
    SK_GLOBAL const sk_u32* list = grid.references + in.offset;
    const sk_u32 count = in.count;
    sk_best r = best;
    sk_u32 k = 0u, candidate = SETKA_NO_HIT;
    sk_u32 ahead = count != 0u ? list[0] : 0u;
    do {
        sk_u32 next = SETKA_NO_HIT;
        while (k < count && next == SETKA_NO_HIT) {
            const sk_u32 number = ahead;
            k += 1u;
            if (k < count) ahead = list[k]; /* on its way while this triangle is tested */
            if (sk_may_pass(sk_view_triangle(sk_viewpoint_of(ray), grid.triangles, number * 9u, 1u))) {
                if (candidate == SETKA_NO_HIT)
                    candidate = number;
                else
                    next = number;
            }
        }
        if (candidate != SETKA_NO_HIT) r = sk_test_candidate(grid, params, ray, candidate, skip, r);
        candidate = next;
    } while (candidate != SETKA_NO_HIT);
    return r;
}

#endif
