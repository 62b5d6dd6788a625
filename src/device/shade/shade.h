/* SPDX-License-Identifier: MIT */
/**
 * What colour does a ray bring back? Whitted's recursion (An Improved Illumination Model for Shaded Display,
 * CACM 1980) as passes over a level of rays: the surface's own colour, each light's share, then rays onward
 * whose colours are gathered when the levels below are done. Every sum has a fixed order.
 */
#ifndef SETKA_DEVICE_SHADE_SHADE_H
#define SETKA_DEVICE_SHADE_SHADE_H

#include "device/shade/surface.h"

/* Rays onward are dropped when they could change the picture by less than this. */
#define SK_LEAST_THROUGHPUT 0x1p-8f
/* The share of light that passes what is transparent, however thick: a shadow ray does not bend, so more
 * would be a guess. */
#define SK_SHADOW_TRANSMISSION 0.75f
/* Mirror and refraction rays leave the triangle's plane by an angle with at least this sine. */
#define SK_LEAST_ESCAPE 0x1p-10f

SK_FUNCTION void sk_store3(SK_GLOBAL float* p, sk_vec3 a) {
    p[0] = a.x;
    p[1] = a.y;
    p[2] = a.z;
}

/** The background in a unit direction: from the horizon to zenith or ground, changing fastest at the horizon.
 */
SK_FUNCTION sk_vec3 sk_background(SkBackground background, sk_vec3 direction) {
    const float height = sk_min(sk_abs(direction.y), 1.0f);
    const float share = height * (2.0f - height), rest = 1.0f - share;
    const int up = direction.y > 0.0f;
    return sk_make3(
        background.horizon[0] * rest + (up ? background.zenith[0] : background.ground[0]) * share,
        background.horizon[1] * rest + (up ? background.zenith[1] : background.ground[1]) * share,
        background.horizon[2] * rest + (up ? background.zenith[2] : background.ground[2]) * share);
}

/** Schlick's approximation (1994) of a mirror's Fresnel reflection: the specular colour, 1 at grazing angles.
 */
SK_FUNCTION sk_vec3 sk_mirror_share(SkMaterial material, float cosine) {
    const float x = sk_max(1.0f - cosine, 0.0f), x2 = x * x, x5 = (x2 * x2) * x;
    return sk_make3((material.specular[0] + (1.0f - material.specular[0]) * x5) * material.reflectivity,
                    (material.specular[1] + (1.0f - material.specular[1]) * x5) * material.reflectivity,
                    (material.specular[2] + (1.0f - material.specular[2]) * x5) * material.reflectivity);
}

/** The diffuse colour of a point that is left beside what the surface mirrors and lets through. */
SK_FUNCTION sk_vec3 sk_matte(SkMaterial material, SkSurfacePoint point) {
    const sk_vec3 mirror = sk_mirror_share(material, point.cosine);
    const float rest = 1.0f - material.transparency;
    return sk_make3(((material.diffuse[0] * point.tint[0]) * rest) * (1.0f - mirror.x),
                    ((material.diffuse[1] * point.tint[1]) * rest) * (1.0f - mirror.y),
                    ((material.diffuse[2] * point.tint[2]) * rest) * (1.0f - mirror.z));
}

/** Emission and ambient light of a surface, or the background where there is none. */
SK_FUNCTION sk_vec3 sk_own_colour(SkSurfacePoint point, sk_vec3 direction, SkBackground background,
                                  SK_GLOBAL const SkMaterial* materials) {
    if (point.material == SETKA_NO_HIT) return sk_background(background, direction);
    {
        const SkMaterial material = materials[point.material];
        const sk_vec3 normal = sk_make3(point.normal[0], point.normal[1], point.normal[2]);
        const sk_vec3 light = sk_scale(sk_background(background, normal), background.ambient);
        const sk_vec3 matte = sk_matte(material, point);
        return sk_make3(material.emission[0] + light.x * matte.x, material.emission[1] + light.y * matte.y,
                        material.emission[2] + light.z * matte.z);
    }
}

