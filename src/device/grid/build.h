/* SPDX-License-Identifier: MIT */
/**
 * How do vertices become the grid's tables? One function a stage of Maltsev & Mikhaylyuk (2012, section 2), each the body of one
 * kernel. Sorting pairs spreads work over rows of cells, not over triangles: a triangle as large as the scene has many rows, and none of
 * them is longer than the grid is wide. Without sorting (scatter.h) the rows of large triangles alone are spread.
 */
#ifndef SETKA_DEVICE_GRID_BUILD_H
#define SETKA_DEVICE_GRID_BUILD_H

#include "device/grid/cells.h"
#include "device/grid/limits.h"
#include "device/grid/resolution.h"
#include "device/math.h"
#include "device/scan.h"
#if SK_WIDTH > 1
#include "device/lanes.h"
#endif

/** Words of a box: two corners. */
#define SK_BOUNDS_VALUES 6u

/** The box of what a work-item has seen. */
typedef struct sk_extremes {
    sk_vec3 low, high;
} sk_extremes;

/** Stage 1: world vertices of triangle i. first_bad becomes the complement of the lowest triangle that is not finite. */
SK_FUNCTION sk_extremes sk_transform_triangle(sk_u32 i, sk_u32 instance_count, SK_GLOBAL const float* positions,
                                              SK_GLOBAL const sk_u32* indices, SK_GLOBAL const SetkaInstance* instances,
                                              SK_GLOBAL const sk_u32* instance_starts, SK_GLOBAL float* triangles,
                                              SK_GLOBAL sk_u32* first_bad, sk_extremes seen) {
    const sk_u32 number = sk_find_segment(instance_starts, instance_count, i);
    SK_GLOBAL const SetkaInstance* instance = instances + number;
    SK_GLOBAL const sk_u32* index =
        indices + (size_t)(instance->first_index + (i - instance->first_triangle)) * 3u;
    SK_GLOBAL float* triangle = triangles + (size_t)i * 9u;
    int finite = 1;
    for (sk_u32 k = 0u; k < 3u; ++k) {
        const sk_vec3 p = sk_load3(positions + (size_t)(instance->first_vertex + index[k]) * 3u);
        const sk_vec3 q = sk_transform_point(instance->matrix, p);
        finite = finite && sk_is_finite(q.x) && sk_is_finite(q.y) && sk_is_finite(q.z);
        triangle[3u * k] = q.x;
        triangle[3u * k + 1u] = q.y;
        triangle[3u * k + 2u] = q.z;
        seen.low = sk_make3(sk_min(seen.low.x, q.x), sk_min(seen.low.y, q.y), sk_min(seen.low.z, q.z));
        seen.high = sk_make3(sk_max(seen.high.x, q.x), sk_max(seen.high.y, q.y), sk_max(seen.high.z, q.z));
    }
    if (!finite) sk_atomic_max(first_bad, ~i);
    return seen;
}

#if SK_WIDTH > 1

/** What was seen of one vertex of each triangle; NaN in `odd` where some were not finite, and from then on. */
typedef struct sk_extremes4 {
    sk_f4 low, high, odd;
} sk_extremes4;

SK_FUNCTION sk_extremes4 sk_see4(sk_extremes4 seen, sk_f4 q) {
    sk_extremes4 r;
    r.low = q < seen.low ? q : seen.low;
    r.high = seen.high < q ? q : seen.high;
    r.odd = seen.odd + (q - q);
    return r;
}
SK_FUNCTION sk_extremes4 sk_both4(sk_extremes4 a, sk_extremes4 b) {
    sk_extremes4 r;
    r.low = b.low < a.low ? b.low : a.low;
    r.high = a.high < b.high ? b.high : a.high;
    r.odd = a.odd + b.odd;
    return r;
}

/** The columns of a matrix, and whether it leaves every point where it is. */
typedef struct sk_columns4 {
    sk_f4 x, y, z, w;
    int is_identity;
} sk_columns4;
SK_FUNCTION sk_columns4 sk_columns_of(SK_GLOBAL const float* m) {
    const sk_f4 row_x = sk_load_f4(m), row_y = sk_load_f4(m + 4), row_z = sk_load_f4(m + 8);
    const sk_f4 columns01 = sk_shuffle(row_x, row_y, 0, 4, 1, 5), columns23 = sk_shuffle(row_x, row_y, 2, 6, 3, 7);
    sk_columns4 r;
    r.x = sk_shuffle(columns01, row_z, 0, 1, 4, 4);
    r.y = sk_shuffle(columns01, row_z, 2, 3, 5, 5);
    r.z = sk_shuffle(columns23, row_z, 0, 1, 6, 6);
    r.w = sk_shuffle(columns23, row_z, 2, 3, 7, 7);
    r.is_identity = 1;
    for (sk_u32 k = 0u; k < 12u; ++k) r.is_identity = r.is_identity && m[k] == (k % 5u == 0u ? 1.0f : 0.0f);
    return r;
}

