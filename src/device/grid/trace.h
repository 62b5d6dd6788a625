/* SPDX-License-Identifier: MIT */
/**
 * What does one work-item of a query do with the walks? On GPUs it walks with ray i of n as a member of its team; where i is past the
 * last ray it only helps. On CPUs it walks with the rays at places i to i + SK_ITEM_RAYS - 1 of n (trace/tiles.h).
 */
#ifndef SETKA_DEVICE_GRID_TRACE_H
#define SETKA_DEVICE_GRID_TRACE_H

#include "device/grid/walk.h"
#if SK_WIDTH > 1
#include "device/grid/walk_lanes.h"
#include "device/trace/tiles.h"
#endif

/** The rays of a work-item. */
#if SK_WIDTH > 1
#define SK_ITEM_RAYS (SK_WIDTH * SK_FLIGHTS)
#else
#define SK_ITEM_RAYS 1u
#endif

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

#if SK_WIDTH > 1

/** Traces the rays at places `first` to first + SK_ITEM_RAYS - 1, those that are less than n. The number of flights. */
SK_FUNCTION sk_u32 sk_trace_flights(sk_flight* flights, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                    SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                    sk_grid_tables tables, const int any) {
    sk_u32 count = 0u;
    for (sk_u32 i = first; i < n && count < SK_FLIGHTS; i += SK_WIDTH) {
        /* Lanes past the last ray trace it once more. */
#define SK_NUMBER(k) (sk_i32) sk_ray_at(params, sk_min_u32(i + (k), n - 1u))
        const sk_iN number = SK_INTS(SK_NUMBER);
#undef SK_NUMBER
        sk_iN skipped = sk_same_i((sk_i32)SETKA_NO_HIT);
        if (params.skips != 0u) {
#define SK_SKIPPED(k) (sk_i32) sk_skipped_triangle(params, tables.instance_starts, skip, (sk_u32)sk_lane(number, k))
            skipped = SK_INTS(SK_SKIPPED);
#undef SK_SKIPPED
        }
        sk_take_off(flights + count, grid, number, sk_prepare_ray_lanes(params, rays, number), skipped);
        count += 1u;
    }
    sk_walk_grid_lanes(grid, params, flights, count, tables, any);
    return count;
}

SK_FUNCTION void sk_trace_closest(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid,
                                  sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                                  SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL SetkaHit* hits,
                                  sk_grid_tables tables) {
    sk_flight flights[SK_FLIGHTS];
    const sk_u32 count = sk_trace_flights(flights, n, i, grid, params, rays, skip, tables, 0);
    (void)team;
    for (sk_u32 f = 0u; f < count; ++f) {
        float t[SK_WIDTH], u[SK_WIDTH], v[SK_WIDTH];
        sk_i32 triangle[SK_WIDTH], number[SK_WIDTH];
        sk_store_i(flights[f].number, number);
        sk_store_f(sk_user_t_lanes(flights[f].ray, flights[f].best.w), t);
        sk_store_f(flights[f].best.u, u);
        sk_store_f(flights[f].best.v, v);
        sk_store_i(flights[f].best.triangle, triangle);
        for (sk_u32 k = 0u; k < SK_WIDTH && i + f * SK_WIDTH + k < n; ++k)
            hits[number[k]] = sk_name_hit(params, tables.instance_starts, t[k], u[k], v[k], (sk_u32)triangle[k]);
    }
}

SK_FUNCTION void sk_trace_any(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid, sk_trace_params params,
                              SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                              SK_GLOBAL sk_u32* occluded, sk_grid_tables tables) {
    sk_flight flights[SK_FLIGHTS];
    const sk_u32 count = sk_trace_flights(flights, n, i, grid, params, rays, skip, tables, 1);
    (void)team;
    for (sk_u32 f = 0u; f < count; ++f) {
        sk_i32 triangle[SK_WIDTH], number[SK_WIDTH];
        sk_store_i(flights[f].number, number);
        sk_store_i(flights[f].best.triangle, triangle);
        for (sk_u32 k = 0u; k < SK_WIDTH && i + f * SK_WIDTH + k < n; ++k)
            occluded[number[k]] = (sk_u32)triangle[k] != SETKA_NO_HIT ? 1u : 0u;
    }
}

#else

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

#endif

SK_FUNCTION void sk_trace_cost(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid, sk_trace_params params,
                               SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                               SK_GLOBAL SetkaTraceCost* costs, sk_grid_tables tables) {
    const sk_traced traced = sk_trace_ray(team, n, i, grid, params, rays, skip, tables, 0);
    if (i < n) costs[i] = traced.walk.cost;
}

#endif
