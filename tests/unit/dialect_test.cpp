// SPDX-License-Identifier: MIT
/// Are the value functions of the kernels right? Their bodies, translated for the host, against doubles,
/// which hold every product of two floats, and against integers.
// The translation comes before every file of the dialect.
#include "device/host_platform.h"
// The dialect.
#include "device/grid/cells.h"
#include "device/math.h"
#include "device/trace/triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Any sign and fraction, exponents from 2^lowest to 2^highest.
class Numbers {
  public:
    float operator()(int lowest, int highest) {
        const std::uint32_t exponent = static_cast<std::uint32_t>(lowest + 127) +
                                       below(static_cast<std::uint32_t>(highest - lowest + 1));
        return std::bit_cast<float>((bits() & 0x807fffffu) | exponent << 23);
    }
    std::uint32_t below(std::uint32_t end) { return bits() % end; }

  private:
    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }

    std::mt19937 engine_{7};
};

int sign(double x) { return (x > 0) - (x < 0); }

/// Steps from one float to another.
float moved(float x, std::uint32_t steps) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + steps);
}

TEST(AccurateDifference, HasTheExactSignAndFullPrecision) {
    Numbers number;
    for (int i = 0; i < 200000; ++i) {
        const float a = number(-20, 20), b = number(-20, 20);
        // Every other time products that nearly agree, where a plain difference is noise.
        const bool is_close = i % 2 == 0;
        const float c = is_close ? moved(a, number.below(4)) : number(-20, 20);
        const float d = is_close ? moved(b, 4 - number.below(4)) : number(-20, 20);
        const double p = double(a) * b, q = double(c) * d;  // both exact
        const double exact = p - q;
        const double found = sk_accurate_difference(a, b, c, d);
        ASSERT_EQ(sign(found), sign(exact)) << a << " * " << b << " - " << c << " * " << d;
        ASSERT_LE(std::fabs(found - exact), std::fabs(exact) * 0x1p-23)
            << a << " * " << b << " - " << c << " * " << d;
    }
}

TEST(AccurateDifference, ErrorsOfProductsAndSumsAreExact) {
    Numbers number;
    for (int i = 0; i < 100000; ++i) {
        const float a = number(-20, 20), b = number(-20, 20);
        const sk_pair product = sk_two_product(a, b);
        ASSERT_EQ(double(product.value) + product.error, double(a) * b) << a << " * " << b;
        const float x = number(-10, 10), y = number(-10, 10);
        const sk_pair sum = sk_two_sum(x, y), difference = sk_two_difference(x, y);
        ASSERT_EQ(double(sum.value) + sum.error, double(x) + y) << x << " + " << y;
        ASSERT_EQ(double(difference.value) + difference.error, double(x) - y) << x << " - " << y;
    }
}

TEST(Cell, IsTheIntegerPartWithinTheGrid) {
    Numbers number;
    for (int i = 0; i < 100000; ++i) {
        const std::uint32_t dim = 1 + number.below(4096);
        const float f = number(-30, 14);
        const double clamped = std::clamp(std::floor(double(f)), 0.0, double(dim) - 1);
        ASSERT_EQ(sk_cell(f, dim), static_cast<std::uint32_t>(clamped)) << f << " of " << dim;
    }
}

TEST(Cell, EveryFloatHasOne) {
    for (const std::uint32_t dim : {1u, 2u, 1000u, 4096u}) {
        for (const float f :
             {nan, -nan, -infinity, -1.0f, -0.0f, 0.0f, 0x1p-149f, -0x1p-149f, 0x1.fffffep-1f})
            EXPECT_EQ(sk_cell(f, dim), 0u) << f;
        for (const float f : {infinity, 3e38f, 4294967296.0f, static_cast<float>(dim)})
            EXPECT_EQ(sk_cell(f, dim), dim - 1) << f;
    }
    EXPECT_EQ(sk_cell(std::nextafter(1000.0f, 0.0f), 1000), 999u);
    EXPECT_EQ(sk_cell(1.0f, 1000), 1u);
    EXPECT_EQ(sk_cell(std::nextafter(1.0f, 0.0f), 1000), 0u);
}

