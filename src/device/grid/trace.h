/* SPDX-License-Identifier: MIT */
/**
 * What does one work-item of a query do with the walks of walk.h? It walks with ray i of n as a member of its team; where i is past the
 * last ray it only helps.
 */
#ifndef SETKA_DEVICE_GRID_TRACE_H
#define SETKA_DEVICE_GRID_TRACE_H

#include "device/grid/walk.h"

/** A ray and what it hit. */
typedef struct sk_traced {
    sk_working_ray ray;
    sk_walk walk;
} sk_traced;

SK_FUNCTION sk_traced sk_trace_ray(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid,
                                   sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                                   SK_GLOBAL const SetkaPrimitive* skip, sk_grid_tables tables, const int any) {
    const sk_u32 read = sk_min_u32(i, n - 1u);
    const sk_u32 skipped = sk_skipped_triangle(params, tables.instance_starts, skip, read);
    sk_traced r;
    r.ray = sk_prepare_ray(params, rays[read]);
    if (i >= n) r.ray.valid = 0;
    r.walk = sk_walk_grid(team, sk_local_id() % SK_TEAM, grid, params, r.ray, tables, skipped, any);
    return r;
}

SK_FUNCTION void sk_trace_closest(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid,
                                  sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                                  SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL SetkaHit* hits,
                                  sk_grid_tables tables) {
    const sk_traced traced = sk_trace_ray(team, n, i, grid, params, rays, skip, tables, 0);
    if (i < n) hits[i] = sk_make_hit(params, traced.ray, tables.instance_starts, traced.walk.best);
}

SK_FUNCTION void sk_trace_any(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid, sk_trace_params params,
                              SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                              SK_GLOBAL sk_u32* occluded, sk_grid_tables tables) {
    const sk_traced traced = sk_trace_ray(team, n, i, grid, params, rays, skip, tables, 1);
    if (i < n) occluded[i] = traced.walk.best.triangle != SETKA_NO_HIT ? 1u : 0u;
}

SK_FUNCTION void sk_trace_cost(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid, sk_trace_params params,
                               SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                               SK_GLOBAL SetkaTraceCost* costs, sk_grid_tables tables) {
    const sk_traced traced = sk_trace_ray(team, n, i, grid, params, rays, skip, tables, 0);
    if (i < n) costs[i] = traced.walk.cost;
}

#endif
