/* SPDX-License-Identifier: MIT */
/** What does a trace kernel need to know of the scene? The box that rays are clipped to, and counts. Shared with the host. */
#ifndef SETKA_DEVICE_TRACE_PARAMS_H
#define SETKA_DEVICE_TRACE_PARAMS_H

#include "setka/layout.h"

typedef struct sk_trace_params {
    float lower[3];
    float size[3];            /* upper - lower */
    float extent;             /* the largest size */
    float pad;                /* extent * 2^-16 */
    float unit;               /* a power of two: extent * unit is in [2^20, 2^21), if extent is in [2^-100, 2^100] */
    setka_u32 mask;           /* of the query */
    setka_u32 filters;        /* 0: the mask lets every instance through */
    setka_u32 skips;          /* not 0: each ray has a primitive that it passes through */
    setka_u32 instance_count;
    setka_u32 triangle_count;
    setka_u32 row_length;     /* rays of a row, if tiled_rays is not 0 */
    setka_u32 tiled_rays;     /* so many rays from the first on are traced tile by tile: whole rows of blocks of tiles, */
    setka_u32 blocks_across, blocks_up; /* as many of them a row, and as many rows */
} sk_trace_params;

/** How many vectors of SK_WIDTH rays a work-item of a CPU traces, if SK_WIDTH is more than 1 (grid/walk_lanes.h). */
#define SK_FLIGHTS 8u

/** What the teams of a launch count together that share a list, in words that the launch finds at 0 and leaves so (grid/trace.h). */
#define SK_RAYS_TAKEN 0 /* besides those that each team has from the start */
#define SK_TEAMS_DONE 1
#define SK_LAUNCH_COUNTS 2

/** Rows of a picture that are traced block by block (tiles.h). */
#define SK_BLOCK_ROWS 8u
/** The rays of a block where teams trace them. On CPUs it has those of a work-item. */
#define SK_BLOCK_RAYS_OF_TEAMS 128u

#endif
