/* SPDX-License-Identifier: MIT */
/**
 * Which cells does a ray pass, and what does it hit in them? Two walks through the uniform grid. One leaves a cell by the smallest
 * of three exit parameters (Amanatides & Woo 1987), and empty blocks of cells as if they were one; the other moves from cell to
 * cell by the signs of cross products, without a branch or a division (Maltsev & Mikhaylyuk 2012, section 3). src/README.md
 * ("Traversal") has the argument why neither misses a hit.
 */
#ifndef SETKA_DEVICE_GRID_WALK_H
#define SETKA_DEVICE_GRID_WALK_H

#include "device/grid/cells.h"
#include "device/grid/cell_list.h"

/**
 * The distance in cells to a face that is never reached: far beyond a ray's way through the scene's box, which is a few times
 * 4096 cells, and small enough that a product with a speed in cells cannot overflow (cells are at least 2^-80 wide).
 */
#define SK_NEVER 0x1p30f
/** What turns SK_NEVER into a parameter beyond any other for an axis that the ray is parallel to. */
#define SK_PARALLEL_INVERSE 0x1p90f

/** The most moves that a walk makes before it looks whether others of its team have a list to test. */
#define SK_TURNS 2u

typedef struct sk_walk {
    sk_best best;
    SetkaTraceCost cost;
} sk_walk;

/**
 * One axis of the walk: origin + w * speed in cells, mirrored so that every ray moves down: `index` ^ `flip` is the cell's. The
 * cell `last` is the last one on the axis, and reaches on forever: what lies in the scene's padded box but outside the grid belongs
 * to it. A ray that is parallel to the axis is there from the start.
 */
typedef struct sk_axis {
    float origin;
    float speed;   /* |d|, 0 if parallel */
    float inverse; /* 1 / |d|, huge if parallel */
    sk_i32 index, last;
    sk_i32 flip;   /* -1 for rays that go up: ~i goes down; else 0 */
} sk_axis;

/** `inverse` is 1 / working_direction. */
SK_FUNCTION sk_axis sk_make_axis(SetkaGridHeader grid, float origin, float direction, float working_direction,
                                 float inverse, float start, sk_u32 dim) {
    sk_axis r;
    const int parallel = working_direction == 0.0f, up = direction >= 0.0f;
    r.speed = parallel ? 0.0f : sk_abs(direction);
    r.inverse = parallel ? SK_PARALLEL_INVERSE : sk_abs(inverse) * grid.cell_size;
    r.flip = up ? -1 : 0;
    r.origin = up ? -origin : origin;
    r.index = (sk_i32)sk_cell(origin + direction * start, dim) ^ r.flip;
    r.last = parallel ? r.index : up ? ~(sk_i32)(dim - 1u) : 0;
    return r;
}

/** The number of the cell on its axis, in the grid's order. */
SK_FUNCTION sk_u32 sk_cell_index(sk_axis a) { return (sk_u32)(a.index ^ a.flip); }

/**
 * The index at the far face of a cube around the ray's cell: 0 is the cell itself, 1 the aligned 2 x 2 x 2 cells, 4 k - 1 its block and those
 * less than k blocks away, as sk_block.clearance has it.
 */
SK_FUNCTION sk_i32 sk_low_of(sk_axis a, sk_i32 cube) { return (a.index & ~(cube & 3)) - (cube & ~3); }

/** The way in cells to the face through which the ray leaves the cube, from the origin on and so without accumulated error. */
SK_FUNCTION float sk_exit_of(sk_axis a, sk_i32 cube) {
    const sk_i32 low = sk_low_of(a, cube);
    return low <= a.last ? SK_NEVER : a.origin - (float)low;
}

SK_FUNCTION float sk_exit(sk_axis a) { return sk_exit_of(a, 0); }

/** The paper's S: 1 for negative numbers, else 0. */
SK_FUNCTION sk_i32 sk_negative(float f) { return (sk_i32)(f < 0.0f); }

