// SPDX-License-Identifier: MIT
/// Which random numbers? The same on every machine: SplitMix64 (Steele, Lea & Flood 2014), without the
/// standard's distributions.
#pragma once

#include <cstdint>

namespace support {

class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint32_t below(std::uint64_t limit) { return static_cast<std::uint32_t>(bits() % limit); }
    /// In [0, 1).
    float unit() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
    float between(float lower, float upper) { return lower + (upper - lower) * unit(); }

  private:
    std::uint64_t state_;
};

}  // namespace support
