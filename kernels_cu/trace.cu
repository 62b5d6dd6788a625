/* SPDX-License-Identifier: MIT */
/** Entries of the tracers, one a structure, query and step; the bodies are in src/device/trace and src/device/grid. Those with
 * `first` do rays first to n - 1, one a work-item; but trace_grid_closest_dda and trace_grid_any_dda have many in each on CPUs, and on GPUs teams that
 * take rays as they get through with them (`counts`). Those of a picture take rays tile by tile; where a work-item has many, the others do so too. */
#include "platform.h"

#include "device/grid/trace.h"
#include "device/trace/brute.h"

SK_KERNEL void trace_pack(sk_u32 n, sk_u32 triangle_count, SK_GLOBAL const float* triangles,
                          SK_GLOBAL float* packets) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_trace_pack(i, triangle_count, triangles, packets);
}

SK_KERNEL void trace_brute_closest(sk_u32 n, sk_u32 first, sk_trace_params params,
                                   SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                   SK_GLOBAL SetkaHit* hits, SK_GLOBAL const float* packets,
                                   SK_GLOBAL const sk_u32* instance_starts,
                                   SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        hits[i] = sk_make_hit(params, ray, instance_starts,
                              sk_brute_force(params, ray, packets, instance_starts, instances, skipped, 0));
    }
}

SK_KERNEL void trace_brute_any(sk_u32 n, sk_u32 first, sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                               SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL sk_u32* occluded,
                               SK_GLOBAL const float* packets, SK_GLOBAL const sk_u32* instance_starts,
                               SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        const sk_best best = sk_brute_force(params, ray, packets, instance_starts, instances, skipped, 1);
        occluded[i] = best.triangle != SETKA_NO_HIT ? 1u : 0u;
    }
}

SK_TEAM_KERNEL void trace_grid_closest_dda(sk_u32 n, sk_u32 first, SetkaGridHeader grid,
                                           sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                                           SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL SetkaHit* hits,
                                           SK_GLOBAL const sk_block* blocks, SK_GLOBAL const sk_cell_list* cells,
                                           SK_GLOBAL const sk_u32* references,
                                           SK_GLOBAL const float* triangles,
                                           SK_GLOBAL const sk_u32* instance_starts,
                                           SK_GLOBAL const SetkaInstance* instances, SK_GLOBAL sk_u32* counts) {
    SK_SHARED_STORAGE sk_list_team team;
    sk_trace_closest(&team, n, first, grid, params, rays, skip, hits,
                     sk_make_tables(blocks, cells, references, triangles, instance_starts, instances), counts);
}

SK_TEAM_KERNEL void trace_grid_closest_picture(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                          SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                          SK_GLOBAL SetkaHit* hits, SK_GLOBAL const sk_block* blocks,
                                          SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL const sk_u32* references,
                                          SK_GLOBAL const float* triangles, SK_GLOBAL const sk_u32* instance_starts,
                                          SK_GLOBAL const SetkaInstance* instances) {
#if SK_WIDTH == 1
    SK_SHARED_STORAGE sk_picture_team team;
    sk_trace_closest_picture(&team, n, first + sk_global_id(), grid, params, rays, skip, hits,
                        sk_make_tables(blocks, cells, references, triangles, instance_starts, instances));
#else /* the other kernel does it */
    (void)n, (void)first, (void)grid, (void)params, (void)rays, (void)skip, (void)hits, (void)blocks, (void)cells, (void)references, (void)triangles;
    (void)instance_starts, (void)instances;
#endif
}

SK_KERNEL void trace_grid_closest_free(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                       SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                       SK_GLOBAL SetkaHit* hits, SK_GLOBAL const sk_block* blocks, SK_GLOBAL const sk_cell_list* cells,
                                       SK_GLOBAL const sk_u32* references, SK_GLOBAL const float* triangles,
                                       SK_GLOBAL const sk_u32* instance_starts,
                                       SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_grid_tables tables =
            sk_make_tables(blocks, cells, references, triangles, instance_starts, instances);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        const sk_walk walk = sk_walk_cells(grid, params, ray, tables, skipped, 0);
        hits[i] = sk_make_hit(params, ray, instance_starts, walk.best);
    }
}

