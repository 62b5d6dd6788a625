// SPDX-License-Identifier: MIT
/// Can the oracle's hits be trusted? They are held against another formula in double precision, within a
/// tolerance and where both are well-conditioned.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "oracle/oracle.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"

namespace {

/// Rays of which one length is about the scene's size: for the others, a tolerance in t says nothing.
std::vector<oracle::Ray> moderate_rays(const oracle::World& world) {
    std::vector<oracle::Ray> rays;
    for (const oracle::Ray& ray : support::adversarial_rays(world, 3000, 21)) {
        double length = 0, distance = 0;
        for (int axis = 0; axis < 3; ++axis) {
            length += double(ray.direction[axis]) * ray.direction[axis];
            distance += std::fabs(double(ray.origin[axis]) - world.bounds.lower[axis]);
        }
        const bool is_moderate = std::isfinite(length) && std::isfinite(distance) &&
                                 distance < 20.0 * world.extent && length > 1e-60 && length < 1e60 &&
                                 ray.tmin <= ray.tmax;
        if (is_moderate) rays.push_back(ray);
    }
    return rays;
}

/// What the other formula says of a ray, and whether it can be trusted with it.
struct Judgement {
    bool is_well_conditioned = true;
    double closest = INFINITY;
    double tolerance = 0;  ///< of t
};

Judgement judge(const oracle::World& world, const oracle::Ray& ray, const oracle::Hit& hit) {
    Judgement judgement;
    double largest = world.extent;  // rounding grows with coordinates far from the origin
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max(
            {largest, std::fabs(double(world.bounds.lower[axis])), std::fabs(double(ray.origin[axis]))});
    const double length =
        std::hypot(double(ray.direction[0]), double(ray.direction[1]), double(ray.direction[2]));
    judgement.tolerance = 1e-4 * largest / length;
    judgement.is_well_conditioned = largest <= 1e3 * world.extent;
    for (const auto& triangle : world.triangles) {
        if ((triangle.mask & ~SETKA_MASK_OPAQUE) == 0) continue;
        const auto rough = oracle::rough_hit(triangle, ray);
        const bool is_hit = triangle.primitive == hit.primitive && triangle.instance == hit.instance;
        const bool is_near = rough.margin > -1e-3 && rough.t > ray.tmin - judgement.tolerance &&
                             rough.t < ray.tmax + judgement.tolerance;
        const bool is_clear = rough.conditioning > 0.02 && rough.margin > 1e-3 &&
                              rough.t > ray.tmin + judgement.tolerance &&
                              rough.t < ray.tmax - judgement.tolerance;
        if ((is_hit || is_near) && !is_clear && !(rough.conditioning >= 0.02))
            judgement.is_well_conditioned = false;
        if (is_near && !is_clear) judgement.is_well_conditioned = false;
        if (is_near) judgement.closest = std::min(judgement.closest, rough.t);
    }
    return judgement;
}

class OracleHits : public ::testing::TestWithParam<std::string> {};

TEST_P(OracleHits, ArePlausible) {
    const oracle::World world = oracle::make_world(support::find_scene(GetParam()).make());
    if (world.extent > 0 && (world.extent < 1e-9f || world.extent > 1e12f))
        GTEST_SKIP() << "the specified test multiplies three lengths in single precision, which needs an "
                        "extent nearer to 1";
    const auto rays = moderate_rays(world);
    const auto hits = oracle::closest_hits(world, rays);
    int compared = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Judgement judgement = judge(world, rays[i], hits[i]);
        if (!judgement.is_well_conditioned) continue;
        ++compared;
        if (std::isfinite(judgement.closest)) {
            EXPECT_NEAR(hits[i].t, judgement.closest, judgement.tolerance) << "ray " << i;
        } else {
            EXPECT_EQ(hits[i].primitive, SETKA_NO_HIT) << "ray " << i;
        }
    }
    std::cout << compared << " of " << rays.size() << " hits compared\n";
}

INSTANTIATE_TEST_SUITE_P(Degenerate, OracleHits,
                         ::testing::ValuesIn(support::names(support::degenerate_scenes())),
                         support::scene_name<::testing::TestParamInfo<std::string>>);

}  // namespace