/** sk_transform_point(), x, y and z side by side. By an identity, a compile-time choice, it adds nothing but zeros to what is finite, and leaves no -0. */
SK_FUNCTION sk_f4 sk_transform_point4(sk_columns4 by, SK_GLOBAL const float* p, const int is_identity) {
    const sk_f4 zero = sk_same_f4(0.0f);
    if (is_identity) return sk_load_f3(p) + zero;
    const sk_f4 sum = ((by.x * sk_same_f4(p[0]) + by.y * sk_same_f4(p[1])) + by.z * sk_same_f4(p[2])) + by.w;
    return sum == zero ? zero : sum;
}

/** The triangles between the one that is transformed and the one whose vertex is asked for. */
#define SK_TRIANGLES_AHEAD 32

/** What was seen of the first, second and third vertices, so that none waits for what is seen of another. */
typedef struct sk_seen_vertices {
    sk_extremes4 a, b, c;
} sk_seen_vertices;

/** Stage 1 of the triangles from `triangle` to `end`, whose vertices `index` names. */
SK_FUNCTION sk_seen_vertices sk_transform_vertices(sk_columns4 by, SK_GLOBAL const float* vertices, SK_GLOBAL const sk_u32* index, SK_GLOBAL float* triangle,
                                                   SK_GLOBAL const float* end, sk_seen_vertices seen, const int is_identity) {
    for (; triangle != end; triangle += 9, index += 3) {
        /* In grids of vertices the others were seen with a triangle before. */
        if (end - triangle > 9 * SK_TRIANGLES_AHEAD) sk_prefetch(vertices + (size_t)index[3 * SK_TRIANGLES_AHEAD + 2] * 3u);
        const sk_f4 p = sk_transform_point4(by, vertices + (size_t)index[0] * 3u, is_identity);
        const sk_f4 q = sk_transform_point4(by, vertices + (size_t)index[1] * 3u, is_identity);
        const sk_f4 r = sk_transform_point4(by, vertices + (size_t)index[2] * 3u, is_identity);
        sk_store_f4(p, triangle); /* the next vertex comes over the fourth */
        sk_store_f4(q, triangle + 3);
        triangle[6] = sk_lane(r, 0);
        triangle[7] = sk_lane(r, 1);
        triangle[8] = sk_lane(r, 2);
        seen.a = sk_see4(seen.a, p);
        seen.b = sk_see4(seen.b, q);
        seen.c = sk_see4(seen.c, r);
    }
    return seen;
}

/** Stage 1 of triangles first to end - 1, by a work-item alone. What is the same for all triangles of an instance is found once. */
SK_FUNCTION sk_extremes sk_transform_run(sk_u32 first, sk_u32 end, sk_u32 instance_count, SK_GLOBAL const float* positions,
                                         SK_GLOBAL const sk_u32* indices, SK_GLOBAL const SetkaInstance* instances,
                                         SK_GLOBAL const sk_u32* instance_starts, SK_GLOBAL float* triangles,
                                         SK_GLOBAL sk_u32* first_bad) {
    const float infinity = sk_bits_float(0x7f800000u);
    sk_seen_vertices all;
    sk_extremes seen;
    all.a.low = sk_same_f4(infinity);
    all.a.high = sk_same_f4(-infinity);
    all.a.odd = sk_same_f4(0.0f);
    all.b = all.c = all.a;
    for (sk_u32 i = first; i < end;) {
        SK_GLOBAL const SetkaInstance* instance = instances + sk_find_segment(instance_starts, instance_count, i);
        SK_GLOBAL const sk_u32* index = indices + (size_t)(instance->first_index + (i - instance->first_triangle)) * 3u;
        SK_GLOBAL const float* vertices = positions + (size_t)instance->first_vertex * 3u;
        const sk_columns4 by = sk_columns_of(instance->matrix);
        const sk_u32 stop = sk_min_u32(end, instance_starts[(instance - instances) + 1]);
        SK_GLOBAL float* triangle = triangles + (size_t)i * 9u;
        SK_GLOBAL const float* after = triangles + (size_t)stop * 9u;
        if (by.is_identity)
            all = sk_transform_vertices(by, vertices, index, triangle, after, all, 1);
        else
            all = sk_transform_vertices(by, vertices, index, triangle, after, all, 0);
        i = stop;
    }
    const sk_extremes4 a = sk_both4(all.a, sk_both4(all.b, all.c));
    if (!(sk_lane(a.odd, 0) == 0.0f && sk_lane(a.odd, 1) == 0.0f && sk_lane(a.odd, 2) == 0.0f)) {
        sk_u32 i = first, finite = 1u;
        while (i < end && finite != 0u) {
            for (sk_u32 k = 0u; k < 9u; ++k) finite &= (sk_u32)sk_is_finite(triangles[(size_t)i * 9u + k]);
            if (finite != 0u) ++i;
        }
        (void)sk_atomic_max(first_bad, ~i);
    }
    seen.low = sk_make3(sk_lane(a.low, 0), sk_lane(a.low, 1), sk_lane(a.low, 2));
    seen.high = sk_make3(sk_lane(a.high, 0), sk_lane(a.high, 1), sk_lane(a.high, 2));
    return seen;
}

