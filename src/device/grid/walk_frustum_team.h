/* SPDX-License-Identifier: MIT */
/**
 * What do the neighbouring rays of a team hit in the grid? If all go much the same way, the team takes them through the grid as one frustum, four slices
 * of cells at a time (frustum.h). Its members look for the lists there, each in cells of its own; then each takes a triangle of those lists and
 * asks whether it reaches into the frustum at all; the few that do are tested by all members, each with its own ray. So no ray looks for
 * cells, no triangle is loaded for each ray that comes near, and a long list costs a team as much as one ray. The tests are those of
 * triangle.h, so that the hits are the same (src/README.md, "Frustums").
 */
#ifndef SETKA_DEVICE_GRID_WALK_FRUSTUM_TEAM_H
#define SETKA_DEVICE_GRID_WALK_FRUSTUM_TEAM_H

#include "device/grid/frustum.h"
#include "device/grid/walk.h"

#if SK_TEAM == 32

/** The most cells across a frustum of a team that is worth it, as a mean of both ends. */
#define SK_TEAM_CELLS 8.0f
/** Added to numbers of slices, which are -4096 or more, where they are unsigned. */
#define SK_SLICE_BIAS 8192

/** How many triangles a beam remembers that it has met, by their lowest bits. */
#define SK_MET 256u

/** The frustum of a team's rays. */
typedef struct sk_beam {
    sk_u32 kz;              /* the axis that it goes along, as all of its rays */
    sk_i32 flip;            /* -1 where it is mirrored, else 0 */
    sk_i32 lowest, highest; /* of the grid's slices */
    sk_i32 first, last;     /* of the slices that its rays pass */
} sk_beam;

/** What the members of a team share that goes as a beam. */
typedef struct sk_beam_team {
    sk_round round;
    sk_flanks x, y;               /* of the beam, in the scene's units from the grid's origin on */
    sk_flanks slice_x, slice_y;   /* in cells, those that slice s touches: from low + s * low_slope to high + s * high_slope */
    sk_u32 ways, first, last;
    sk_u32 clearances[2];
    sk_u32 reaching[2];           /* so many corners, of this row and of the next */
    union {
        sk_corners corners[SK_TEAM];
        float sides[8][SK_TEAM];
        float least[SK_TEAM];
    } of;
    sk_u32 met[SK_MET];
} sk_beam_team;

/** A team's memory, whether it goes as a beam or not. */
typedef union sk_picture_team {
    sk_team walk;
    sk_beam_team beam;
} sk_picture_team;

/** `z` on the scene's axis kz along the way of a beam. */
SK_FUNCTION float sk_way_to(SetkaGridHeader grid, sk_u32 kz, sk_i32 flip, float z) {
    const float way = (z - sk_origin_of(grid, kz)) * grid.inverse_cell_size;
    return flip != 0 ? -way : way;
}

/** The slice at `way`, or the grid's first or last one. */
SK_FUNCTION sk_i32 sk_slice_at(float way, sk_i32 lowest, sk_i32 highest) {
    return (sk_i32)sk_floor(sk_min(sk_max(way, (float)lowest), (float)highest));
}

/** The last slice that a ray passes which ends at `last`. */
SK_FUNCTION sk_i32 sk_last_slice(SetkaGridHeader grid, sk_beam t, sk_working_ray ray, float last) {
    const float z = ray.oz + last * sk_component(ray.d, ray.kz);
    return sk_slice_at(sk_way_to(grid, ray.kz, t.flip, z) + SK_SLICE_PAD, t.lowest, t.highest);
}

