/* SPDX-License-Identifier: MIT */
/** When is a grid so large that it is not even counted to the end? Shared by kernels and host. */
#ifndef SETKA_DEVICE_GRID_LIMITS_H
#define SETKA_DEVICE_GRID_LIMITS_H

/** Rows of at least so many columns are added up while they are counted, in units of that many columns. */
#define SK_LONG_ROW 16u
/**
 * So many units, 2^31 columns with a cell each, are one cell more than tables hold: then nothing more is
 * counted, since the build is refused.
 */
#define SK_MOST_LONG_ROWS 0x8000000u

#endif
