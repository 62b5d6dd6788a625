// SPDX-License-Identifier: MIT
/// Do the host's roots and angles agree with the C library's to 1e-13, relative?
#include <gtest/gtest.h>

#include <cmath>

#include "core/exact_math.hpp"

namespace {

namespace exact = setka::exact;

void expect_close(double actual, double expected, double x) {
    EXPECT_LE(std::fabs(actual - expected), 1e-13 * std::fabs(expected))
        << "at " << x << ": " << actual << " instead of " << expected;
}

TEST(ExactMath, Powers) {
    EXPECT_EQ(exact::power(3, 0), 1);
    EXPECT_EQ(exact::power(3, 1), 3);
    EXPECT_EQ(exact::power(3, 5), 243);
    EXPECT_EQ(exact::power(-2, 3), -8);
    EXPECT_EQ(exact::power(0, 0), 1);
    for (double x = 0.01; x < 3; x += 0.0101) expect_close(exact::power(x, 12), std::pow(x, 12), x);
}

TEST(ExactMath, Roots) {
    for (int exponent = -300; exponent <= 300; ++exponent)
        for (const double factor : {1.0, 1.0000001, 1.2, 2.5, 3.999, 7.7}) {
            const double x = factor * std::pow(10.0, exponent);
            expect_close(exact::root(x, 1), x, x);
            expect_close(exact::root(x, 2), std::sqrt(x), x);
            expect_close(exact::root(x, 3), std::cbrt(x), x);
            expect_close(exact::root(x, 5), std::exp2(std::log2(x) / 5), x);
            expect_close(exact::cbrt(-x), std::cbrt(-x), -x);
        }
}

TEST(ExactMath, RootsOfPowersAreExact) {
    for (int k = 1; k <= 200; ++k) {
        const double x = k;
        EXPECT_EQ(exact::root(x * x, 2), x);
        EXPECT_EQ(exact::root(x * x * x, 3), x);
    }
    for (int k = -100; k <= 100; ++k) EXPECT_EQ(exact::root(std::ldexp(1.0, 3 * k), 3), std::ldexp(1.0, k));
}

TEST(ExactMath, RootsOfNothing) {
    EXPECT_EQ(exact::root(0, 3), 0);
    EXPECT_EQ(exact::root(-1, 2), 0);
    EXPECT_EQ(exact::cbrt(0), 0);
}

TEST(ExactMath, Angles) {
    for (double x = -1000; x < 1000; x += 0.1234567) {
        const auto [sine, cosine] = exact::sin_cos(x);
        // Near a zero, what counts is the error against 1.
        EXPECT_NEAR(sine, std::sin(x), 1e-13 * std::max(std::fabs(std::sin(x)), 1e-2)) << x;
        EXPECT_NEAR(cosine, std::cos(x), 1e-13 * std::max(std::fabs(std::cos(x)), 1e-2)) << x;
        EXPECT_NEAR(sine * sine + cosine * cosine, 1, 1e-14) << x;
    }
    EXPECT_EQ(exact::sin_cos(0).sin, 0);
    EXPECT_EQ(exact::sin_cos(0).cos, 1);
}

TEST(ExactMath, Tangents) {
    for (double x = -1.55; x < 1.55; x += 0.00123) expect_close(exact::tan(x), std::tan(x), x);
}

TEST(ExactMath, TransferFunction) {
    EXPECT_EQ(exact::srgb_to_linear(0), 0);
    EXPECT_NEAR(exact::srgb_to_linear(1), 1, 1e-15);
    for (double x = 0; x <= 1; x += 1.0 / 1024)
        expect_close(exact::srgb_to_linear(x), x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4),
                     x);
}

}  // namespace
