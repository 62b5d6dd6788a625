/* SPDX-License-Identifier: MIT */
/**
 * What do the host and the shading kernels hand each other? Records of 4-byte scalars, as in setka/layout.h:
 * the host includes this file too, and src/trace/shading_tables.cpp asserts their sizes.
 */
#ifndef SETKA_DEVICE_SHADE_LAYOUT_H
#define SETKA_DEVICE_SHADE_LAYOUT_H

#include "setka/layout.h"

/** A pinhole camera: a ray's direction is forward + x * right + y * up for x and y in -1 to 1 over the
 * picture. 64 bytes. */
typedef struct SkCamera {
    float eye[3];
    float step_x; /**< 2 over the samples along the width */
    float right[3];
    float step_y; /**< 2 over the samples along the height */
    float up[3];
    setka_u32 width;
    float forward[3];
    setka_u32 samples_per_axis;
} SkCamera;

/** A material; fields as in setka::Material. 64 bytes. */
typedef struct SkMaterial {
    float diffuse[3];
    float reflectivity;
    float specular[3];
    float transparency;
    float emission[3];
    float refractive_index;
    float transmission[3];
    setka_u32 squarings; /**< the highlight's exponent is 2 to this */
} SkMaterial;

#define SK_LIGHT_POINT 0u
#define SK_LIGHT_DIRECTIONAL 1u

/** A light. 32 bytes. */
typedef struct SkLight {
    float place[3]; /**< the position, or the unit direction towards the light */
    setka_u32 kind;
    float intensity[3];
    float reference_distance;
} SkLight;

/** The background's gradient. 40 bytes. */
typedef struct SkBackground {
    float zenith[3];
    float horizon[3];
    float ground[3];
    float ambient;
} SkBackground;

/** Where a ray met a surface, with all that shading needs of it. 76 bytes. */
typedef struct SkSurfacePoint {
    float position[3];
    float offset;          /**< how far from the surface new rays start */
    float normal[3];       /**< for shading; unit, towards the viewer */
    float cosine;          /**< normal times the direction to the viewer, above 0 */
    float geometric[3];    /**< the triangle's; unit, towards the viewer */
    setka_u32 material;    /**< SETKA_NO_HIT where the ray left the scene */
    float light_origin[3]; /**< where shadow rays start */
    setka_u32 inside;      /**< 1 if the ray came from inside a closed mesh, else 0 */
    float tint[3];         /**< the vertices' colour, by which the diffuse one is multiplied; 1 where they have none */
} SkSurfacePoint;

#endif