/** The working interval that the user's tmin and tmax leave, widened by what rounding may take. */
SK_FUNCTION sk_span sk_limit(sk_working_ray ray) {
    sk_span r;
    const float to_w = sk_inverse_power(ray.scale), pre = sk_inverse_power(ray.pre);
    const float a = (ray.tmin * to_w) * pre, b = (ray.tmax * to_w) * pre;
    /* Where t is subnormal its rounding is absolute; in working parameters that may be much. 2^-149 would be enough, but products with
     * subnormal numbers are slow on some processors. */
    const float step = 0x1p-100f * pre, coarse = step + step * to_w;
    const float start = (a - ray.shift) - ((sk_abs(a) + sk_abs(ray.shift)) * 0x1p-20f + coarse);
    const float end = (b - ray.shift) + ((sk_abs(b) + sk_abs(ray.shift)) * 0x1p-20f + coarse);
    /* NaN from infinite limits compares false and leaves the box's interval. */
    r.w0 = start > ray.w0 ? start : ray.w0;
    r.w1 = end < ray.w1 ? end : ray.w1;
    r.meets = ray.valid && r.w0 <= r.w1;
    return r;
}

/** Where a walk is. */
typedef struct sk_place {
    sk_axis x, y, z;
    int walking;
} sk_place;

SK_FUNCTION sk_place sk_enter(SetkaGridHeader grid, sk_working_ray ray, sk_span span) {
    const sk_vec3 o = sk_to_cells(grid, ray.o), d = sk_scale(ray.d, grid.inverse_cell_size);
    sk_place r;
    r.x = sk_make_axis(grid, o.x, d.x, ray.d.x, ray.inverse.x, span.w0, grid.dims[0]);
    r.y = sk_make_axis(grid, o.y, d.y, ray.d.y, ray.inverse.y, span.w0, grid.dims[1]);
    r.z = sk_make_axis(grid, o.z, d.z, ray.d.z, ray.inverse.z, span.w0, grid.dims[2]);
    r.walking = span.meets;
    return r;
}

/**
 * The index on an axis at which the ray is at w, when it leaves a cube through a face of another axis: in the cube, and never behind the
 * index that it has, whatever rounding says.
 */
SK_FUNCTION sk_i32 sk_land(sk_axis a, sk_i32 cube, float w) {
    const sk_i32 low = sk_low_of(a, cube), end = low > a.last ? low : a.last;
    const float at = a.origin - w * a.speed;
    return !(at < (float)a.index) ? a.index : at > (float)end ? (sk_i32)sk_floor(at) : end;
}

/** Leaves the cube around the ray's cell, unless nothing of interest is beyond it. */
SK_FUNCTION sk_place sk_leave(sk_place at, sk_i32 cube, float last) {
    const float wx = sk_exit_of(at.x, cube) * at.x.inverse;
    const float wy = sk_exit_of(at.y, cube) * at.y.inverse;
    const float wz = sk_exit_of(at.z, cube) * at.z.inverse;
    const int through_x = wx <= wy && wx <= wz, through_y = !through_x && wy <= wz;
    const float w = through_x ? wx : through_y ? wy : wz;
    sk_place r = at;
    if (last <= w) {
        r.walking = 0;
    } else if (cube == 0) {
        r.x.index -= through_x;
        r.y.index -= through_y;
        r.z.index -= !through_x && !through_y;
    } else {
        r.x.index = through_x ? sk_low_of(at.x, cube) - 1 : sk_land(at.x, cube, w);
        r.y.index = through_y ? sk_low_of(at.y, cube) - 1 : sk_land(at.y, cube, w);
        r.z.index = through_x || through_y ? sk_land(at.z, cube, w) : sk_low_of(at.z, cube) - 1;
    }
    return r;
}

/** A walk that looks for lists. */
typedef struct sk_search {
    sk_place at;
    sk_i32 cube;       /* to leave next; SK_ENTERED: the ray has only just come in */
    sk_cell_list list; /* of the cell that the ray is in */
} sk_search;

#define SK_ENTERED (-1)

/** Goes on to the next place. The list is empty there unless it is a cell that has one. */
SK_FUNCTION sk_search sk_move_on(SetkaGridHeader grid, sk_grid_tables tables, sk_search search, float last) {
    sk_search r = search;
    r.list.offset = 0u;
    r.list.count = 0u;
    if (search.cube != SK_ENTERED) r.at = sk_leave(search.at, search.cube, last);
    if (r.at.walking) {
        const sk_u32 x = sk_cell_index(r.at.x), y = sk_cell_index(r.at.y), z = sk_cell_index(r.at.z);
        const sk_dims blocks = sk_block_dims(sk_cell_dims(grid));
        const sk_block block = tables.blocks[sk_block_of(blocks, x, y, z)];
        if ((block.mask_low | block.mask_high) == 0u) {
            r.cube = (sk_i32)block.clearance;
        } else {
            const sk_u32 bit = sk_bit_in_block(x, y, z);
            r.cube = sk_has_one_of_eight(block, bit) ? 0 : 1;
            if (sk_has_bit(block, bit)) r.list = sk_find_list(tables, block, bit);
        }
    }
    return r;
}

