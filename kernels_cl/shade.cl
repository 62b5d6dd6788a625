/* SPDX-License-Identifier: MIT */
/** Which kernels shade? Entry points only; the bodies are in src/device/shade. */
#include "platform.h"

#include "device/shade/picture.h"

SK_KERNEL void shade_camera_rays(sk_u32 n, SkCamera camera, sk_u32 first_pixel, sk_u32 first_sample,
                                 sk_u32 samples, SK_GLOBAL SetkaRay* rays) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_camera_ray(i, camera, first_pixel, first_sample, samples, rays);
}

SK_KERNEL void shade_surface(sk_u32 n, SkBackground background, float offset, SK_GLOBAL const SetkaRay* rays,
                             SK_GLOBAL const SetkaHit* hits, SK_GLOBAL const SetkaInstance* instances,
                             SK_GLOBAL const sk_u32* instance_starts, SK_GLOBAL const sk_u32* indices,
                             SK_GLOBAL const float* normals, SK_GLOBAL const float* vertex_colors,
                             SK_GLOBAL const float* triangles, SK_GLOBAL const SkMaterial* materials,
                             SK_GLOBAL SkSurfacePoint* points, SK_GLOBAL float* colours) {
    const sk_u32 i = sk_global_id();
    if (i < n) {
        const SetkaHit hit = hits[i];
        const sk_vec3 direction = sk_load3(rays[i].direction);
        SkSurfacePoint point = sk_no_surface();
        if (hit.instance != SETKA_NO_HIT)
            point = sk_surface_point(direction, hit, instances, instance_starts, indices, normals, vertex_colors,
                                     triangles, offset);
        points[i] = point;
        sk_store3(colours + (size_t)i * 3u, sk_own_colour(point, direction, background, materials));
    }
}

SK_KERNEL void shade_shadow_rays(sk_u32 n, SkLight light, SK_GLOBAL const SkSurfacePoint* points,
                                 SK_GLOBAL SetkaRay* rays, SK_GLOBAL sk_u32* active_counts,
                                 sk_u32 light_index) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_shadow_ray(i, light, points, rays, active_counts + light_index);
}

SK_KERNEL void shade_shadow_narrow(sk_u32 n, SK_GLOBAL const sk_u32* occluded, SK_GLOBAL SetkaRay* rays) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_narrow_shadow_ray(i, occluded, rays);
}

SK_KERNEL void shade_light(sk_u32 n, SkLight light, SK_GLOBAL const SetkaRay* rays,
                           SK_GLOBAL const SkSurfacePoint* points, SK_GLOBAL const SkMaterial* materials,
                           SK_GLOBAL const sk_u32* occluded, SK_GLOBAL const sk_u32* opaque,
                           sk_u32 has_opaque, SK_GLOBAL float* colours) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_add_light(i, light, rays, points, materials, occluded, opaque, has_opaque, colours);
}

SK_KERNEL void shade_child_count(sk_u32 n, SK_GLOBAL const SetkaRay* rays,
                                 SK_GLOBAL const SkSurfacePoint* points,
                                 SK_GLOBAL const SkMaterial* materials, SK_GLOBAL const float* throughputs,
                                 sk_u32 has_throughputs, SK_GLOBAL sk_u32* counts) {
    const sk_u32 i = sk_global_id();
    if (i < n)
        counts[i] = sk_child_count(i, rays, points, materials, has_throughputs ? throughputs[i] : 1.0f);
}

SK_KERNEL void shade_child_emit(sk_u32 n, SK_GLOBAL const SetkaRay* rays,
                                SK_GLOBAL const SkSurfacePoint* points, SK_GLOBAL const SkMaterial* materials,
                                SK_GLOBAL const float* throughputs, sk_u32 has_throughputs,
                                SK_GLOBAL const sk_u32* offsets, SK_GLOBAL SetkaRay* child_rays,
                                SK_GLOBAL float* child_weights, SK_GLOBAL float* child_throughputs) {
    const sk_u32 i = sk_global_id();
    if (i < n)
        sk_emit_children(i, rays, points, materials, has_throughputs ? throughputs[i] : 1.0f, offsets,
                         child_rays, child_weights, child_throughputs);
}

SK_KERNEL void shade_gather(sk_u32 n, SK_GLOBAL const sk_u32* offsets, SK_GLOBAL const float* weights,
                            SK_GLOBAL const float* child_colours, SK_GLOBAL float* colours) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_gather(i, offsets, weights, child_colours, colours);
}

SK_KERNEL void shade_normals(sk_u32 n, SK_GLOBAL const SkSurfacePoint* points, SK_GLOBAL float* colours) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_store3(colours + (size_t)i * 3u, sk_normal_colour(points[i]));
}

SK_KERNEL void shade_add_colours(sk_u32 n, sk_u32 first, sk_u32 done, sk_u32 samples,
                                 SK_GLOBAL const float* colours, SK_GLOBAL const float* before,
                                 SK_GLOBAL float* after) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_add_colours(i, first + i, done, samples, colours, before, after);
}

SK_KERNEL void shade_add_depths(sk_u32 n, sk_u32 first, sk_u32 done, sk_u32 samples,
                                SK_GLOBAL const SetkaHit* hits, SK_GLOBAL const float* before,
                                SK_GLOBAL float* after) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_add_depths(i, first + i, done, samples, hits, before, after);
}

SK_KERNEL void shade_add_costs(sk_u32 n, sk_u32 first, sk_u32 done, sk_u32 samples, sk_u32 tests,
                               SK_GLOBAL const SetkaTraceCost* costs, SK_GLOBAL const float* before,
                               SK_GLOBAL float* after) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_add_costs(i, first + i, done, samples, tests, costs, before, after);
}

SK_KERNEL void shade_mean_colour(sk_u32 n, sk_u32 first, sk_u32 done, SK_GLOBAL const float* sums,
                                 SK_GLOBAL float* linear) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_store3(linear + (size_t)i * 3u, sk_mean_colour(first + i, done, sums));
}

SK_KERNEL void shade_mean_depth(sk_u32 n, sk_u32 first, SK_GLOBAL const float* sums, SK_GLOBAL float* values) {
    const sk_u32 i = sk_global_id();
    if (i < n) values[i] = sk_mean_depth(first + i, sums);
}

SK_KERNEL void shade_mean_cost(sk_u32 n, sk_u32 first, sk_u32 done, SK_GLOBAL const float* sums,
                               SK_GLOBAL float* values) {
    const sk_u32 i = sk_global_id();
    if (i < n) values[i] = sums[first + i] / (float)done;
}

SK_KERNEL void shade_ramp(sk_u32 n, SK_GLOBAL const float* values, float maximum, SK_GLOBAL const float* ramp,
                          sk_u32 knots, SK_GLOBAL float* linear) {
    const sk_u32 i = sk_global_id();
    if (i < n) sk_store3(linear + (size_t)i * 3u, sk_ramp_colour(values[i], maximum, ramp, knots));
}

SK_KERNEL void shade_encode(sk_u32 n, SK_GLOBAL const float* linear, SK_GLOBAL const float* thresholds,
                            SK_GLOBAL unsigned char* codes) {
    const sk_u32 i = sk_global_id();
    if (i < n) codes[i] = (unsigned char)sk_encode(linear[i], thresholds);
}