#endif

/**
 * Stages 1 and 2: `elements` triangles a work-item, and the box of all, in the words of the report (limits.h): all are maxima, from 0 on.
 */
SK_FUNCTION void sk_grid_transform(SK_LOCAL sk_u32* scratch, sk_u32 n, sk_u32 elements, sk_u32 instance_count,
                                   SK_GLOBAL const float* positions, SK_GLOBAL const sk_u32* indices,
                                   SK_GLOBAL const SetkaInstance* instances, SK_GLOBAL const sk_u32* instance_starts,
                                   SK_GLOBAL float* triangles, SK_GLOBAL sk_u32* report) {
    const sk_u32 item = sk_local_id(), size = sk_local_size();
    const sk_u64 first = (sk_u64)sk_group_id() * size * elements + item;
    const float infinity = sk_bits_float(0x7f800000u);
    sk_extremes seen;
    seen.low = sk_make3(infinity, infinity, infinity);
    seen.high = sk_make3(-infinity, -infinity, -infinity);
    sk_u32 single = elements; /* so many one after the other */
#if SK_WIDTH > 1
    if (size == 1u && first < n) {
        seen = sk_transform_run((sk_u32)first, (sk_u32)(first + elements < n ? first + elements : n), instance_count, positions,
                                indices, instances, instance_starts, triangles, report + SK_REPORT_BAD);
        single = 0u;
    }
#endif
    for (sk_u32 k = 0u; k < single; ++k) {
        const sk_u64 i = first + (sk_u64)k * size;
        if (i < n)
            seen = sk_transform_triangle((sk_u32)i, instance_count, positions, indices, instances, instance_starts,
                                         triangles, report + SK_REPORT_BAD, seen);
    }
    scratch[item] = ~sk_ordered(seen.low.x);
    scratch[SK_MAX_GROUP + item] = ~sk_ordered(seen.low.y);
    scratch[2u * SK_MAX_GROUP + item] = ~sk_ordered(seen.low.z);
    scratch[3u * SK_MAX_GROUP + item] = sk_ordered(seen.high.x);
    scratch[4u * SK_MAX_GROUP + item] = sk_ordered(seen.high.y);
    scratch[5u * SK_MAX_GROUP + item] = sk_ordered(seen.high.z);
    for (sk_u32 others = size / 2u; others > 0u; others /= 2u) {
        SK_BARRIER();
        for (sk_u32 v = 0u; v < SK_BOUNDS_VALUES && item < others; ++v) {
            SK_LOCAL sk_u32* own = scratch + v * SK_MAX_GROUP + item;
            *own = sk_max_u32(*own, own[others]);
        }
    }
    SK_BARRIER();
    for (sk_u32 v = item; v < SK_BOUNDS_VALUES; v += size) 
        sk_atomic_max(report + SK_REPORT_LOWER + v, scratch[v * SK_MAX_GROUP]);
}

/** Stage 4, first half: rows of triangle i. */
SK_FUNCTION void sk_grid_rows(sk_u32 i, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                              SK_GLOBAL sk_u32* rows) {
    const sk_cell_triangle t = sk_load_cell_triangle(grid, triangles + (size_t)i * 9u);
    rows[i] = sk_last_row(grid, t) - sk_first_row(grid, t) + 1u;
}

/** row_triangles[r] = the triangle that row r belongs to. */
SK_FUNCTION void sk_grid_row_list(sk_u32 i, SK_GLOBAL const sk_u32* row_starts, SK_GLOBAL sk_u32* row_triangles) {
    const sk_u32 end = row_starts[i + 1u];
    for (sk_u32 r = row_starts[i]; r < end; ++r) row_triangles[r] = i;
}

