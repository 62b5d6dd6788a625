// SPDX-License-Identifier: MIT
// The dialect's translation for the host comes before every file in it.
#include "device/host_platform.h"
// The dialect.
#include "device/root.h"

#include "core/exact_math.hpp"

namespace setka::exact {

double power(double x, unsigned exponent) noexcept { return sk_power(x, exponent); }

double root(double x, unsigned n) noexcept { return sk_root(x, n); }

}  // namespace setka::exact