/** Direction and distance from a point to a light; a directional light is infinitely far. */
SK_FUNCTION sk_measured sk_towards_light(SkLight light, sk_vec3 from) {
    sk_measured r;
    const sk_vec3 place = sk_make3(light.place[0], light.place[1], light.place[2]);
    if (light.kind == SK_LIGHT_POINT) return sk_measure(sk_sub(place, from));
    r.unit = place;
    r.length = sk_bits_float(0x7f800000u);
    return r;
}

SK_FUNCTION float sk_facing(SkSurfacePoint point, sk_vec3 direction) {
    return sk_dot3(sk_make3(point.normal[0], point.normal[1], point.normal[2]), direction);
}

/** Writes the shadow ray of a point, or one that meets nothing where the light is behind the surface, or
 * there is none. */
SK_FUNCTION void sk_shadow_ray(sk_u32 i, SkLight light, SK_GLOBAL const SkSurfacePoint* points,
                               SK_GLOBAL SetkaRay* rays, SK_GLOBAL sk_u32* active_count) {
    const SkSurfacePoint point = points[i];
    const sk_vec3 origin = sk_make3(point.light_origin[0], point.light_origin[1], point.light_origin[2]);
    const sk_measured to_light = sk_towards_light(light, origin);
    const int active = point.material != SETKA_NO_HIT && sk_facing(point, to_light.unit) > 0.0f;
    sk_store3(rays[i].origin, origin);
    sk_store3(rays[i].direction, to_light.unit);
    rays[i].tmin = active ? 0.0f : 1.0f;
    rays[i].tmax = active ? to_light.length : 0.0f;
    if (active) sk_atomic_add(active_count, 1u);
}

/** Makes a shadow ray meet nothing if nothing is in its way: what is left to ask is whether the others meet
 * opaque things. */
SK_FUNCTION void sk_narrow_shadow_ray(sk_u32 i, SK_GLOBAL const sk_u32* occluded, SK_GLOBAL SetkaRay* rays) {
    if (!occluded[i]) {
        rays[i].tmin = 1.0f;
        rays[i].tmax = 0.0f;
    }
}

/**
 * Adds one light: Lambert's diffuse and Blinn's highlight (Models of Light Reflection for Computer
 * Synthesized Pictures, 1977). The highlight too is multiplied by the cosine of the light's angle, so that it
 * fades out towards the dark side. `occluded` counts everything that the camera can see, `opaque` (null if
 * nothing is transparent) opaque things alone.
 */
SK_FUNCTION void sk_add_light(sk_u32 i, SkLight light, SK_GLOBAL const SetkaRay* rays,
                              SK_GLOBAL const SkSurfacePoint* points, SK_GLOBAL const SkMaterial* materials,
                              SK_GLOBAL const sk_u32* occluded, SK_GLOBAL const sk_u32* opaque,
                              sk_u32 has_opaque, SK_GLOBAL float* colours) {
    const SkSurfacePoint point = points[i];
    const sk_vec3 origin = sk_make3(point.light_origin[0], point.light_origin[1], point.light_origin[2]);
    const sk_measured to_light = sk_towards_light(light, origin);
    const float facing = sk_facing(point, to_light.unit);
    float visible = 1.0f;
    if (occluded[i]) visible = has_opaque && !opaque[i] ? SK_SHADOW_TRANSMISSION : 0.0f;
    if (point.material != SETKA_NO_HIT && facing > 0.0f && visible > 0.0f) {
        const SkMaterial material = materials[point.material];
        const sk_vec3 viewer = sk_negate(sk_load3(rays[i].direction));
        const sk_vec3 halfway = sk_unit(sk_add(to_light.unit, viewer));
        const sk_vec3 matte = sk_matte(material, point);
        float highlight = sk_max(sk_facing(point, halfway), 0.0f);
        float strength = visible * facing;
        sk_u32 k;
        for (k = 0u; k < material.squarings; ++k) highlight = highlight * highlight;
        /* Light that enters glass elsewhere does not make a highlight on the far side's inner face. */
        if (point.inside && material.transparency > 0.0f) highlight = 0.0f;
        if (light.kind == SK_LIGHT_POINT && light.reference_distance > 0.0f) {
            const float fall_off = light.reference_distance / to_light.length;
            strength = strength * (fall_off * fall_off);
        }
        SK_GLOBAL float* colour = colours + (size_t)i * 3u;
        colour[0] += ((matte.x + material.specular[0] * highlight) * light.intensity[0]) * strength;
        colour[1] += ((matte.y + material.specular[1] * highlight) * light.intensity[1]) * strength;
        colour[2] += ((matte.z + material.specular[2] * highlight) * light.intensity[2]) * strength;
    }
}

