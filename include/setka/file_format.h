/* SPDX-License-Identifier: MIT */
/**
 * What is in a file of a saved structure? The format, version 1, in C99, for programs that read such files without the
 * library.
 *
 * Everything is little-endian; floats are IEEE 754 single precision. A file is
 *
 *     SetkaFileHeader                        64 bytes
 *     SetkaFileSection[section_count]        64 bytes each
 *     the sections' bytes                    in the order of the table
 *
 * Each section starts at the first multiple of 64 bytes at or after the end of what precedes it; the bytes between are
 * 0; the file ends with the last byte of the last section. So every byte is determined by the structure, and equal
 * structures give equal files. A reader refuses anything else.
 *
 * A uniform grid (SETKA_FILE_UNIFORM_GRID) has these sections, all of them, in this order. What the tables mean is said
 * at SetkaGridHeader in layout.h.
 *
 *     "header"           SetkaGridHeader                           1
 *     "bounds"           SetkaBounds, around all triangles         1
 *     "offsets"          int32                                     cell_count
 *     "counts"           uint32                                    cell_count
 *     "references"       uint32, numbers of scene triangles        reference_count
 *     "triangles"        float[9], world space: v0, v1, v2         triangle_count
 *     "instance starts"  uint32, each instance's first triangle,   instance_count + 1
 *                        then triangle_count
 *     "instances"        SetkaInstance                             instance_count
 *
 * Triangle i of the scene belongs to the last instance whose start is not above i; its number in the instance's mesh is
 * i minus that start. The digest is XXH3-128 (seed 0) over the sections header, offsets, counts and references one behind
 * the other, without the padding. Checksums are XXH3-64 (seed 0).
 *
 * A change of anything above is another version.
 */
#ifndef SETKA_FILE_FORMAT_H
#define SETKA_FILE_FORMAT_H

#include <stdint.h>

#include "setka/layout.h"

/** The first eight bytes: a name, and line ends that a transfer as text would change. */
#define SETKA_FILE_MAGIC "SETKA\r\n\x1a"
#define SETKA_FILE_VERSION 1u
/** What sections start at multiples of. */
#define SETKA_FILE_ALIGNMENT 64u

/** Kinds of structures. */
#define SETKA_FILE_UNIFORM_GRID 1u

/** What a file begins with. 64 bytes. */
typedef struct SetkaFileHeader {
    uint8_t magic[8];       /**< SETKA_FILE_MAGIC without its terminating 0 */
    uint32_t version;       /**< of the format; in this place in every version */
    uint32_t kind;          /**< SETKA_FILE_UNIFORM_GRID */
    uint64_t size_bytes;    /**< of the whole file */
    uint32_t section_count;
    uint32_t reserved;      /**< 0 */
    uint64_t digest_high;   /**< of the tables, as above */
    uint64_t digest_low;
    uint64_t reserved_too;  /**< 0 */
    uint64_t checksum;      /**< of the 56 bytes before it, then the section table */
} SetkaFileHeader;

/** Where a section lies. 64 bytes. */
typedef struct SetkaFileSection {
    uint8_t name[32];       /**< ASCII, then zeros; at least one */
    uint64_t offset;        /**< from the beginning of the file, in bytes */
    uint64_t size_bytes;    /**< without the padding that follows */
    uint64_t checksum;      /**< of these bytes */
    uint64_t reserved;      /**< 0 */
} SetkaFileSection;

#endif
