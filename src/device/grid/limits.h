/* SPDX-License-Identifier: MIT */
/** Which numbers do the kernels of a build and the host agree on? Sizes beyond which work is done otherwise, and words of `totals`. */
#ifndef SETKA_DEVICE_GRID_LIMITS_H
#define SETKA_DEVICE_GRID_LIMITS_H

/** Cells of a block, empty ones and ones outside the grid included. */
#define SK_BLOCK_CELLS 64u

/** Rows of at least so many columns are added up while they are counted, in units of that many columns. */
#define SK_LONG_ROW 16u
/**
 * So many units, 2^31 columns with a cell each, are one cell more than tables hold: then nothing more is
 * counted, since the build is refused.
 */
#define SK_MOST_LONG_ROWS 0x8000000u

/** Lists longer than this are copied by one work-item a reference, others by one a list. */
#define SK_LONG_LIST 1024u

/** What a build's kernels tell the host, in one table of SK_TOTALS words. */
#define SK_TOTAL_CELLS 0u      /* non-empty cells */
#define SK_TOTAL_PAIRS_LOW 1u
#define SK_TOTAL_PAIRS_HIGH 2u
#define SK_TOTAL_LONGEST 3u    /* the complement of the longest list's length, from ~0 on */
#define SK_TOTALS 4u

#endif
