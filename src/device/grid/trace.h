/* SPDX-License-Identifier: MIT */
/**
 * What does one work-item of a query do with the walks? On GPUs it is a member of a team: of a list it walks with one ray after the other, of a picture
 * with one; where there is none for it, it only helps. On CPUs it walks with those at SK_ITEM_RAYS places (trace/tiles.h).
 */
#ifndef SETKA_DEVICE_GRID_TRACE_H
#define SETKA_DEVICE_GRID_TRACE_H

#include "device/grid/walk.h"
#include "device/grid/walk_frustum_team.h"
#include "device/trace/tiles.h"
#if SK_WIDTH > 1
#include "device/grid/walk_frustum.h"
#include "device/grid/walk_lanes.h"
#endif

/** A member's ray: what does not change on its way. */
typedef struct sk_member_ray {
    sk_u32 number, skip;
    sk_working_ray ray;
} sk_member_ray;

/** Ray `number`, or one that hits nothing. */
SK_FUNCTION sk_member_ray sk_take_ray(sk_u32 number, int valid, sk_trace_params params, SK_GLOBAL const SetkaRay* rays,
                                      SK_GLOBAL const SetkaPrimitive* skip, sk_grid_tables tables) {
    sk_member_ray r;
    r.number = number;
    r.skip = sk_skipped_triangle(params, tables.instance_starts, skip, number);
    r.ray = sk_prepare_ray(params, rays[number]);
    if (!valid) r.ray.valid = 0;
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
        const sk_iN number = sk_rays_at(params, i, n);
        sk_iN skipped = sk_same_i((sk_i32)SETKA_NO_HIT);
        if (params.skips != 0u) {
#define SK_SKIPPED(k) (sk_i32) sk_skipped_triangle(params, tables.instance_starts, skip, (sk_u32)sk_lane(number, k))
            skipped = SK_INTS(SK_SKIPPED);
#undef SK_SKIPPED
        }
        sk_take_off(flights + count, number, sk_prepare_ray_lanes(params, rays, number), skipped);
        count += 1u;
    }
    sk_walk_frustums(grid, params, flights, count, tables, any);
    sk_walk_grid_lanes(grid, params, flights, count, tables, any);
    return count;
}

/** Writes the hits of the first `count` rays of a flight. */
SK_FUNCTION void sk_write_hits(const sk_flight* f, sk_u32 count, sk_trace_params params, sk_grid_tables tables, SK_GLOBAL SetkaHit* hits) {
    const sk_iN none = f->best.triangle == sk_same_i((sk_i32)SETKA_NO_HIT);
    const sk_fN zero = sk_same_f(0.0f);
    sk_iN instance = none, primitive = f->best.triangle;
    sk_i32 number[SK_WIDTH], instances[SK_WIDTH];
    float rows[4][SK_WIDTH];
    if (params.instance_count > 1u) {
#define SK_INSTANCE_OF(k) \
    sk_lane(none, k) != 0 ? -1 : (sk_i32)sk_find_segment(tables.instance_starts, params.instance_count, (sk_u32)sk_lane(primitive, k))
        instance = SK_INTS(SK_INSTANCE_OF);
#undef SK_INSTANCE_OF
        primitive = sk_select_i(none, primitive, primitive - sk_gather_i(tables.instance_starts, instance & ~none, 1u));
    }
    const sk_columns turned = sk_turn_rows(sk_select_f(none, sk_same_f(sk_bits_float(0x7f800000u)), sk_user_t_lanes(f->ray, f->best.w)),
                                           sk_select_f(none, zero, f->best.u), sk_select_f(none, zero, f->best.v), sk_lanes_as_float(primitive));
    sk_store_f(turned.a, rows[0]);
    sk_store_f(turned.b, rows[1]);
    sk_store_f(turned.c, rows[2]);
    sk_store_f(turned.d, rows[3]);
    sk_store_i(f->number, number);
    sk_store_i(instance, instances);
    for (sk_u32 k = 0u; k < count; ++k) {
        SK_GLOBAL SetkaHit* const hit = hits + number[k];
        sk_store_f4(sk_load_f4(&rows[k % 4u][k / 4u * 4u]), &hit->t);
        hit->instance = (sk_u32)instances[k];
    }
}

typedef sk_team sk_list_team;

SK_FUNCTION void sk_trace_closest(SK_SHARED sk_list_team* team, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                  SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL SetkaHit* hits,
                                  sk_grid_tables tables, SK_GLOBAL sk_u32* counts) {
    sk_flight flights[SK_FLIGHTS];
    const sk_u32 i = first + sk_global_id() * SK_ITEM_RAYS;
    const sk_u32 count = sk_trace_flights(flights, n, i, grid, params, rays, skip, tables, 0);
    (void)team, (void)counts;
    for (sk_u32 f = 0u; f < count; ++f) sk_write_hits(flights + f, sk_min_u32(n - (i + f * SK_WIDTH), SK_WIDTH), params, tables, hits);
}

