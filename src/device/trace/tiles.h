/* SPDX-License-Identifier: MIT */
/**
 * Which rays of a picture are traced side by side? They come row by row, but eight in a tile of 4 x 2, sixteen in one of 4 x 4, or a team's 32 in
 * one of 8 x 4, meet more of the same cells than as many in a line do. So places, which lanes and members take in order, go through tiles.
 */
#ifndef SETKA_DEVICE_TRACE_TILES_H
#define SETKA_DEVICE_TRACE_TILES_H

#if SK_WIDTH > 1
#include "device/lanes.h"
#else
#include "device/math.h"
#endif
#include "device/trace/params.h"

/* A tile is what is side by side: the lanes of a vector, or the members of a team. A block of SK_BLOCK_ROWS rows has tiles side by side and one below the
 * other: those of a CPU's work-item. */
#if SK_WIDTH > 1
#define SK_TILE_RAYS SK_WIDTH
#define SK_TILE_COLUMNS 4u
#define SK_ITEM_RAYS (SK_WIDTH * SK_FLIGHTS) /* of a work-item, in pictures and lists */
#define SK_BLOCK_RAYS SK_ITEM_RAYS
#else
#define SK_TILE_RAYS 32u
#define SK_TILE_COLUMNS 8u
#define SK_BLOCK_RAYS SK_BLOCK_RAYS_OF_TEAMS
#endif
#define SK_TILE_ROWS (SK_TILE_RAYS / SK_TILE_COLUMNS)
#define SK_BLOCK_COLUMNS (SK_BLOCK_RAYS / SK_BLOCK_ROWS)
#define SK_TILES_ACROSS (SK_BLOCK_COLUMNS / SK_TILE_COLUMNS)

/** How many of the places, from the first on, are in blocks. */
SK_FUNCTION sk_u32 sk_rays_in_blocks(sk_trace_params params) { return params.blocks_up * params.blocks_across * SK_BLOCK_RAYS; }

/**
 * Which row of blocks is traced as number `turn`. Teams begin in the middle of a picture and go up and down by turns: rays that take longest are there more
 * often than at its edges, and what begins last should not be what ends last.
 */
SK_FUNCTION sk_u32 sk_row_of_blocks(sk_u32 turn, sk_u32 rows) {
#if SK_WIDTH > 1
    (void)rows;
    return turn;
#else
    return (turn & 1u) != 0u ? rows / 2u - (turn + 1u) / 2u : rows / 2u + turn / 2u;
#endif
}

/**
 * The ray at a place: a permutation of [0, tiled_rays), which are bands of SK_BLOCK_ROWS whole rows, and the place itself behind them. First come the blocks, tile
 * by tile, then row by row the columns that fill no block.
 */
SK_FUNCTION sk_u32 sk_ray_at(sk_trace_params params, sk_u32 place) {
    const sk_u32 width = params.row_length, across = params.blocks_across, in_blocks = sk_rays_in_blocks(params);
    sk_u32 x, y;
    if (place >= params.tiled_rays) return place;
    if (place < in_blocks) {
        const sk_u32 block = place / SK_BLOCK_RAYS, tile = place % SK_BLOCK_RAYS / SK_TILE_RAYS, ray = place % SK_TILE_RAYS;
        const sk_u32 up = block / across;
        x = (block - up * across) * SK_BLOCK_COLUMNS + tile % SK_TILES_ACROSS * SK_TILE_COLUMNS + ray % SK_TILE_COLUMNS;
        y = sk_row_of_blocks(up, params.blocks_up) * SK_BLOCK_ROWS + tile / SK_TILES_ACROSS * SK_TILE_ROWS + ray / SK_TILE_COLUMNS;
    } else {
        const sk_u32 columns = across * SK_BLOCK_COLUMNS;
        x = columns + (place - in_blocks) % (width - columns);
        y = (place - in_blocks) / (width - columns);
    }
    return y * width + x;
}

#if SK_WIDTH > 1
/** Those at SK_WIDTH places from `first` on, a multiple of SK_WIDTH; up to ray n - 1, which takes the place of those behind it. */
SK_FUNCTION sk_iN sk_rays_at(sk_trace_params params, sk_u32 first, sk_u32 n) {
#define SK_NUMBER(k) (sk_i32) sk_min_u32(first + (k), n - 1u)
#define SK_NUMBER_IN_TILE(k) (sk_i32)((k) % SK_TILE_COLUMNS + (k) / SK_TILE_COLUMNS * params.row_length)
#define SK_NUMBER_IN_REST(k) (sk_i32) sk_ray_at(params, sk_min_u32(first + (k), n - 1u))
    if (first >= params.tiled_rays) return SK_INTS(SK_NUMBER);
    if (first < sk_rays_in_blocks(params))
        return (sk_i32)sk_ray_at(params, first) + SK_INTS(SK_NUMBER_IN_TILE);
    return SK_INTS(SK_NUMBER_IN_REST);
#undef SK_NUMBER_IN_REST
#undef SK_NUMBER_IN_TILE
#undef SK_NUMBER
}

#endif

#endif