/** The least of each row of `sides`, for every member. */
SK_FUNCTION void sk_least_of_sides(SK_SHARED sk_beam_team* team, sk_u32 member, float* least) {
    const sk_u32 row = member / 4u, part = member % 4u * 8u;
    float r = team->of.sides[row][part + row]; /* each in its own bank of memory */
    for (sk_u32 k = 1u; k < 8u; ++k) r = sk_min(r, team->of.sides[row][part + (k + row) % 8u]);
    SK_TEAM_BARRIER();
    team->of.least[member] = r;
    SK_TEAM_BARRIER();
    for (sk_u32 k = 0u; k < 8u; ++k)
        least[k] = sk_min(sk_min(team->of.least[4u * k], team->of.least[4u * k + 1u]), sk_min(team->of.least[4u * k + 2u], team->of.least[4u * k + 3u]));
}

/** For the cells that a slice touches, which is from 0 to 1 and SK_SLICE_PAD more. */
SK_FUNCTION sk_flanks sk_flanks_of_slices(sk_flanks s) {
    sk_flanks r = s;
    r.low = s.low + (s.low_slope < 0.0f ? 1.0f + SK_SLICE_PAD : -SK_SLICE_PAD) * s.low_slope;
    r.high = s.high + (s.high_slope < 0.0f ? -SK_SLICE_PAD : 1.0f + SK_SLICE_PAD) * s.high_slope;
    return r;
}

/**
 * Makes the beam of the team's rays, each of which is of interest in `span`. Whether they go the same way and it is a slim one; if none is of interest, it
 * is one that ends before it begins.
 */
SK_FUNCTION int sk_make_beam(SK_SHARED sk_beam_team* team, sk_u32 member, SetkaGridHeader grid, sk_working_ray ray, sk_span span, sk_beam* t) {
    const sk_u32 way = 2u * ray.kz + (ray.sz < 0.0f ? 1u : 0u); /* the axis and the direction along it */
    sk_u32 ways;
    int slim = 1;
    t->kz = ray.kz;
    t->flip = -(sk_i32)(way & 1u);
    t->lowest = t->flip & -(sk_i32)sk_dim_of(grid, ray.kz);
    t->highest = t->lowest + (sk_i32)sk_dim_of(grid, ray.kz) - 1;
    if (member == 0u) {
        team->ways = 0u;
        team->first = 0xffffffffu;
        team->last = 0u;
    }
    SK_TEAM_BARRIER();
    if (span.meets) {
        const float start = sk_way_to(grid, ray.kz, t->flip, ray.oz + span.w0 * sk_component(ray.d, ray.kz));
        sk_team_or(&team->ways, 1u << way);
        sk_team_min(&team->first, (sk_u32)(sk_slice_at(start, t->lowest, t->highest) + SK_SLICE_BIAS));
        sk_team_max(&team->last, (sk_u32)(sk_last_slice(grid, *t, ray, span.w1) + SK_SLICE_BIAS));
    }
    SK_TEAM_BARRIER();
    ways = team->ways;
    t->first = (sk_i32)team->first - SK_SLICE_BIAS;
    t->last = (sk_i32)team->last - SK_SLICE_BIAS;
    /* Members whose ray is of no interest take the way of the others. */
    t->kz = sk_popcount((ways - 1u) & ~ways) / 2u;
    t->flip = (ways & 0x2au) != 0u ? -1 : 0;
    t->lowest = t->flip & -(sk_i32)sk_dim_of(grid, t->kz);
    t->highest = t->lowest + (sk_i32)sk_dim_of(grid, t->kz) - 1;
    if (ways == 0u) {
        t->first = 0;
        t->last = -1;
    } else if ((ways & (ways - 1u)) != 0u) {
        slim = 0;
    } else {
        const float start = (float)t->first - SK_SLICE_PAD, length = (float)(t->last + 1) + SK_SLICE_PAD - start;
        const float to_start = start - sk_way_to(grid, ray.kz, t->flip, ray.oz), turn = t->flip != 0 ? -1.0f : 1.0f;
        const float sx = ray.sx * turn, sy = ray.sy * turn;
        const float x0 = (ray.ox - sk_origin_of(grid, ray.kx)) * grid.inverse_cell_size + to_start * sx, x1 = x0 + length * sx;
        const float y0 = (ray.oy - sk_origin_of(grid, ray.ky)) * grid.inverse_cell_size + to_start * sy, y1 = y0 + length * sy;
        float least[8];
        team->of.sides[0][member] = span.meets ? x0 : SK_BEYOND;
        team->of.sides[1][member] = span.meets ? -x0 : SK_BEYOND;
        team->of.sides[2][member] = span.meets ? y0 : SK_BEYOND;
        team->of.sides[3][member] = span.meets ? -y0 : SK_BEYOND;
        team->of.sides[4][member] = span.meets ? x1 : SK_BEYOND;
        team->of.sides[5][member] = span.meets ? -x1 : SK_BEYOND;
        team->of.sides[6][member] = span.meets ? y1 : SK_BEYOND;
        team->of.sides[7][member] = span.meets ? -y1 : SK_BEYOND;
        SK_TEAM_BARRIER();
        sk_least_of_sides(team, member, least);
        slim = (1.0f - least[1] - least[0]) * (1.0f - least[3] - least[2]) + (1.0f - least[5] - least[4]) * (1.0f - least[7] - least[6]) <=
               2.0f * SK_TEAM_CELLS;
        if (member == 0u) {
            const sk_flanks x = sk_make_flanks(least[0], -least[1], least[4], -least[5], start, 1.0f / length);
            const sk_flanks y = sk_make_flanks(least[2], -least[3], least[6], -least[7], start, 1.0f / length);
            team->x = sk_scale_flanks(x, grid.cell_size);
            team->y = sk_scale_flanks(y, grid.cell_size);
            team->slice_x = sk_flanks_of_slices(x);
            team->slice_y = sk_flanks_of_slices(y);
        }
    }
    return slim;
}

