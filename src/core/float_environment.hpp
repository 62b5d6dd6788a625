// SPDX-License-Identifier: MIT
/// What if somebody else in the process has changed how floats round? A scope in which the host computes as
/// IEEE 754 says: rounding to nearest, subnormals kept. A library compiled for fast arithmetic may flush them
/// for a whole thread.
#pragma once

#include <cfenv>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace setka {

/// Sets the default environment of this thread; its destructor puts back what was there. Call what is to be
/// computed through a function that is not inlined: compilers know nothing of the environment.
class FloatEnvironment {
  public:
    FloatEnvironment() {
#if defined(__SSE2__)
        control_ = _mm_getcsr();
#endif
        std::fegetenv(&before_);
        std::fesetenv(FE_DFL_ENV);
#if defined(__SSE2__)
        // Every exception masked, to nearest, neither FTZ nor DAZ: not every C library's default environment
        // clears those two.
        _mm_setcsr(0x1f80);
#endif
    }
    ~FloatEnvironment() {
        std::fesetenv(&before_);
#if defined(__SSE2__)
        _mm_setcsr(control_);
#endif
    }
    FloatEnvironment(const FloatEnvironment&) = delete;
    FloatEnvironment& operator=(const FloatEnvironment&) = delete;

  private:
    std::fenv_t before_;
#if defined(__SSE2__)
    unsigned control_;
#endif
};

}  // namespace setka
