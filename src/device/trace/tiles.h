/* SPDX-License-Identifier: MIT */
/**
 * Which rays of a picture are traced side by side? They come row by row, but eight in a tile of 4 x 2, or sixteen in one of 4 x 4, meet more of the
 * same cells than as many in a line do. So places, which lanes take in order, go through tiles.
 */
#ifndef SETKA_DEVICE_TRACE_TILES_H
#define SETKA_DEVICE_TRACE_TILES_H

#include "device/dialect.h"
#include "device/trace/params.h"

#define SK_TILE_ROWS (SK_WIDTH / SK_TILE_COLUMNS)

/**
 * The ray at a place: a permutation of [0, tiled_rays), which are bands of SK_TILE_ROWS whole rows, and the place itself behind them. Columns that
 * fill no tile come at the end of their band, row by row.
 */
SK_FUNCTION sk_u32 sk_ray_at(sk_trace_params params, sk_u32 place) {
    if (place >= params.tiled_rays) return place;
    const sk_u32 width = params.row_length, in_band = place % (width * SK_TILE_ROWS);
    const sk_u32 rest = width % SK_TILE_COLUMNS, in_tiles = (width - rest) * SK_TILE_ROWS;
    sk_u32 x, y;
    if (in_band < in_tiles) {
        x = in_band / SK_WIDTH * SK_TILE_COLUMNS + in_band % SK_TILE_COLUMNS;
        y = in_band % SK_WIDTH / SK_TILE_COLUMNS;
    } else {
        x = width - rest + (in_band - in_tiles) % rest;
        y = (in_band - in_tiles) / rest;
    }
    return place - in_band + y * width + x;
}

#endif