#if SK_TEAM > 1
#define SK_SHARED SK_LOCAL
#define SK_SHARED_STORAGE SK_LOCAL_STORAGE
#define SK_TEAM_BARRIER() SK_BARRIER()
#define sk_team_add(target, value) sk_atomic_add(target, value)
#define sk_team_or(target, value) sk_atomic_or(target, value)
#define sk_team_min(target, value) sk_atomic_min(target, value)
#define sk_team_max(target, value) sk_atomic_max(target, value)
#define sk_team_exchange(target, value) sk_atomic_exchange(target, value)
#else
#define SK_SHARED
#define SK_SHARED_STORAGE
#define SK_TEAM_BARRIER() ((void)0)
#define sk_team_add(target, value) ((*(target) += (value)) - (value))
#define sk_team_or(target, value) (*(target) |= (value))
#endif

/** The most triangles of a list that are tested in one round: one bit each. */
#define SK_ROUND 32u
/** Rows of SK_TEAM pairs in which a part can begin: all that there are, or the first of a team of one. */
#define SK_FIRST_ROWS (SK_ROUND * (SK_TEAM - 1u) / SK_TEAM + 1u)
/** Added to a round's total by who walks on without a list, and by who has one, besides its triangles. */
#define SK_WITHOUT_LIST (1u << 24)
#define SK_WITH_LIST (1u << 16)
#define SK_PAIRS_OF(total) ((total) & 0xffffu)
#define SK_LISTS_OF(total) ((total) >> 16 & 0xffu)

/** So many members offered something to the round: as many walk. */
SK_FUNCTION sk_u32 sk_walkers_of(sk_u32 total) { return SK_LISTS_OF(total) + (total >> 24); }

/** A part of a list in the round's row of pairs (ray, triangle): pair p is triangle references[shift + p]. */
typedef struct SK_ALIGNED(8) sk_part {
    sk_u32 shift;
    sk_u32 first_and_owner; /* its first pair and, in the lowest 6 bits, the member whose ray it is */
} sk_part;

/** A round's row of pairs. Totals and starts are there twice, for this round and for the next. */
typedef struct sk_round {
    sk_part parts[SK_TEAM];
    sk_u32 starts[2][SK_ROUND]; /* bit m: a part begins with pair m of this row */
    sk_u32 totals[2];
} sk_round;

/**
 * What the members of a team share: SK_TEAM work-items that run in step. Each walks with a ray of its own, but the triangles of
 * all their lists are tested by all of them, one pair of ray and triangle each, since lists differ in length and most members would wait
 * for the one with the longest.
 */
typedef struct sk_team {
    sk_round round;
    sk_viewpoint views[SK_TEAM];
    sk_u32 candidates[SK_TEAM]; /* bit k: the member's ray may hit triangle k of its part */
} sk_team;

/** Before the first round; behind this a barrier is needed. */
SK_FUNCTION void sk_clear_rounds(SK_SHARED sk_round* round, sk_u32 member) {
    for (sk_u32 row = member; row < SK_ROUND; row += SK_TEAM) {
        round->starts[0][row] = 0u;
        round->starts[1][row] = 0u;
    }
    if (member == 0u) {
        round->totals[0] = 0u;
        round->totals[1] = 0u;
    }
}

/** Makes room for the next round, behind the barrier that ends the offers to this one. */
SK_FUNCTION void sk_clear_next_round(SK_SHARED sk_round* round, sk_u32 phase, sk_u32 member) {
    if (member == 0u) round->totals[phase ^ 1u] = 0u;
    for (sk_u32 row = member; row < SK_FIRST_ROWS; row += SK_TEAM) round->starts[phase ^ 1u][row] = 0u;
}