SK_FUNCTION void sk_trace_any(SK_SHARED sk_list_team* team, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                              SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL sk_u32* occluded,
                              sk_grid_tables tables, SK_GLOBAL sk_u32* counts) {
    sk_flight flights[SK_FLIGHTS];
    const sk_u32 i = first + sk_global_id() * SK_ITEM_RAYS;
    const sk_u32 count = sk_trace_flights(flights, n, i, grid, params, rays, skip, tables, 1);
    (void)team, (void)counts;
    for (sk_u32 f = 0u; f < count; ++f) {
        sk_i32 triangle[SK_WIDTH], number[SK_WIDTH];
        sk_store_i(flights[f].number, number);
        sk_store_i(flights[f].best.triangle, triangle);
        for (sk_u32 k = 0u; k < SK_WIDTH && i + f * SK_WIDTH + k < n; ++k)
            occluded[number[k]] = (sk_u32)triangle[k] != SETKA_NO_HIT ? 1u : 0u;
    }
}

#else

#if SK_TEAM > 1

/** So many members have to be without a ray before their team takes more: to prepare one takes as long as to prepare many. */
#define SK_IDLE (SK_TEAM * 5u / 8u)

/** What the members of a team share that traces a list. */
typedef struct sk_list_team {
    sk_team walk;
    sk_u32 takers; /* bit m: member m is without a ray */
    sk_u32 before; /* so many rays were taken before */
} sk_list_team;

/**
 * Traces rays `first` to n - 1 of a list as one of many teams. Some rays end after few rounds, some after many: where enough members are without one,
 * the team takes as many of those that no team has yet. Which member of which team traces a ray is a matter of time; what it hits is not. What decides
 * where loops end is the same for all members: `walkers` and `more`. A round ends with a barrier, behind which nobody reads what members had for it.
 */
SK_FUNCTION void sk_trace_list(SK_SHARED sk_list_team* team, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                               SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL SetkaHit* hits,
                               SK_GLOBAL sk_u32* occluded, sk_grid_tables tables, SK_GLOBAL sk_u32* counts, const int any) {
    const sk_u32 member = sk_local_id(), teams = sk_group_count();
    /* Each team begins with as many; where a list is short, that is less than a ray for each member. */
    const sk_u32 share = sk_min_u32(SK_TEAM, (n - first + teams - 1u) / teams);
    const sk_u32 common = first + share * teams; /* rays from here on are for whoever takes them */
    sk_u32 number = member < share ? first + sk_group_id() * share + member : n, phase = 0u;
    int more = common < n, goes_on, idle = 1;
    sk_member_ray own;
    sk_walker walker;
    if (member == 0u) team->takers = 0u;
    sk_clear_rounds(&team->walk.round, member);
    SK_TEAM_BARRIER();
    do {
        sk_u32 walkers;
        if (idle) {
            own = sk_take_ray(sk_min_u32(number, n - 1u), number < n, params, rays, skip, tables);
            walker = sk_set_out(grid, own.ray);
            team->walk.views[member] = sk_viewpoint_of(own.ray);
        }
        do {
            walkers = sk_walkers_of(sk_walk_round(&team->walk, phase, member, grid, params, own.ray, tables, own.skip, &walker, any));
            phase ^= 1u;
        } while (walkers > (more ? SK_TEAM - SK_IDLE : 0u));
        idle = !walker.search.at.walking;
        if (idle && number < n) {
            if (any) occluded[number] = walker.walk.best.triangle != SETKA_NO_HIT ? 1u : 0u;
            else hits[number] = sk_make_hit(params, own.ray, tables.instance_starts, walker.walk.best);
        }
        goes_on = more;
        if (more) {
            if (idle) sk_team_or(&team->takers, 1u << member);
            SK_TEAM_BARRIER();
            const sk_u32 takers = team->takers, wanted = sk_popcount(takers);
            if (member == 0u) team->before = sk_atomic_add(counts + SK_RAYS_TAKEN, wanted);
            SK_TEAM_BARRIER();
            const sk_u32 next = common + team->before;
            if (member == 0u) team->takers = 0u;
            if (idle) number = next + sk_popcount(takers & ((1u << member) - 1u));
            more = next + wanted < n;
        }
    } while (goes_on);
    if (member == 0u && sk_atomic_add(counts + SK_TEAMS_DONE, 1u) == teams - 1u) {
        sk_atomic_exchange(counts + SK_RAYS_TAKEN, 0u);
        sk_atomic_exchange(counts + SK_TEAMS_DONE, 0u);
    }
}

SK_FUNCTION void sk_trace_closest(SK_SHARED sk_list_team* team, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                  SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL SetkaHit* hits,
                                  sk_grid_tables tables, SK_GLOBAL sk_u32* counts) {
    sk_trace_list(team, n, first, grid, params, rays, skip, hits, (SK_GLOBAL sk_u32*)0, tables, counts, 0);
}