/** The rays that go on from a point: what each adds to the colour, and where it goes. A weight of 0 means no
 * such ray. */
typedef struct sk_onward {
    sk_vec3 mirror_weight, mirror_direction;
    sk_vec3 refraction_weight, refraction_direction;
} sk_onward;

SK_FUNCTION float sk_largest_weight(sk_vec3 a) { return sk_max(sk_max(a.x, a.y), a.z); }

/**
 * Mirror and refraction. What a transparent surface reflects follows Fresnel's equations themselves: they
 * need no more than a square root, and unlike Schlick's approximation they vanish for the refractive index 1.
 */
SK_FUNCTION sk_onward sk_make_onward(SkSurfacePoint point, SkMaterial material, sk_vec3 direction,
                                     float throughput) {
    sk_onward r;
    const sk_vec3 normal = sk_make3(point.normal[0], point.normal[1], point.normal[2]);
    const sk_vec3 geometric = sk_make3(point.geometric[0], point.geometric[1], point.geometric[2]);
    const float cosine = point.cosine, clear = material.transparency;
    const sk_vec3 mirror = sk_scale(sk_mirror_share(material, cosine), 1.0f - clear);
    const sk_vec3 none = sk_make3(0.0f, 0.0f, 0.0f);
    float reflected = 0.0f;
    r.refraction_weight = none;
    r.refraction_direction = direction;
    if (clear > 0.0f && material.refractive_index != 1.0f) {
        const float eta = point.inside ? material.refractive_index : 1.0f / material.refractive_index;
        const float sine2 = (eta * eta) * sk_max(1.0f - cosine * cosine, 0.0f);
        reflected = 1.0f; /* total internal reflection */
        if (sine2 < 1.0f) {
            const float beyond = sk_sqrt(1.0f - sine2);
            const float across = (eta * cosine - beyond) / (eta * cosine + beyond);
            const float along = (eta * beyond - cosine) / (eta * beyond + cosine);
            const sk_vec3 bent = sk_add(sk_scale(direction, eta), sk_scale(normal, eta * cosine - beyond));
            reflected = 0.5f * (across * across + along * along);
            r.refraction_direction = sk_bend_towards(sk_unit(bent), sk_negate(geometric), SK_LEAST_ESCAPE);
        }
    }
    if (clear > 0.0f) {
        const float passed = clear * (1.0f - reflected);
        r.refraction_weight = sk_make3(material.transmission[0] * passed, material.transmission[1] * passed,
                                       material.transmission[2] * passed);
    }
    reflected = reflected * clear;
    r.mirror_weight = sk_make3(mirror.x + reflected, mirror.y + reflected, mirror.z + reflected);
    r.mirror_direction = sk_bend_towards(sk_unit(sk_add(direction, sk_scale(normal, 2.0f * cosine))),
                                         geometric, SK_LEAST_ESCAPE);
    /* Written so that a NaN drops the ray. */
    if (!(throughput * sk_largest_weight(r.mirror_weight) >= SK_LEAST_THROUGHPUT)) r.mirror_weight = none;
    if (!(throughput * sk_largest_weight(r.refraction_weight) >= SK_LEAST_THROUGHPUT))
        r.refraction_weight = none;
    return r;
}

