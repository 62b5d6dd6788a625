// SPDX-License-Identifier: MIT
/// Between what must answers be equal? Every device with each of its primitives, in pairs; what one of them
/// makes of a scene, and where two of them first differ.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "setka/setka.hpp"
#include "support/compare.hpp"

namespace support {

/// A device and how its scans and sorts are done, where it has more than one way.
struct Configuration {
    std::string name;  ///< "opencl_0_serial"
    std::string device_id;
    setka::DeviceOptions options;
};

/// Two for each device found: its library and the portable kernels, or the portable kernels in both shapes.
[[nodiscard]] const std::vector<Configuration>& configurations();

struct ConfigurationPair {
    Configuration first, second;
    [[nodiscard]] std::string name() const { return first.name + "__vs__" + second.name; }
};
inline void PrintTo(const ConfigurationPair& pair, std::ostream* out) { *out << pair.name(); }

/// Every two of them, each pair once.
[[nodiscard]] std::vector<ConfigurationPair> configuration_pairs();

/// A grid of one density and what rays hit in it.
struct GridAnswer {
    struct Traced {
        setka::GridStep step;
        std::vector<setka::Hit> hits;
        std::vector<std::uint32_t> occluded;
    };
    float density = 0;
    oracle::Tables tables;
    std::vector<Traced> traced;  ///< with each stepping rule
};

inline constexpr float pair_densities[] = {0.5f, 4.0f, 16.0f};

[[nodiscard]] GridAnswer grid_answer(const Configuration& configuration, const setka::Scene& scene,
                                     std::span<const setka::Ray> rays, float density);

/// Header, offsets, counts, lists, hits and occlusion bit for bit; else where the first of them differ.
[[nodiscard]] ::testing::AssertionResult same_answer(std::span<const setka::Ray> rays,
                                                     const GridAnswer& expected, const GridAnswer& actual);

/// A small picture of one kind.
struct Picture {
    std::string name;  ///< "shaded, DDA"
    setka::Image image;
};

/// The scene with a camera that sees all of it and lights, where it has none.
[[nodiscard]] setka::Scene framed(setka::Scene scene);

/// A framed scene: shaded and as cost, with both stepping rules.
[[nodiscard]] std::vector<Picture> pictures(const Configuration& configuration, const setka::Scene& scene);

/// Images bit for bit; else the first picture that differs, and where.
[[nodiscard]] ::testing::AssertionResult same_pictures(const std::vector<Picture>& expected,
                                                       const std::vector<Picture>& actual);

}  // namespace support