TEST(Math, MinimumAndMaximumAreComparisons) {
    EXPECT_EQ(sk_min(1, 2), 1);
    EXPECT_EQ(sk_max(1, 2), 2);
    // Equal or not comparable: the first.
    EXPECT_TRUE(std::signbit(sk_min(-0.0f, 0.0f)));
    EXPECT_FALSE(std::signbit(sk_min(0.0f, -0.0f)));
    EXPECT_TRUE(std::signbit(sk_max(-0.0f, 0.0f)));
    EXPECT_TRUE(std::isnan(sk_min(nan, 1)));
    EXPECT_EQ(sk_min(1, nan), 1);
    EXPECT_TRUE(std::isnan(sk_max(nan, 1)));
    EXPECT_EQ(sk_max(1, nan), 1);
    EXPECT_EQ(sk_min_u32(0xffffffffu, 1), 1u);
    EXPECT_EQ(sk_max_u32(0xffffffffu, 1), 0xffffffffu);
}

TEST(Math, SignsAndKindsOfNumbers) {
    EXPECT_EQ(sk_abs(-2.5f), 2.5f);
    EXPECT_FALSE(std::signbit(sk_abs(-0.0f)));
    EXPECT_FALSE(std::signbit(sk_positive_zero(-0.0f)));
    EXPECT_FALSE(std::signbit(sk_positive_zero(0.0f)));
    EXPECT_EQ(sk_positive_zero(-0x1p-149f), -0x1p-149f);
    EXPECT_TRUE(std::isnan(sk_positive_zero(nan)));
    for (const float f : {0.0f, -0.0f, 1.0f, 0x1p-149f, 3.4e38f, -3.4e38f}) EXPECT_TRUE(sk_is_finite(f)) << f;
    for (const float f : {infinity, -infinity, nan, -nan}) EXPECT_FALSE(sk_is_finite(f)) << f;
}

TEST(Math, TransformedPointsAreCloseAndHoldNoNegativeZero) {
    Numbers number;
    for (int i = 0; i < 20000; ++i) {
        float m[12];
        std::generate(std::begin(m), std::end(m), [&] { return number(-4, 4); });
        const sk_vec3 p = sk_make3(number(-4, 4), number(-4, 4), number(-4, 4));
        const sk_vec3 q = sk_transform_point(m, p);
        const float found[3] = {q.x, q.y, q.z};
        for (int row = 0; row < 3; ++row) {
            const float* r = m + 4 * row;
            const double exact = double(r[0]) * p.x + double(r[1]) * p.y + double(r[2]) * p.z + r[3];
            const double size = std::fabs(double(r[0]) * p.x) + std::fabs(double(r[1]) * p.y) +
                                std::fabs(double(r[2]) * p.z) + std::fabs(r[3]);
            ASSERT_NEAR(found[row], exact, size * 0x1p-22);
        }
    }
    const float mirrored[12] = {-1, -1, -1, -0.0f, -2, -1, -1, -0.0f, -1, -3, -1, -0.0f};
    const sk_vec3 zero = sk_transform_point(mirrored, sk_make3(0, 0, 0));
    for (const float f : {zero.x, zero.y, zero.z}) EXPECT_EQ(std::bit_cast<std::uint32_t>(f), 0u);
}

TEST(Math, Vectors) {
    const sk_vec3 x = sk_make3(1, 0, 0), y = sk_make3(0, 1, 0), z = sk_cross3(x, y);
    EXPECT_EQ(z.z, 1);
    EXPECT_EQ(sk_dot3(sk_make3(1, 2, 3), sk_make3(4, 5, 6)), 32);
    EXPECT_EQ(sk_length(sk_make3(2, 3, 6)), 7);
    EXPECT_EQ(sk_largest(sk_make3(1, -5, 2)), 5);
    EXPECT_EQ(sk_unit(sk_make3(0, 0, 0)).x, 0) << "no direction, no change";
    EXPECT_NEAR(sk_length(sk_unit(sk_make3(1, 2, 3))), 1, 1e-6);
    EXPECT_EQ(sk_component(sk_make3(7, 8, 9), 2), 9);
}

TEST(Math, SegmentsAreFoundAsByBinarySearch) {
    Numbers number;
    std::vector<sk_u32> starts{0};
    for (int i = 0; i < 50; ++i) starts.push_back(starts.back() + 1 + number.below(9));
    for (sk_u32 value = 0; value < starts.back(); ++value) {
        const auto after = std::upper_bound(starts.begin(), starts.end(), value);
        EXPECT_EQ(sk_find_segment(starts.data(), 50, value), after - starts.begin() - 1) << value;
    }
}

}  // namespace