SK_TEAM_KERNEL void trace_grid_any_dda(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                       SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                       SK_GLOBAL sk_u32* occluded, SK_GLOBAL const sk_block* blocks,
                                       SK_GLOBAL const sk_cell_list* cells,
                                       SK_GLOBAL const sk_u32* references, SK_GLOBAL const float* triangles,
                                       SK_GLOBAL const sk_u32* instance_starts,
                                       SK_GLOBAL const SetkaInstance* instances, SK_GLOBAL sk_u32* counts) {
    SK_SHARED_STORAGE sk_list_team team;
    sk_trace_any(&team, n, first, grid, params, rays, skip, occluded,
                 sk_make_tables(blocks, cells, references, triangles, instance_starts, instances), counts);
}

SK_TEAM_KERNEL void trace_grid_any_picture(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                          SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                          SK_GLOBAL sk_u32* occluded, SK_GLOBAL const sk_block* blocks,
                                          SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL const sk_u32* references,
                                          SK_GLOBAL const float* triangles, SK_GLOBAL const sk_u32* instance_starts,
                                          SK_GLOBAL const SetkaInstance* instances) {
#if SK_WIDTH == 1
    SK_SHARED_STORAGE sk_picture_team team;
    sk_trace_any_picture(&team, n, first + sk_global_id(), grid, params, rays, skip, occluded,
                        sk_make_tables(blocks, cells, references, triangles, instance_starts, instances));
#else /* the other kernel does it */
    (void)n, (void)first, (void)grid, (void)params, (void)rays, (void)skip, (void)occluded, (void)blocks, (void)cells, (void)references, (void)triangles;
    (void)instance_starts, (void)instances;
#endif
}

SK_KERNEL void trace_grid_any_free(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                   SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                   SK_GLOBAL sk_u32* occluded, SK_GLOBAL const sk_block* blocks, SK_GLOBAL const sk_cell_list* cells,
                                   SK_GLOBAL const sk_u32* references, SK_GLOBAL const float* triangles,
                                   SK_GLOBAL const sk_u32* instance_starts,
                                   SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_grid_tables tables =
            sk_make_tables(blocks, cells, references, triangles, instance_starts, instances);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        const sk_walk walk = sk_walk_cells(grid, params, ray, tables, skipped, 1);
        occluded[i] = walk.best.triangle != SETKA_NO_HIT ? 1u : 0u;
    }
}

SK_TEAM_KERNEL void trace_grid_cost_dda(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                        SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                        SK_GLOBAL SetkaTraceCost* costs, SK_GLOBAL const sk_block* blocks,
                                        SK_GLOBAL const sk_cell_list* cells,
                                        SK_GLOBAL const sk_u32* references, SK_GLOBAL const float* triangles,
                                        SK_GLOBAL const sk_u32* instance_starts,
                                        SK_GLOBAL const SetkaInstance* instances) {
    SK_SHARED_STORAGE sk_team team;
    sk_trace_cost(&team, n, first + sk_global_id(), grid, params, rays, skip, costs,
                  sk_make_tables(blocks, cells, references, triangles, instance_starts, instances));
}

SK_KERNEL void trace_grid_cost_free(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                    SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                    SK_GLOBAL SetkaTraceCost* costs, SK_GLOBAL const sk_block* blocks, SK_GLOBAL const sk_cell_list* cells,
                                    SK_GLOBAL const sk_u32* references, SK_GLOBAL const float* triangles,
                                    SK_GLOBAL const sk_u32* instance_starts,
                                    SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_grid_tables tables =
            sk_make_tables(blocks, cells, references, triangles, instance_starts, instances);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        const sk_walk walk = sk_walk_cells(grid, params, ray, tables, skipped, 0);
        costs[i] = walk.cost;
    }
}
