/* SPDX-License-Identifier: MIT */
/**
 * Which rays of a picture are traced side by side? They come row by row, but eight in a tile of 4 x 2, or sixteen in one of 4 x 4, meet more of the
 * same cells than as many in a line do. So places, which lanes take in order, go through tiles.
 */
#ifndef SETKA_DEVICE_TRACE_TILES_H
#define SETKA_DEVICE_TRACE_TILES_H

#include "device/lanes.h"
#include "device/trace/params.h"

/** Columns of the rays of a work-item; it takes SK_ITEM_ROWS rows of them, and a lane's tile is one of its own. */
#define SK_ITEM_COLUMNS (SK_WIDTH * SK_FLIGHTS / SK_ITEM_ROWS)
#define SK_TILES_ACROSS (SK_ITEM_COLUMNS / SK_TILE_COLUMNS)
#define SK_TILE_ROWS (SK_WIDTH / SK_TILE_COLUMNS)

/**
 * The ray at a place: a permutation of [0, tiled_rays), which are bands of SK_ITEM_ROWS whole rows, and the place itself behind them. First come the tiles, those
 * of a work-item one after the other, then row by row the columns that fill no work-item.
 */
SK_FUNCTION sk_u32 sk_ray_at(sk_trace_params params, sk_u32 place) {
    if (place >= params.tiled_rays) return place;
    const sk_u32 width = params.row_length, across = width / SK_ITEM_COLUMNS, rest = width % SK_ITEM_COLUMNS;
    const sk_u32 in_tiles = params.tiled_rays / width * (width - rest);
    sk_u32 x, y;
    if (place < in_tiles) {
        const sk_u32 item = place / (SK_WIDTH * SK_FLIGHTS), tile = place / SK_WIDTH % SK_FLIGHTS, lane = place % SK_WIDTH;
        x = item % across * SK_ITEM_COLUMNS + tile % SK_TILES_ACROSS * SK_TILE_COLUMNS + lane % SK_TILE_COLUMNS;
        y = item / across * SK_ITEM_ROWS + tile / SK_TILES_ACROSS * SK_TILE_ROWS + lane / SK_TILE_COLUMNS;
    } else {
        x = width - rest + (place - in_tiles) % rest;
        y = (place - in_tiles) / rest;
    }
    return y * width + x;
}

/** Those at SK_WIDTH places from `first` on, a multiple of SK_WIDTH; up to ray n - 1, which takes the place of those behind it. */
SK_FUNCTION sk_iN sk_rays_at(sk_trace_params params, sk_u32 first, sk_u32 n) {
#define SK_NUMBER(k) (sk_i32) sk_min_u32(first + (k), n - 1u)
#define SK_NUMBER_IN_TILE(k) (sk_i32)((k) % SK_TILE_COLUMNS + (k) / SK_TILE_COLUMNS * params.row_length)
#define SK_NUMBER_IN_REST(k) (sk_i32) sk_ray_at(params, sk_min_u32(first + (k), n - 1u))
    if (first >= params.tiled_rays) return SK_INTS(SK_NUMBER);
    if (first < params.tiled_rays / params.row_length * (params.row_length / SK_ITEM_COLUMNS * SK_ITEM_COLUMNS))
        return (sk_i32)sk_ray_at(params, first) + SK_INTS(SK_NUMBER_IN_TILE);
    return SK_INTS(SK_NUMBER_IN_REST);
#undef SK_NUMBER_IN_REST
#undef SK_NUMBER_IN_TILE
#undef SK_NUMBER
}

#endif