/** Where a member looks for lists: in one slice, in every fourth cell across it of every second row. It is at this one of those that the beam touches. */
typedef struct sk_lookout {
    sk_i32 x, y;
} sk_lookout;

/** Beyond the last row. */
#define SK_NO_ROW 0x10000

SK_FUNCTION sk_range sk_cells_of_slice(sk_flanks s, float slice, sk_u32 dim) {
    sk_range r;
    r.first = (sk_i32)sk_cell(s.low + slice * s.low_slope, dim);
    r.last = (sk_i32)sk_cell(s.high + slice * s.high_slope, dim);
    return r;
}

/** The next list that a member finds; empty if there is none. */
SK_FUNCTION sk_cell_list sk_next_list(SK_SHARED sk_beam_team* team, SetkaGridHeader grid, sk_grid_tables tables, sk_viewpoint axes, sk_beam t,
                                      sk_i32 slice, sk_lookout* at, SK_SHARED sk_u32* clearance) {
    const sk_dims dims = sk_block_dims(sk_cell_dims(grid));
    const sk_range across = sk_cells_of_slice(team->slice_x, (float)slice, sk_dim_of(grid, axes.kx));
    const sk_range up = sk_cells_of_slice(team->slice_y, (float)slice, sk_dim_of(grid, axes.ky));
    const sk_u32 cell = (sk_u32)(slice ^ t.flip), slice_block = cell / 4u * sk_block_step(dims, axes.kz), slice_bit = (cell & 3u) << 2u * axes.kz;
    sk_u32 least = 15u;
    sk_cell_list r;
    r.offset = 0u;
    r.count = 0u;
    SK_UNROLL(1)
    while (r.count == 0u && up.first + at->y <= up.last) {
        const sk_u32 x = (sk_u32)(across.first + at->x), y = (sk_u32)(up.first + at->y);
        if ((sk_i32)x <= across.last) {
            const sk_block block = tables.blocks[slice_block + x / 4u * sk_block_step(dims, axes.kx) + y / 4u * sk_block_step(dims, axes.ky)];
            const sk_u32 bit = slice_bit + ((x & 3u) << 2u * axes.kx) + ((y & 3u) << 2u * axes.ky);
            least = sk_min_u32(least, block.clearance);
            if (sk_has_bit(block, bit)) r = sk_find_list(tables, block, bit);
        }
        at->x += 4;
        if (across.first + at->x > across.last) {
            at->x &= 3;
            at->y += 2;
        }
    }
    if (up.first + at->y > up.last) at->y = SK_NO_ROW;
    sk_team_min(clearance, least);
    return r;
}

