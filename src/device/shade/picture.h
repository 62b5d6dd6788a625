/* SPDX-License-Identifier: MIT */
/**
 * How do rays make a picture? Camera rays from pixels, pixels from the rays' colours or measures, and 8-bit
 * sRGB from linear light.
 */
#ifndef SETKA_DEVICE_SHADE_PICTURE_H
#define SETKA_DEVICE_SHADE_PICTURE_H

#include "device/shade/shade.h"

/** Ray i of the pixels from `first_pixel` on: for each pixel in turn `samples` of its samples, which are numbered row by row of
 * a regular grid, from `first_sample` on. */
SK_FUNCTION void sk_camera_ray(sk_u32 i, SkCamera camera, sk_u32 first_pixel, sk_u32 first_sample,
                               sk_u32 samples, SK_GLOBAL SetkaRay* rays) {
    const sk_u32 axis = camera.samples_per_axis;
    const sk_u32 pixel = first_pixel + i / samples, sample = first_sample + i % samples;
    /* Sample columns and rows of the whole picture: at most 2^18, exact as floats. */
    const float column = (float)((pixel % camera.width) * axis + sample % axis);
    const float row = (float)((pixel / camera.width) * axis + sample / axis);
    const float x = (column + 0.5f) * camera.step_x - 1.0f;
    const float y = 1.0f - (row + 0.5f) * camera.step_y;
    const sk_vec3 direction = sk_unit(sk_make3(camera.forward[0] + (camera.right[0] * x + camera.up[0] * y),
                                               camera.forward[1] + (camera.right[1] * x + camera.up[1] * y),
                                               camera.forward[2] + (camera.right[2] * x + camera.up[2] * y)));
    sk_store3(rays[i].origin, sk_make3(camera.eye[0], camera.eye[1], camera.eye[2]));
    sk_store3(rays[i].direction, direction);
    rays[i].tmin = 0.0f;
    rays[i].tmax = sk_bits_float(0x7f800000u);
}

/** A shading normal as a colour; black where there is no surface. */
SK_FUNCTION sk_vec3 sk_normal_colour(SkSurfacePoint point) {
    if (point.material == SETKA_NO_HIT) return sk_make3(0.0f, 0.0f, 0.0f);
    return sk_make3((point.normal[0] + 1.0f) * 0.5f, (point.normal[1] + 1.0f) * 0.5f,
                    (point.normal[2] + 1.0f) * 0.5f);
}

/**
 * Sums of a pixel's samples grow by `samples` of them at a time, in their order, from nothing where `done` of them were added
 * before: the parts that a picture comes about in do not show in it. What a pass reads it does not write, so that a pass that is
 * broken off leaves the sums before it. `place` is the pixel's in the sums, `i` in what is added.
 */
SK_FUNCTION void sk_add_colours(sk_u32 i, sk_u32 place, sk_u32 done, sk_u32 samples,
                                SK_GLOBAL const float* colours, SK_GLOBAL const float* before,
                                SK_GLOBAL float* after) {
    sk_vec3 sum = sk_make3(0.0f, 0.0f, 0.0f);
    sk_u32 k;
    if (done) sum = sk_load3(before + (size_t)place * 3u);
    for (k = 0u; k < samples; ++k) sum = sk_add(sum, sk_load3(colours + ((size_t)i * samples + k) * 3u));
    sk_store3(after + (size_t)place * 3u, sum);
}

/** The same of the samples' t and of how many samples hit something. */
SK_FUNCTION void sk_add_depths(sk_u32 i, sk_u32 place, sk_u32 done, sk_u32 samples,
                               SK_GLOBAL const SetkaHit* hits, SK_GLOBAL const float* before,
                               SK_GLOBAL float* after) {
    float sum = 0.0f, count = 0.0f;
    sk_u32 k;
    if (done) {
        sum = before[(size_t)place * 2u];
        count = before[(size_t)place * 2u + 1u];
    }
    for (k = 0u; k < samples; ++k) {
        const size_t at = (size_t)i * samples + k;
        if (hits[at].instance != SETKA_NO_HIT) {
            sum = sum + hits[at].t;
            count = count + 1.0f;
        }
    }
    after[(size_t)place * 2u] = sum;
    after[(size_t)place * 2u + 1u] = count;
}

/** The same of the samples' steps, or tests. */
SK_FUNCTION void sk_add_costs(sk_u32 i, sk_u32 place, sk_u32 done, sk_u32 samples, sk_u32 tests,
                              SK_GLOBAL const SetkaTraceCost* costs, SK_GLOBAL const float* before,
                              SK_GLOBAL float* after) {
    float sum = 0.0f;
    sk_u32 k;
    if (done) sum = before[place];
    for (k = 0u; k < samples; ++k) {
        const size_t at = (size_t)i * samples + k;
        sum = sum + (float)(tests ? costs[at].tests : costs[at].steps);
    }
    after[place] = sum;
}

/** The mean t of a pixel's samples that hit something; -1 if none does. */
SK_FUNCTION float sk_mean_depth(sk_u32 place, SK_GLOBAL const float* sums) {
    const float sum = sums[(size_t)place * 2u], count = sums[(size_t)place * 2u + 1u];
    return count > 0.0f ? sum / count : -1.0f;
}

/** The colour of value / maximum on a ramp of `knots` colours joined by straight lines; black below 0. */
SK_FUNCTION sk_vec3 sk_ramp_colour(float value, float maximum, SK_GLOBAL const float* ramp, sk_u32 knots) {
    const float share = maximum > 0.0f ? sk_min(value / maximum, 1.0f) : 0.0f;
    if (!(value >= 0.0f)) return sk_make3(0.0f, 0.0f, 0.0f);
    {
        const float place = share * (float)(knots - 1u);
        const sk_u32 knot = sk_min_u32((sk_u32)place, knots - 2u);
        const float part = place - (float)knot;
        return sk_add(sk_scale(sk_load3(ramp + 3u * knot), 1.0f - part),
                      sk_scale(sk_load3(ramp + 3u * knot + 3u), part));
    }
}

/** 0 for a NaN, which light beyond the range of floats may leave: its bits differ between devices. */
SK_FUNCTION float sk_number(float a) { return a == a ? a : 0.0f; }

/** The mean colour of a pixel of which `done` samples were added. */
SK_FUNCTION sk_vec3 sk_mean_colour(sk_u32 place, sk_u32 done, SK_GLOBAL const float* sums) {
    const sk_vec3 sum = sk_load3(sums + (size_t)place * 3u);
    const float count = (float)done;
    return sk_make3(sk_number(sum.x / count), sk_number(sum.y / count), sk_number(sum.z / count));
}

/** The 8-bit code of linear light: how many of the 255 ascending thresholds it reaches. A NaN reaches none.
 */
SK_FUNCTION sk_u32 sk_encode(float linear, SK_GLOBAL const float* thresholds) {
    sk_u32 code = 0u, step;
    for (step = 128u; step > 0u; step >>= 1)
        if (thresholds[code + step - 1u] <= linear) code += step;
    return code;
}

#endif