SK_FUNCTION void sk_trace_any(SK_SHARED sk_list_team* team, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                              SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL sk_u32* occluded,
                              sk_grid_tables tables, SK_GLOBAL sk_u32* counts) {
    sk_trace_list(team, n, first, grid, params, rays, skip, (SK_GLOBAL SetkaHit*)0, occluded, tables, counts, 1);
}

#else

typedef sk_team sk_list_team;

SK_FUNCTION void sk_trace_closest(SK_SHARED sk_list_team* team, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                                  SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL SetkaHit* hits,
                                  sk_grid_tables tables, SK_GLOBAL sk_u32* counts) {
    const sk_u32 i = first + sk_global_id();
    (void)counts;
    if (i < n) {
        const sk_member_ray own = sk_take_ray(i, 1, params, rays, skip, tables);
        hits[i] = sk_make_hit(params, own.ray, tables.instance_starts, sk_walk_grid(team, 0u, grid, params, own.ray, tables, own.skip, 0).best);
    }
}

SK_FUNCTION void sk_trace_any(SK_SHARED sk_list_team* team, sk_u32 n, sk_u32 first, SetkaGridHeader grid, sk_trace_params params,
                              SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL sk_u32* occluded,
                              sk_grid_tables tables, SK_GLOBAL sk_u32* counts) {
    const sk_u32 i = first + sk_global_id();
    (void)counts;
    if (i < n) {
        const sk_member_ray own = sk_take_ray(i, 1, params, rays, skip, tables);
        occluded[i] = sk_walk_grid(team, 0u, grid, params, own.ray, tables, own.skip, 1).best.triangle != SETKA_NO_HIT ? 1u : 0u;
    }
}

#endif

/** What a member's ray hits, of rays of a picture. */
SK_FUNCTION sk_best sk_trace_in_picture(SK_SHARED sk_picture_team* team, SetkaGridHeader grid, sk_trace_params params, sk_member_ray own,
                                        sk_grid_tables tables, const int any) {
    const sk_u32 member = sk_local_id() % SK_TEAM;
#if SK_TEAM == 32
    const sk_span span = sk_limit(own.ray);
    sk_beam beam;
    sk_best r = sk_no_hit();
    if (sk_make_beam(&team->beam, member, grid, own.ray, span, &beam)) {
        if (beam.first <= beam.last)
            r = sk_walk_beam(&team->beam, member, grid, params, own.ray, span, beam, tables, own.skip, any);
    } else {
        SK_TEAM_BARRIER(); /* the memory is put to another use */
        r = sk_walk_grid(&team->walk, member, grid, params, own.ray, tables, own.skip, any).best;
    }
    return r;
#else
    return sk_walk_grid(&team->walk, member, grid, params, own.ray, tables, own.skip, any).best;
#endif
}

SK_FUNCTION void sk_trace_closest_picture(SK_SHARED sk_picture_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid,
                                          sk_trace_params params, SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                                          SK_GLOBAL SetkaHit* hits, sk_grid_tables tables) {
    const sk_member_ray own = sk_take_ray(sk_ray_at(params, sk_min_u32(i, n - 1u)), i < n, params, rays, skip, tables);
    const sk_best best = sk_trace_in_picture(team, grid, params, own, tables, 0);
    if (i < n) hits[own.number] = sk_make_hit(params, own.ray, tables.instance_starts, best);
}

SK_FUNCTION void sk_trace_any_picture(SK_SHARED sk_picture_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid, sk_trace_params params,
                                      SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip, SK_GLOBAL sk_u32* occluded,
                                      sk_grid_tables tables) {
    const sk_member_ray own = sk_take_ray(sk_ray_at(params, sk_min_u32(i, n - 1u)), i < n, params, rays, skip, tables);
    const sk_best best = sk_trace_in_picture(team, grid, params, own, tables, 1);
    if (i < n) occluded[own.number] = best.triangle != SETKA_NO_HIT ? 1u : 0u;
}

#endif

/** What the walk of each ray alone costs. */
SK_FUNCTION void sk_trace_cost(SK_SHARED sk_team* team, sk_u32 n, sk_u32 i, SetkaGridHeader grid, sk_trace_params params,
                               SK_GLOBAL const SetkaRay* rays, SK_GLOBAL const SetkaPrimitive* skip,
                               SK_GLOBAL SetkaTraceCost* costs, sk_grid_tables tables) {
    const sk_member_ray own = sk_take_ray(sk_min_u32(i, n - 1u), i < n, params, rays, skip, tables);
    const sk_walk walk = sk_walk_grid(team, sk_local_id() % SK_TEAM, grid, params, own.ray, tables, own.skip, 0);
    if (i < n) costs[i] = walk.cost;
}

#endif
