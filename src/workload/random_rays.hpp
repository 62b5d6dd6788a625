// SPDX-License-Identifier: MIT
/// Which rays find mistakes? Random ones, ones along the axes through every special place, and ones aimed at
/// edges.
#pragma once

#include <cstdint>
#include <vector>

#include "setka/scene.hpp"

namespace setka::workload {

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers on every machine, from any seed.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    [[nodiscard]] std::uint64_t operator()();
    /// Uniform in [0, 1), 24 bits.
    [[nodiscard]] float unit();
    /// Uniform in [0, count).
    [[nodiscard]] std::uint32_t below(std::uint32_t count);

  private:
    std::uint64_t state_;
};

enum class RayKind { Random, AxisAligned, EdgeAimed };
inline constexpr std::size_t ray_kind_count = 3;
[[nodiscard]] const char* to_string(RayKind kind) noexcept;

/// Rays for a scene. Ray i is a function of scene, grid, seed and i alone, so that batches of any size see
/// the same rays.
class RandomRays {
  public:
    /// `scene` must outlive this and have a triangle; `header` is of a grid over it, for rays on the planes
    /// between cells.
    RandomRays(const Scene& scene, const SetkaGridHeader& header, std::uint64_t seed);

    [[nodiscard]] static RayKind kind(std::uint64_t index) noexcept {
        return RayKind(index % ray_kind_count);
    }
    [[nodiscard]] Ray operator()(std::uint64_t index) const;

  private:
    [[nodiscard]] Ray random_ray(Random& random) const;
    [[nodiscard]] Ray axis_ray(Random& random) const;
    [[nodiscard]] Ray edge_ray(Random& random) const;
    /// A point in the scene's box made `scale` times as large.
    [[nodiscard]] Float3 point_in_box(Random& random, float scale) const;
    struct WorldTriangle {
        Float3 vertices[3];
    };
    [[nodiscard]] WorldTriangle random_triangle(Random& random) const;

    const Scene& scene_;
    SetkaGridHeader header_;
    std::uint64_t seed_;
    Bounds bounds_;
    std::vector<std::uint64_t> starts_;  ///< the first scene triangle of each instance, then the total
};

}  // namespace setka::workload
