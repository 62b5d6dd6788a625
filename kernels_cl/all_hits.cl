/* SPDX-License-Identifier: MIT */
/**
 * Entries that find every hit of a ray: a count, and after a scan of the counts the list. The bodies are in
 * src/device/trace/brute.h and src/device/grid/walk_all.h. All do rays first to n - 1.
 */
#include "platform.h"

#include "device/grid/walk_all.h"
#include "device/trace/brute.h"

SK_KERNEL void trace_brute_count(sk_u32 n, sk_u32 first, sk_u32 most, sk_trace_params params,
                                 SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                 SK_GLOBAL sk_u32* hit_counts, SK_GLOBAL const float* packets,
                                 SK_GLOBAL const sk_u32* instance_starts, SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        hit_counts[i] = sk_brute_force_all(params, ray, packets, instance_starts, instances, skipped,
                                           (SK_GLOBAL SetkaHit*)0, most, 0);
    }
}

SK_KERNEL void trace_brute_all(sk_u32 n, sk_u32 first, sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                               SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL const sk_u32* hit_offsets,
                               SK_GLOBAL SetkaHit* hits, SK_GLOBAL const float* packets,
                               SK_GLOBAL const sk_u32* instance_starts,
                               SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        const sk_u32 start = hit_offsets[i];
        const sk_u32 found = sk_brute_force_all(params, ray, packets, instance_starts, instances, skipped,
                                                hits + start, hit_offsets[i + 1u] - start, 1);
        sk_finish_hits(params, ray, instance_starts, hits + start, found);
    }
}

SK_KERNEL void trace_grid_count(sk_u32 n, sk_u32 first, sk_u32 most, SetkaGridHeader grid, sk_trace_params params,
                                SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                SK_GLOBAL sk_u32* hit_counts, SK_GLOBAL const sk_block* blocks, SK_GLOBAL const sk_cell_list* cells, SK_GLOBAL const sk_u32* references,
                                SK_GLOBAL const float* triangles, SK_GLOBAL const sk_u32* instance_starts,
                                SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_grid_tables tables =
            sk_make_tables(blocks, cells, references, triangles, instance_starts, instances);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        hit_counts[i] = sk_walk_grid_all(grid, params, ray, tables, skipped, (SK_GLOBAL SetkaHit*)0, most, 0);
    }
}

SK_KERNEL void trace_grid_all(sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                              SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                              SK_GLOBAL const sk_u32* hit_offsets, SK_GLOBAL SetkaHit* hits,
                              SK_GLOBAL const sk_block* blocks, SK_GLOBAL const sk_cell_list* cells,
                              SK_GLOBAL const sk_u32* references, SK_GLOBAL const float* triangles,
                              SK_GLOBAL const sk_u32* instance_starts,
                              SK_GLOBAL const SetkaInstance* instances) {
    const sk_u32 i = first + sk_global_id();
    if (i < n) {
        const sk_working_ray ray = sk_prepare_ray(params, rays[i]);
        const sk_grid_tables tables =
            sk_make_tables(blocks, cells, references, triangles, instance_starts, instances);
        const sk_u32 skipped = sk_skipped_triangle(params, instance_starts, skip, i);
        const sk_u32 start = hit_offsets[i];
        const sk_u32 found =
            sk_walk_grid_all(grid, params, ray, tables, skipped, hits + start, hit_offsets[i + 1u] - start, 1);
        sk_finish_hits(params, ray, instance_starts, hits + start, found);
    }
}
