/* SPDX-License-Identifier: MIT */
/**
 * Which records do host and device share, and what are their members? The lists from which the device probe
 * checks that both compilers lay them out alike. The host asserts that each list covers its record.
 */
#ifndef SETKA_DEVICE_PROBE_RECORDS_H
#define SETKA_DEVICE_PROBE_RECORDS_H

#include "device/shade/layout.h"
#include "device/trace/params.h"
#include "setka/layout.h"

/* clang-format off */
/* Members word by word: F(a float), U(an integer). */
#define SK_PROBE_THREE(F, name) F(name[0]) F(name[1]) F(name[2])
#define SK_PROBE_FOUR(F, name, k) F(name[k]) F(name[k + 1]) F(name[k + 2]) F(name[k + 3])

#define SK_MEMBERS_RAY(F, U) SK_PROBE_THREE(F, origin) F(tmin) SK_PROBE_THREE(F, direction) F(tmax)
#define SK_MEMBERS_HIT(F, U) F(t) F(u) F(v) U(primitive) U(instance)
#define SK_MEMBERS_PRIMITIVE(F, U) U(primitive) U(instance)
#define SK_MEMBERS_COST(F, U) U(steps) U(tests)
#define SK_MEMBERS_BOUNDS(F, U) SK_PROBE_THREE(F, lower) SK_PROBE_THREE(F, upper)
#define SK_MEMBERS_INSTANCE(F, U)                                                                   \
    SK_PROBE_FOUR(F, matrix, 0) SK_PROBE_FOUR(F, matrix, 4) SK_PROBE_FOUR(F, matrix, 8)             \
    U(first_triangle) U(first_index) U(first_vertex) U(material) U(mask) U(flags)
#define SK_MEMBERS_GRID(F, U)                                                                       \
    SK_PROBE_THREE(F, origin) F(cell_size) F(inverse_cell_size) F(tolerance)                        \
    SK_PROBE_THREE(U, dims) U(cell_count) U(reference_count) U(triangle_count) U(instance_count)    \
    F(extent) U(reserved[0]) U(reserved[1])
#define SK_MEMBERS_PARAMS(F, U)                                                                     \
    SK_PROBE_THREE(F, lower) SK_PROBE_THREE(F, size) F(extent) F(pad) F(unit)                       \
    U(mask) U(filters) U(skips) U(instance_count) U(triangle_count) U(row_length) U(tiled_rays)    \
    U(blocks_across) U(blocks_up)
#define SK_MEMBERS_CAMERA(F, U)                                                                     \
    SK_PROBE_THREE(F, eye) F(step_x) SK_PROBE_THREE(F, right) F(step_y)                             \
    SK_PROBE_THREE(F, up) U(width) SK_PROBE_THREE(F, forward) U(samples_per_axis)
#define SK_MEMBERS_MATERIAL(F, U)                                                                   \
    SK_PROBE_THREE(F, diffuse) F(reflectivity) SK_PROBE_THREE(F, specular) F(transparency)          \
    SK_PROBE_THREE(F, emission) F(refractive_index) SK_PROBE_THREE(F, transmission) U(squarings)
#define SK_MEMBERS_LIGHT(F, U)                                                                      \
    SK_PROBE_THREE(F, place) U(kind) SK_PROBE_THREE(F, intensity) F(reference_distance)
#define SK_MEMBERS_BACKGROUND(F, U)                                                                 \
    SK_PROBE_THREE(F, zenith) SK_PROBE_THREE(F, horizon) SK_PROBE_THREE(F, ground) F(ambient)
#define SK_MEMBERS_SURFACE(F, U)                                                                    \
    SK_PROBE_THREE(F, position) F(offset) SK_PROBE_THREE(F, normal) F(cosine)                       \
    SK_PROBE_THREE(F, geometric) U(material) SK_PROBE_THREE(F, light_origin) U(inside) SK_PROBE_THREE(F, tint)

/* R(type, variable, members); the kernel takes them by value in this order. */
#define SK_PROBE_RECORDS(R)                                                                         \
    R(SetkaRay, ray, SK_MEMBERS_RAY)                                                                \
    R(SetkaHit, hit, SK_MEMBERS_HIT)                                                                \
    R(SetkaPrimitive, primitive, SK_MEMBERS_PRIMITIVE)                                              \
    R(SetkaTraceCost, cost, SK_MEMBERS_COST)                                                        \
    R(SetkaBounds, bounds, SK_MEMBERS_BOUNDS)                                                       \
    R(SetkaInstance, instance, SK_MEMBERS_INSTANCE)                                                 \
    R(SetkaGridHeader, grid, SK_MEMBERS_GRID)                                                       \
    R(sk_trace_params, params, SK_MEMBERS_PARAMS)                                                   \
    R(SkCamera, camera, SK_MEMBERS_CAMERA)                                                          \
    R(SkMaterial, material, SK_MEMBERS_MATERIAL)                                                    \
    R(SkLight, light, SK_MEMBERS_LIGHT)                                                             \
    R(SkBackground, background, SK_MEMBERS_BACKGROUND)                                              \
    R(SkSurfacePoint, surface, SK_MEMBERS_SURFACE)
/* clang-format on */

/**
 * Words kept for each record, in what the kernel reads and in what it writes. Read: two records side by side.
 * Written: the size in bytes, then the members as a kernel argument holds them, then those of the second
 * record in memory.
 */
#define SK_PROBE_SLOT 64u

#endif