/**
 * Stage 4, second half: cells in row r. `long_rows`, 0 at first, adds up the columns of long rows, at most one for each cell, so
 * that triangles that reach into far too many cells are not counted for hours. When the other work-items see it changes nothing
 * but which rows of a refused grid are counted.
 */
SK_FUNCTION void sk_grid_count(sk_u32 r, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                               SK_GLOBAL const sk_u32* row_triangles, SK_GLOBAL const sk_u32* row_starts,
                               SK_GLOBAL sk_u32* counts, SK_GLOBAL sk_u32* long_rows) {
    sk_u32 count = 0u;
    if (*(volatile SK_GLOBAL sk_u32*)long_rows < SK_MOST_LONG_ROWS) {
        const sk_u32 i = row_triangles[r];
        const sk_cell_triangle t = sk_load_cell_triangle(grid, triangles + (size_t)i * 9u);
        const sk_u32 j = sk_first_row(grid, t) + (r - row_starts[i]);
        sk_u32 units;
        count = sk_visit_row(grid, t, j, 0, 0u, i, (SK_GLOBAL sk_u32*)0, (SK_GLOBAL sk_u32*)0);
        units = sk_min_u32(count, t.dim_u) / SK_LONG_ROW;
        if (units != 0u) sk_atomic_add(long_rows, units);
    }
    counts[r] = count;
}

/** Stage 5: the pairs of row r. */
SK_FUNCTION void sk_grid_emit(sk_u32 r, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                              SK_GLOBAL const sk_u32* row_triangles, SK_GLOBAL const sk_u32* row_starts,
                              SK_GLOBAL const sk_u32* row_offsets, SK_GLOBAL sk_u32* cells,
                              SK_GLOBAL sk_u32* references) {
    const sk_u32 i = row_triangles[r];
    const sk_cell_triangle t = sk_load_cell_triangle(grid, triangles + (size_t)i * 9u);
    const sk_u32 j = sk_first_row(grid, t) + (r - row_starts[i]);
    sk_visit_row(grid, t, j, 1, row_offsets[r], i, cells, references);
}

/** Counts the pairs of row r in their cells: the plan has to say how many cells are not empty. */
SK_FUNCTION void sk_grid_mark(sk_u32 r, SetkaGridHeader grid, SK_GLOBAL const float* triangles,
                              SK_GLOBAL const sk_u32* row_triangles, SK_GLOBAL const sk_u32* row_starts,
                              SK_GLOBAL sk_u32* counters) {
    const sk_u32 i = row_triangles[r];
    const sk_cell_triangle t = sk_load_cell_triangle(grid, triangles + (size_t)i * 9u);
    sk_count_row(grid, t, sk_first_row(grid, t) + (r - row_starts[i]), counters);
}

/** Stage 7 by run boundaries, first of three: every cell is empty. */
SK_FUNCTION void sk_grid_cells_clear(sk_u32 c, SK_GLOBAL sk_i32* offsets, SK_GLOBAL sk_u32* counts) {
    offsets[c] = -1;
    counts[c] = 0u;
}

/** Second: the first pair of a run of equal cells writes where it starts, the last where it ends (into counts). */
SK_FUNCTION void sk_grid_cells_mark(sk_u32 p, sk_u32 n, SK_GLOBAL const sk_u32* cells, SK_GLOBAL sk_i32* offsets,
                                    SK_GLOBAL sk_u32* counts) {
    const sk_u32 cell = cells[p];
    if (p == 0u || cells[p - 1u] != cell) offsets[cell] = (sk_i32)p;
    if (p + 1u == n || cells[p + 1u] != cell) counts[cell] = p + 1u;
}

/** Third: ends become counts. */
SK_FUNCTION void sk_grid_cells_close(sk_u32 c, SK_GLOBAL const sk_i32* offsets, SK_GLOBAL sk_u32* counts) {
    if (offsets[c] >= 0) counts[c] -= (sk_u32)offsets[c];
}

/** Stage 7 as in the paper: cell c searches for its first pair and for the first pair of the next cell. */
SK_FUNCTION void sk_grid_cells_search(sk_u32 c, sk_u32 n, SK_GLOBAL const sk_u32* cells, SK_GLOBAL sk_i32* offsets,
                                      SK_GLOBAL sk_u32* counts) {
    const sk_u32 first = sk_lower_bound(cells, n, c);
    const sk_u32 count = sk_lower_bound(cells, n, c + 1u) - first;
    offsets[c] = count == 0u ? -1 : (sk_i32)first;
    counts[c] = count;
}

#endif