SK_FUNCTION int sk_is_beside(sk_flanks s, float least, float most, float near, float far) {
    return most < s.low + (s.low_slope < 0.0f ? far : near) * s.low_slope ||
           least > s.high + (s.high_slope < 0.0f ? near : far) * s.high_slope;
}

SK_FUNCTION float sk_least_of(float a, float b, float c) { return sk_min(sk_min(a, b), c); }
SK_FUNCTION float sk_most_of(float a, float b, float c) { return sk_max(sk_max(a, b), c); }

/** Whether the triangle's box reaches into the beam, up to slice `last`. */
SK_FUNCTION int sk_reaches(SK_SHARED sk_beam_team* team, SetkaGridHeader grid, sk_viewpoint axes, sk_beam t, sk_corners c, sk_i32 last) {
    const float gx = sk_origin_of(grid, axes.kx), gy = sk_origin_of(grid, axes.ky), gz = sk_origin_of(grid, axes.kz);
    const float low = sk_least_of(c.z0, c.z1, c.z2) - gz, high = sk_most_of(c.z0, c.z1, c.z2) - gz;
    const float near = t.flip != 0 ? -high : low, far = t.flip != 0 ? -low : high;
    return !(near > ((float)(last + 1) + SK_SLICE_PAD) * grid.cell_size) &&
           !sk_is_beside(team->x, sk_least_of(c.x0, c.x1, c.x2) - gx, sk_most_of(c.x0, c.x1, c.x2) - gx, near, far) &&
           !sk_is_beside(team->y, sk_least_of(c.y0, c.y1, c.y2) - gy, sk_most_of(c.y0, c.y1, c.y2) - gy, near, far);
}

/** A ray with the axes of its team's beam: those that it has, if it is of interest. */
SK_FUNCTION sk_working_ray sk_turn_ray(sk_working_ray ray, sk_u32 kz) {
    sk_working_ray r = ray;
    r.kz = kz;
    r.kx = kz == 2u ? 0u : kz + 1u;
    r.ky = r.kx == 2u ? 0u : r.kx + 1u;
    return r;
}