/** Puts `count` triangles of a list into the round's row, or says only that the member walks on. */
SK_FUNCTION void sk_offer(SK_SHARED sk_round* round, sk_u32 phase, sk_u32 member, sk_u32 offset, sk_u32 count) {
    const sk_u32 before = sk_team_add(&round->totals[phase], count == 0u ? SK_WITHOUT_LIST : SK_WITH_LIST + count);
    if (count != 0u) {
        const sk_u32 part = SK_LISTS_OF(before), first = SK_PAIRS_OF(before);
        sk_team_or(&round->starts[phase][first / SK_TEAM], 1u << first % SK_TEAM);
        round->parts[part].shift = offset - first;
        round->parts[part].first_and_owner = first << 6 | member;
    }
}

/** A pair of the round: whose ray it is, its triangle, and the bit of that in the owner's part. */
typedef struct sk_ray_and_triangle {
    sk_u32 owner, number, bit;
} sk_ray_and_triangle;

/** Pair p, which is one of part `index`. */
SK_FUNCTION sk_ray_and_triangle sk_find_pair(SK_SHARED sk_round* round, sk_grid_tables tables, sk_u32 p, sk_u32 index) {
    const sk_part part = round->parts[index];
    sk_ray_and_triangle r;
    r.owner = part.first_and_owner & 63u;
    r.number = tables.references[part.shift + p];
    r.bit = 1u << (p - (part.first_and_owner >> 6));
    return r;
}

SK_FUNCTION void sk_test_pair(SK_SHARED sk_team* team, sk_grid_tables tables, sk_ray_and_triangle pair) {
    if (sk_may_pass(sk_view_triangle(team->views[pair.owner], tables.triangles, pair.number * 9u, 1u)))
        sk_team_or(&team->candidates[pair.owner], pair.bit);
}

/**
 * Tests pair `member` of each row of the round's `count` pairs. The parts that have begun say which one a pair is in. The next
 * row's pair is looked up before this row's is tested, so that one waits for memory while the other calculates.
 */
SK_FUNCTION void sk_test_pairs(SK_SHARED sk_team* team, sk_u32 phase, sk_u32 member, sk_u32 count, sk_grid_tables tables) {
    const sk_u32 upto = 0xffffffffu >> (31u - member); /* this member's bit and those before */
    sk_u32 row = 0u, starts = team->round.starts[phase][0], begun = 0u; /* in the rows before */
    if (member < count) {
        sk_ray_and_triangle next = sk_find_pair(&team->round, tables, member, sk_popcount(starts & upto) - 1u);
        for (sk_u32 p = member; p < count; p += SK_TEAM) {
            const sk_ray_and_triangle pair = next;
            if (p + SK_TEAM < count) {
                begun += sk_popcount(starts);
                row += 1u;
                starts = team->round.starts[phase][row];
                next = sk_find_pair(&team->round, tables, p + SK_TEAM, begun + sk_popcount(starts & upto) - 1u);
            }
            sk_test_pair(team, tables, pair);
        }
    }
}

/** How far a member's ray has come, and what it has hit. */
typedef struct sk_walker {
    sk_search search;
    float last; /* nothing beyond this parameter is of interest */
    sk_walk walk;
} sk_walker;

/** Before the first step. */
SK_FUNCTION sk_walker sk_set_out(SetkaGridHeader grid, sk_working_ray ray) {
    const sk_span span = sk_limit(ray);
    sk_walker r;
    r.search.at = sk_enter(grid, ray, span);
    r.search.cube = SK_ENTERED;
    r.search.list.offset = 0u;
    r.search.list.count = 0u;
    r.last = span.w1;
    r.walk.best = sk_no_hit();
    r.walk.cost.steps = 0u;
    r.walk.cost.tests = 0u;
    return r;
}

/**
 * One round of a team: each member walks on to its next list, and all test what was found, past the triangle `skip` of each. `any`, a
 * compile-time choice of the entry, ends a walk at the first hit. All members have to come here; those without a ray do not walk. Behind it is the total
 * of the offers; a walk ends in the end, as each turn at least one index moves towards its last value, where its exit is out of reach, and none moves back.
 */
