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

/** Rows of large triangles beyond any that a build holds in memory: from here on they are not added up any more. */
#define SK_MOST_ROWS 0x40000000u

/** A triangle no longer than so many cells along each axis is one work-item's. */
#define SK_SMALL_BOX 8u

/** Lists that are too long for one work-item are sorted in pieces of so many numbers. */
#define SK_PIECE 64u

/** Lists longer than this are copied by one work-item a reference, others by one a list. */
#define SK_LONG_LIST 1024u

/** Bins (bins.h): cells along each axis and in all, and blocks. */
#define SK_BIN_SIDE 16u
#define SK_BIN_CELLS 4096u
#define SK_BIN_BLOCKS 64u
/** Counts of a block's cells that are kept from tallying to placing, a byte each: words, and the longest list that may have one. */
#define SK_KEPT_WORDS 16u
#define SK_KEPT_MOST 255u
/** Triangles that a pair in a bin can tell apart, in the bits that a cell's number in its bin leaves. */
#define SK_LONGEST_RUN 1048576u

/** So many triangles, 9 MB, are more than a core's own caches hold, so that it pays to ask ahead for what is made of them. */
#define SK_FAR_TRIANGLES 0x40000u

/**
 * What a build's kernels tell each other and the host, in one table of SK_REPORT words that are 0 at first: totals, what the transform found, and
 * the header of the grid in which is counted. Where cells have counters, these lie behind it (blocks.h).
 */
#define SK_TOTAL_CELLS 0u      /* non-empty cells */
#define SK_TOTAL_PAIRS_LOW 1u
#define SK_TOTAL_PAIRS_HIGH 2u
#define SK_TOTAL_LONGEST 3u    /* the longest list's length, if it is above SK_LONG_LIST or too long for one work-item to sort */
#define SK_TOTAL_ROWS 4u       /* of large triangles, of which no more are added from SK_MOST_ROWS on */
#define SK_TOTAL_LONG 5u       /* about so many times SK_LONG_ROW pairs large triangles have at least */
#define SK_TOTAL_FOUND 6u      /* the same, of those counted so far */
#define SK_TOTAL_PIECES 7u     /* of lists that are too long for one work-item */
#define SK_TOTAL_CUT 8u        /* pieces cut so far */
#define SK_TOTAL_TAKEN 4u      /* in builds with bins, which list no rows: what work-items have taken of runs and bins so far */
#define SK_TOTAL_KEPT 0u       /* there too, until blocks are added up: blocks whose counts there is room to keep, taken so far */
#define SK_TOTAL_BINNED_LOW 7u /* pairs in bins: in builds with these, which cut no list into pieces */
#define SK_TOTAL_BINNED_HIGH 8u
#define SK_TOTALS 9u           /* so many words are totals */
#define SK_REPORT_BAD 9u       /* the complement of the lowest triangle that is not finite, or 0 */
#define SK_REPORT_LOWER 10u    /* the complements of the bounds' lower corner, as integers of the same order: all are maxima */
#define SK_REPORT_UPPER 13u    /* the upper corner */
#define SK_REPORT_HEADER 16u   /* a SetkaGridHeader, or zeros */
#define SK_REPORT 32u

#endif