SK_FUNCTION sk_u32 sk_child_count(sk_u32 i, SK_GLOBAL const SetkaRay* rays,
                                  SK_GLOBAL const SkSurfacePoint* points,
                                  SK_GLOBAL const SkMaterial* materials, float throughput) {
    const SkSurfacePoint point = points[i];
    if (point.material == SETKA_NO_HIT) return 0u;
    {
        const sk_onward onward =
            sk_make_onward(point, materials[point.material], sk_load3(rays[i].direction), throughput);
        return (sk_largest_weight(onward.mirror_weight) > 0.0f ? 1u : 0u) +
               (sk_largest_weight(onward.refraction_weight) > 0.0f ? 1u : 0u);
    }
}

/** Writes child `at`, which starts off the surface on the side that its direction points to. */
SK_FUNCTION void sk_store_child(sk_u32 at, SkSurfacePoint point, float side, sk_vec3 direction,
                                sk_vec3 weight, float throughput, SK_GLOBAL SetkaRay* rays,
                                SK_GLOBAL float* weights, SK_GLOBAL float* throughputs) {
    const float reach = point.offset * side;
    rays[at].origin[0] = point.position[0] + point.geometric[0] * reach;
    rays[at].origin[1] = point.position[1] + point.geometric[1] * reach;
    rays[at].origin[2] = point.position[2] + point.geometric[2] * reach;
    sk_store3(rays[at].direction, direction);
    rays[at].tmin = 0.0f;
    rays[at].tmax = sk_bits_float(0x7f800000u);
    sk_store3(weights + (size_t)at * 3u, weight);
    throughputs[at] = throughput * sk_largest_weight(weight);
}

SK_FUNCTION void sk_emit_children(sk_u32 i, SK_GLOBAL const SetkaRay* rays,
                                  SK_GLOBAL const SkSurfacePoint* points,
                                  SK_GLOBAL const SkMaterial* materials, float throughput,
                                  SK_GLOBAL const sk_u32* offsets, SK_GLOBAL SetkaRay* child_rays,
                                  SK_GLOBAL float* child_weights, SK_GLOBAL float* child_throughputs) {
    const SkSurfacePoint point = points[i];
    if (point.material != SETKA_NO_HIT) {
        const sk_onward onward =
            sk_make_onward(point, materials[point.material], sk_load3(rays[i].direction), throughput);
        sk_u32 at = offsets[i];
        if (sk_largest_weight(onward.mirror_weight) > 0.0f) {
            sk_store_child(at, point, 1.0f, onward.mirror_direction, onward.mirror_weight, throughput,
                           child_rays, child_weights, child_throughputs);
            ++at;
        }
        if (sk_largest_weight(onward.refraction_weight) > 0.0f)
            sk_store_child(at, point, -1.0f, onward.refraction_direction, onward.refraction_weight,
                           throughput, child_rays, child_weights, child_throughputs);
    }
}

/** Adds to a ray's colour what its children brought back, in their order. */
SK_FUNCTION void sk_gather(sk_u32 i, SK_GLOBAL const sk_u32* offsets, SK_GLOBAL const float* weights,
                           SK_GLOBAL const float* child_colours, SK_GLOBAL float* colours) {
    sk_vec3 sum = sk_load3(colours + (size_t)i * 3u);
    sk_u32 at;
    for (at = offsets[i]; at < offsets[i + 1u]; ++at)
        sum = sk_add(sum, sk_mul(sk_load3(weights + (size_t)at * 3u), sk_load3(child_colours + (size_t)at * 3u)));
    sk_store3(colours + (size_t)i * 3u, sum);
}

#endif
