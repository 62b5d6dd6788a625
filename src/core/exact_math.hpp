// SPDX-License-Identifier: MIT
/// How does the host calculate roots and angles that end up in a table or a picture? From + - * / and sqrt on doubles only,
/// which round alike everywhere; the C library's cbrt, sin and pow differ between machines. Errors are below 1e-14, relative.
#pragma once

#include <cmath>
#include <cstdint>

namespace setka::exact {

inline constexpr double pi = 3.14159265358979323846;

/// x to a small power by repeated multiplication.
[[nodiscard]] double power(double x, unsigned exponent) noexcept;

/// The n-th root of x >= 0 for a small n: what kernels compute (device/root.h).
[[nodiscard]] double root(double x, unsigned n) noexcept;

[[nodiscard]] inline double cbrt(double x) noexcept { return x < 0 ? -root(-x, 3) : root(x, 3); }

struct SinCos {
    double sin, cos;
};

/// Sine and cosine for |x| up to a few thousand: reduction by pi/2 in two parts, then Taylor series on [-pi/4, pi/4].
[[nodiscard]] inline SinCos sin_cos(double x) noexcept {
    constexpr double half_pi_high = 1.57079632673412561417e+00;  // 33 bits, so that multiples are exact
    constexpr double half_pi_low = 6.07710050650619224932e-11;
    const double quadrant = std::floor(x / (pi / 2) + 0.5);
    const double r = (x - quadrant * half_pi_high) - quadrant * half_pi_low;
    const double r2 = r * r;
    double s = 1, c = 1;
    for (int k = 11; k >= 1; --k) {
        s = 1 - s * r2 / ((2.0 * k) * (2.0 * k + 1));
        c = 1 - c * r2 / ((2.0 * k - 1) * (2.0 * k));
    }
    s *= r;
    switch (static_cast<std::int64_t>(quadrant) & 3) {
        case 0: return {s, c};
        case 1: return {c, -s};
        case 2: return {-s, -c};
        default: return {-c, s};
    }
}

[[nodiscard]] inline double tan(double x) noexcept {
    const SinCos sc = sin_cos(x);
    return sc.sin / sc.cos;
}

/// The sRGB transfer function from an encoded value in [0, 1] to linear light (IEC 61966-2-1): x to 2.4 as (x^12)^(1/5).
[[nodiscard]] inline double srgb_to_linear(double encoded) noexcept {
    return encoded <= 0.04045 ? encoded / 12.92 : root(power((encoded + 0.055) / 1.055, 12), 5);
}

}  // namespace setka::exact
