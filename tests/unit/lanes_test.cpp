// SPDX-License-Identifier: MIT
/// Are SK_WIDTH numbers side by side those that one after the other gives? Rays and triangle tests in lanes
/// against the same in scalars, bit for bit. The walk in lanes is held against brute force on the host device
/// (tests/fuzz) and in the parity tests.
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/trace/triangle_lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>
#include <random>
#include <vector>

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class Numbers {
  public:
    /// Any sign and fraction, exponents from 2^lowest to 2^highest.
    float operator()(int lowest, int highest) {
        const std::uint32_t exponent = static_cast<std::uint32_t>(lowest + 127) +
                                       below(static_cast<std::uint32_t>(highest - lowest + 1));
        return std::bit_cast<float>((bits() & 0x807fffffu) | exponent << 23);
    }
    /// A coordinate near the scene, often one that others share.
    float coordinate() { return below(2) ? static_cast<float>(below(5)) * 0.25f : (*this)(-6, 0); }
    /// Anything that a caller may pass.
    float anything() {
        constexpr std::array<float, 8> special{0.0f, -0.0f,     infinity, -infinity,
                                               nan,  0x1p-149f, 3e38f,    0x1p-101f};
        switch (below(4)) {
            case 0:
                return special[below(special.size())];
            case 1:
                return std::bit_cast<float>(bits());
            case 2:
                return (*this)(-126, 127);
            default:
                return coordinate();
        }
    }
    std::uint32_t below(std::uint32_t end) { return bits() % end; }

  private:
    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }

    std::mt19937 engine_{5};
};

sk_trace_params unit_box() {
    sk_trace_params params{};
    for (float& size : params.size) size = 1.0f;
    params.extent = 1.0f;
    params.pad = 0x1p-16f;
    params.unit = 0x1p20f;
    return params;
}

/// Half of the rays are ordinary, a quarter come from afar, and a quarter are anything.
std::vector<SetkaRay> some_rays(Numbers& number, std::size_t count) {
    std::vector<SetkaRay> rays(count);
    for (SetkaRay& ray : rays) {
        const std::uint32_t kind = number.below(4);
        const float distance = kind == 2 ? number(0, 120) : 1.0f;
        for (int axis = 0; axis < 3; ++axis) {
            ray.origin[axis] = kind == 3 ? number.anything() : number.coordinate() * distance;
            ray.direction[axis] = kind == 3   ? number.anything()
                                  : kind == 2 ? number.coordinate() - ray.origin[axis]
                                              : number.coordinate() - 0.5f;
        }
        ray.tmin = kind == 3 ? number.anything() : 0.0f;
        ray.tmax = kind == 3 ? number.anything() : infinity;
    }
    return rays;
}

std::uint32_t bits(float f) { return std::bit_cast<std::uint32_t>(f); }

#define LANE(k) k
const sk_iN lanes = SK_INTS(LANE);
#undef LANE

TEST(Lanes, PrepareRaysAsScalarsDo) {
    Numbers number;
    const sk_trace_params params = unit_box();
    std::size_t valid = 0, moved = 0;
    for (int round = 0; round < 20000; ++round) {
        const auto rays = some_rays(number, SK_WIDTH);
        const sk_ray_lanes many = sk_prepare_ray_lanes(params, rays.data(), lanes);
        for (std::size_t k = 0; k < SK_WIDTH; ++k) {
            const sk_working_ray one = sk_prepare_ray(params, rays[k]);
            ASSERT_EQ(many.valid[k], one.valid ? -1 : 0) << "ray " << k << " of round " << round;
            if (!one.valid) continue;
            ++valid;
            moved += one.shift != 0.0f;
            const std::array expected{one.o.x,   one.o.y,       one.o.z,       one.d.x,      one.d.y,
                                      one.d.z,   one.w0,        one.w1,        one.pre,      one.scale,
                                      one.shift, one.tmin,      one.tmax,      one.sx,       one.sy,
                                      one.sz,    one.inverse.x, one.inverse.y, one.inverse.z};
            const std::array found{many.o.x[k],       many.o.y[k],       many.o.z[k],      many.d.x[k],
                                   many.d.y[k],       many.d.z[k],       many.w0[k],       many.w1[k],
                                   many.pre[k],       many.scale[k],     many.shift[k],    many.tmin[k],
                                   many.tmax[k],      many.sx[k],        many.sy[k],       many.sz[k],
                                   many.inverse.x[k], many.inverse.y[k], many.inverse.z[k]};
            for (std::size_t i = 0; i < expected.size(); ++i)
                ASSERT_EQ(bits(found[i]), bits(expected[i]))
                    << "member " << i << " of ray " << k << " in round " << round;
            ASSERT_EQ(many.along_x[k] ? 0u : many.along_y[k] ? 1u : 2u, one.kz);
        }
    }
    EXPECT_GT(valid, 20000u);
    EXPECT_GT(moved, 1000u);
}