SK_FUNCTION sk_u32 sk_walk_round(SK_SHARED sk_team* team, sk_u32 phase, sk_u32 member, SetkaGridHeader grid, sk_trace_params params,
                                 sk_working_ray ray, sk_grid_tables tables, sk_u32 skip, sk_walker* walker, const int any) {
    sk_search search = walker->search;
    sk_best best = walker->walk.best;
    if (search.list.count == 0u) {
        for (sk_u32 turn = 0u; turn < SK_TURNS && search.at.walking && search.list.count == 0u; ++turn) {
            search = sk_move_on(grid, tables, search, walker->last);
            walker->walk.cost.steps += (sk_u32)search.at.walking;
        }
        walker->walk.cost.tests += search.list.count;
    }
    const sk_u32 count = sk_min_u32(search.list.count, SK_ROUND);
    if (search.at.walking) sk_offer(&team->round, phase, member, search.list.offset, count);
    team->candidates[member] = 0u;
    SK_TEAM_BARRIER();
    const sk_u32 total = team->round.totals[phase];
    sk_clear_next_round(&team->round, phase, member);
    sk_test_pairs(team, phase, member, SK_PAIRS_OF(total), tables);
    SK_TEAM_BARRIER();
    /* The accurate test is long and few triangles come to it: each member does its own, the first of all of them together. */
    for (sk_u32 candidates = team->candidates[member]; candidates != 0u; candidates &= candidates - 1u) {
        const sk_u32 k = sk_popcount((candidates - 1u) & ~candidates);
        best = sk_test_candidate(tables, params, ray, tables.references[search.list.offset + k], skip, best);
    }
    search.list.offset += count;
    search.list.count -= count;
    if (best.triangle != SETKA_NO_HIT) {
        walker->last = sk_min(best.w, walker->last);
        if (any) {
            search.at.walking = 0;
            search.list.count = 0u;
        }
    }
    walker->search = search;
    walker->walk.best = best;
    return total;
}

/** Walks the grid as member `member` of a team. All members have to come here; those without a ray say so in ray.valid. */
SK_FUNCTION sk_walk sk_walk_grid(SK_SHARED sk_team* team, sk_u32 member, SetkaGridHeader grid, sk_trace_params params,
                                 sk_working_ray ray, sk_grid_tables tables, sk_u32 skip, const int any) {
    sk_walker walker = sk_set_out(grid, ray);
    sk_u32 phase = 0u, total;
    team->views[member] = sk_viewpoint_of(ray);
    sk_clear_rounds(&team->round, member);
    SK_TEAM_BARRIER();
    do {
        total = sk_walk_round(team, phase, member, grid, params, ray, tables, skip, &walker, any);
        phase ^= 1u;
    } while (total != 0u);
    return walker.walk;
}

/** The same from cell to cell, by the paper's rule. */
SK_FUNCTION sk_walk sk_walk_cells(SetkaGridHeader grid, sk_trace_params params, sk_working_ray ray,
                                  sk_grid_tables tables, sk_u32 skip, const int any) {
    const sk_span span = sk_limit(ray);
    sk_place at = sk_enter(grid, ray, span);
    sk_axis x = at.x, y = at.y, z = at.z;
    int walking = at.walking;
    sk_walk r;
    r.best = sk_no_hit();
    r.cost.steps = 0u;
    r.cost.tests = 0u;
    while (walking) {
        const sk_u32 cx = sk_cell_index(x), cy = sk_cell_index(y), cz = sk_cell_index(z);
        const sk_block block = sk_block_at(grid, tables, cx, cy, cz);
        const sk_u32 bit = sk_bit_in_block(cx, cy, cz);
        r.cost.steps += 1u;
        if (sk_has_bit(block, bit)) {
            const sk_cell_list list = sk_find_list(tables, block, bit);
            r.best = sk_test_cell(tables, params, ray, list, skip, r.best);
            r.cost.tests += list.count;
        }
        const float ex = sk_exit(x), ey = sk_exit(y), ez = sk_exit(z);
        const int found = r.best.triangle != SETKA_NO_HIT;
        const float last = found ? sk_min(r.best.w, span.w1) : span.w1;
        const float xy = x.speed * ey - y.speed * ex;
        const float xz = x.speed * ez - z.speed * ex;
        const float yz = y.speed * ez - z.speed * ey;
        if (last * x.speed <= ex && last * y.speed <= ey && last * z.speed <= ez) {
            walking = 0;
        } else {
            x.index -= (1 - sk_negative(xy)) * (1 - sk_negative(xz));
            y.index -= (1 - sk_negative(-xy)) * (1 - sk_negative(yz));
            z.index -= (1 - sk_negative(-xz)) * (1 - sk_negative(-yz));
        }
        if (any && found) walking = 0;
    }
    return r;
}

#endif
