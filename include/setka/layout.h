/* SPDX-License-Identifier: MIT */
/**
 * What do setka's records look like in memory? The structs that host and device share, byte for byte. The file is C99 and
 * compiles as C, C++, OpenCL C 1.2 and CUDA C++, so that a user's own kernel may include it to read rays, hits and tables.
 * Members are 4-byte scalars or arrays of them: no compiler pads or aligns them differently.
 */
#ifndef SETKA_LAYOUT_H
#define SETKA_LAYOUT_H

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
typedef uint setka_u32;
typedef int setka_i32;
#else
#include <stdint.h>
typedef uint32_t setka_u32;
typedef int32_t setka_i32;
#endif

/** The primitive and instance of a ray that hit nothing. */
#define SETKA_NO_HIT 0xffffffffu

/**
 * A ray: points origin + t * direction with tmin <= t <= tmax. The direction need not be normalised; t is in its lengths.
 * A ray with a NaN anywhere, an infinite origin or direction, a zero direction or tmin > tmax hits nothing. tmax may be
 * infinite. 32 bytes: one row of a float32 n x 8 array.
 */
typedef struct SetkaRay {
    float origin[3];
    float tmin;
    float direction[3];
    float tmax;
} SetkaRay;

/**
 * The closest hit of a ray. The point is (1-u-v)*v0 + u*v1 + v*v2 of triangle `primitive` (its index within the mesh) of
 * instance `instance`. A miss has t = +infinity, u = v = 0 and both indices SETKA_NO_HIT. 20 bytes.
 */
typedef struct SetkaHit {
    float t;
    float u;
    float v;
    setka_u32 primitive;
    setka_u32 instance;
} SetkaHit;

/** A triangle as hits name it: its index within the mesh of an instance. 8 bytes. */
typedef struct SetkaPrimitive {
    setka_u32 primitive;
    setka_u32 instance;
} SetkaPrimitive;

/** What one ray cost: places visited, which are grid cells or larger empty cubes of them, and triangles tested. 8 bytes. */
typedef struct SetkaTraceCost {
    setka_u32 steps;
    setka_u32 tests;
} SetkaTraceCost;

/** An axis-aligned box. 24 bytes. */
typedef struct SetkaBounds {
    float lower[3];
    float upper[3];
} SetkaBounds;

/** One placed mesh: world = matrix (3 rows of 4) * (x, y, z, 1). 72 bytes. */
typedef struct SetkaInstance {
    float matrix[12];
    setka_u32 first_triangle;  /**< index of its first triangle among all triangles of the scene */
    setka_u32 first_index;     /**< where the mesh's triangles start in the index table, in triangles */
    setka_u32 first_vertex;    /**< where the mesh's vertices start in the vertex table, in vertices */
    setka_u32 material;        /**< index into the scene's materials */
    setka_u32 mask;            /**< visible to a query if (mask & query mask) is not zero */
    setka_u32 flags;           /**< SETKA_INSTANCE_* */
} SetkaInstance;

#define SETKA_INSTANCE_HAS_NORMALS 1u
#define SETKA_INSTANCE_HAS_COLORS 2u

/** The mask bit that a device scene sets on instances of opaque materials, and on no other; queries may use it. */
#define SETKA_MASK_OPAQUE 0x80000000u

/**
 * The uniform grid's header. Cell (ix, iy, iz) has the number (iz * dims[1] + iy) * dims[0] + ix; its list is
 * references[offset .. offset + count), scene triangle numbers in ascending order; an empty cell has offset -1, count 0.
 * A point p lies in cell floor((p - origin) * inverse_cell_size) (subtract, then multiply, in float). 64 bytes.
 */
typedef struct SetkaGridHeader {
    float origin[3];
    float cell_size;
    float inverse_cell_size;
    float tolerance;           /**< in cells: a list holds every triangle that comes this close to its cell */
    setka_u32 dims[3];
    setka_u32 cell_count;
    setka_u32 reference_count; /**< pairs (triangle, cell): the length of `references` */
    setka_u32 triangle_count;
    setka_u32 instance_count;
    float extent;              /**< the longest side of the scene's bounds */
    setka_u32 reserved[2];
} SetkaGridHeader;

#endif