TEST(Lanes, TestTrianglesAsScalarsDo) {
    Numbers number;
    const sk_trace_params params = unit_box();
    std::size_t hits = 0, passed = 0;
    for (int round = 0; round < 20000; ++round) {
        const auto rays = some_rays(number, SK_WIDTH);
        std::vector<float> triangles(9 * SK_WIDTH);
        for (float& f : triangles) f = number.coordinate();
        const sk_ray_lanes many = sk_prepare_ray_lanes(params, rays.data(), lanes);
        const sk_view_lanes views = sk_view_triangle_lanes(many, triangles.data(), lanes);
        const sk_iN may_pass = sk_may_pass_lanes(views);
        const sk_hit_lanes found = sk_test_view_lanes(many, params.unit, views);
        for (std::size_t k = 0; k < SK_WIDTH; ++k) {
            const sk_working_ray ray = sk_prepare_ray(params, rays[k]);
            if (!ray.valid) continue;
            const auto first = static_cast<sk_u32>(9 * k);
            const bool passes =
                sk_may_pass(sk_view_triangle(sk_viewpoint_of(ray), triangles.data(), first, 1));
            ASSERT_EQ(may_pass[k], passes ? -1 : 0) << "lane " << k << " of round " << round;
            const sk_best one = sk_test_triangle(ray, triangles.data(), first, 1, 7, sk_no_hit());
            ASSERT_EQ(may_pass[k] & found.hits[k], one.triangle == 7 ? -1 : 0)
                << "lane " << k << " of round " << round;
            passed += passes;
            if (one.triangle != 7) continue;
            ++hits;
            ASSERT_EQ(bits(found.w[k]), bits(one.w));
            ASSERT_EQ(bits(found.u[k]), bits(one.u));
            ASSERT_EQ(bits(found.v[k]), bits(one.v));
            ASSERT_EQ(bits(sk_user_t_lanes(many, found.w)[k]), bits(sk_user_t(ray, one.w)));
        }
    }
    EXPECT_GT(hits, 3000u);
    EXPECT_GT(passed, hits);
}

/// The smallest w counts, then the smallest number as an unsigned one; any hit is better than none.
TEST(Lanes, PreferHitsAsScalarsDo) {
    constexpr sk_i32 none = static_cast<sk_i32>(SETKA_NO_HIT);
    struct Case {
        float w;
        sk_i32 number;
        float best_w;
        sk_i32 best_triangle;
        bool is_better;
    };
    constexpr std::array<Case, 8> cases{{{1, 9, 2, 5, true},
                                         {2, 4, 2, 5, true},
                                         {3, 4, 2, 5, false},
                                         {2, 6, 2, 5, false},
                                         {2, 5, 2, 5, false},
                                         {2, 6, 2, static_cast<sk_i32>(0x80000005u), true},
                                         {3e38f, 0, 3e38f, none, true},
                                         {infinity, 0, 3e38f, none, true}}};
    sk_hit_lanes hit{};
    sk_best_lanes best = sk_no_hit_lanes();
    sk_iN number{};
    for (std::size_t k = 0; k < SK_WIDTH; ++k) {
        const Case& one = cases[k % cases.size()];
        hit.w[k] = one.w;
        number[k] = one.number;
        best.w[k] = one.best_w;
        best.triangle[k] = one.best_triangle;
    }
    const sk_iN better = sk_is_better_lanes(hit, number, best);
    for (std::size_t k = 0; k < SK_WIDTH; ++k)
        EXPECT_EQ(better[k], cases[k % cases.size()].is_better ? -1 : 0) << "lane " << k;
}

/// A number from each lane's place; rows of four beside each other become columns; and bits.
TEST(Lanes, GatherAndCount) {
    std::vector<float> numbers(1000);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
    const sk_iN at = lanes * 3 + 7;
    const sk_columns columns = sk_gather4(numbers.data(), at, 9);
    const sk_fN ones = sk_gather_f(numbers.data(), at, 9);
    const sk_iN mask = (lanes & 5) == sk_same_i(4);
    for (std::size_t k = 0; k < SK_WIDTH; ++k) {
        const float first = static_cast<float>((k * 3 + 7) * 9);
        EXPECT_EQ(ones[k], first) << "lane " << k;
        EXPECT_EQ(columns.a[k], first) << "lane " << k;
        EXPECT_EQ(columns.b[k], first + 1) << "lane " << k;
        EXPECT_EQ(columns.c[k], first + 2) << "lane " << k;
        EXPECT_EQ(columns.d[k], first + 3) << "lane " << k;
        EXPECT_EQ(sk_lane_bits(mask) >> k & 1u, (k & 5) == 4 ? 1u : 0u) << "lane " << k;
        EXPECT_EQ(sk_lowest_bits(sk_same_i(12 << k))[k], static_cast<sk_i32>(k + 2)) << "lane " << k;
        sk_iN single{};
        EXPECT_FALSE(sk_any_lane(single));
        single[k] = -1;
        EXPECT_TRUE(sk_any_lane(single));
        EXPECT_EQ(sk_lane_bits(single), 1u << k);
    }
    EXPECT_LT(sk_lane_bits(mask), 1u << SK_WIDTH);
}

}  // namespace