/** Takes the team through the grid as a beam. The walk ends: each turn goes on by four slices or more. */
SK_FUNCTION sk_best sk_walk_beam(SK_SHARED sk_beam_team* team, sk_u32 member, SetkaGridHeader grid, sk_trace_params params, sk_working_ray own_ray,
                                 sk_span span, sk_beam beam, sk_grid_tables tables, sk_u32 skip, const int any) {
    const sk_working_ray ray = sk_turn_ray(own_ray, beam.kz);
    const sk_viewpoint from = sk_viewpoint_of(ray);
    sk_u32 phase = 0u, side = 0u, turn = 0u;
    sk_i32 slice = beam.first, last = beam.last;
    int walking = span.meets;
    sk_best best = sk_no_hit();
    for (sk_u32 k = member; k < SK_MET; k += SK_TEAM) team->met[k] = SETKA_NO_HIT;
    sk_clear_rounds(&team->round, member);
    if (member == 0u) {
        team->clearances[0] = 15u;
        team->clearances[1] = 15u;
        team->reaching[0] = 0u;
        team->reaching[1] = 0u;
    }
    SK_TEAM_BARRIER();
    while (slice <= last) {
        const sk_i32 slab = slice >> 2, own = slab * 4 + (sk_i32)(member % 4u);
        sk_lookout at;
        sk_cell_list list;
        sk_u32 total;
        int tested = 0;
        at.x = (sk_i32)(member / 4u % 4u);
        at.y = own >= slice && own <= last ? (sk_i32)(member / 16u) : SK_NO_ROW;
        list.offset = 0u;
        list.count = 0u;
        do {
            if (list.count == 0u && at.y != SK_NO_ROW) list = sk_next_list(team, grid, tables, from, beam, own, &at, &team->clearances[turn]);
            const sk_u32 count = sk_min_u32(list.count, SK_ROUND);
            if (count != 0u) sk_offer(&team->round, phase, member, list.offset, count);
            list.offset += count;
            list.count -= count;
            if (list.count != 0u || at.y != SK_NO_ROW) sk_offer(&team->round, phase, member, 0u, 0u);
            SK_TEAM_BARRIER();
            total = team->round.totals[phase];
            slice = (slab + (sk_i32)((team->clearances[turn] + 4u) / 4u)) * 4;
            sk_clear_next_round(&team->round, phase, member);
            if (member == 0u) {
                team->clearances[turn ^ 1u] = 15u;
                team->last = 0u;
            }
            const sk_u32 pairs = SK_PAIRS_OF(total);
            sk_u32 begun = 0u;
            SK_UNROLL(1)
            for (sk_u32 first = 0u; first < pairs; first += SK_TEAM) {
                const sk_u32 starts = team->round.starts[phase][first / SK_TEAM];
                if (first + member < pairs) {
                    const sk_u32 upto = 0xffffffffu >> (31u - member); /* this member's bit and those before */
                    const sk_u32 number = sk_find_pair(&team->round, tables, first + member, begun + sk_popcount(starts & upto) - 1u).number;
                    if (sk_team_exchange(&team->met[number % SK_MET], number) != number) {
                        sk_corners corners = sk_load_corners(from.kx, from.ky, from.kz, tables.triangles, number * 9u, 1u);
                        corners.number = number;
                        if (sk_reaches(team, grid, from, beam, corners, last)) team->of.corners[sk_team_add(&team->reaching[side], 1u)] = corners;
                    }
                }
                begun += sk_popcount(starts);
                SK_TEAM_BARRIER();
                const sk_u32 reaching = team->reaching[side];
                sk_u32 candidates = 0u;
                if (member == 0u) team->reaching[side ^ 1u] = 0u;
                if (walking) {
                    SK_UNROLL(2)
                    for (sk_u32 k = 0u; k < reaching; ++k)
                        if (sk_may_pass(sk_view_corners(from, team->of.corners[k]))) candidates |= 1u << k;
                }
                SK_UNROLL(1)
                for (; candidates != 0u; candidates &= candidates - 1u) {
                    const sk_u32 k = sk_popcount((candidates - 1u) & ~candidates);
                    const sk_corners corners = team->of.corners[k];
                    best = sk_test_candidate_view(tables, params, ray, sk_view_corners(from, corners), corners.number, skip, best);
                }
                SK_TEAM_BARRIER();
                side ^= 1u;
                tested = 1;
            }
            if (pairs == 0u) SK_TEAM_BARRIER(); /* before the next offers to what has been cleared */
            phase ^= 1u;
        } while (total >= SK_WITHOUT_LIST);
        turn ^= 1u;
        if (tested) {
            if (any && best.triangle != SETKA_NO_HIT) walking = 0;
            if (walking) {
                const float end = best.triangle != SETKA_NO_HIT ? sk_min(best.w, span.w1) : span.w1;
                sk_team_max(&team->last, (sk_u32)(sk_last_slice(grid, beam, ray, end) + SK_SLICE_BIAS));
            }
            SK_TEAM_BARRIER();
            last = (sk_i32)team->last - SK_SLICE_BIAS;
        }
    }
    return best;
}

#else

typedef union sk_picture_team {
    sk_team walk;
} sk_picture_team;

#endif
#endif
