// SPDX-License-Identifier: MIT
/// How are rays handed to Embree? Eight at a time, in packets that are laid out before anything is timed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/embree/embree_scene.hpp"
#include "bench/embree/thread_pool.hpp"
#include "setka/scene.hpp"

namespace setka::bench {

/// What Embree is told of the rays of a packet: it then walks the tree with all of them, or with each.
enum class Coherence { Coherent, Incoherent };

/// A batch of rays, in order, with room for the results.
class RayPackets {
  public:
    RayPackets(std::span<const Ray> rays, Coherence coherence);

    [[nodiscard]] std::size_t size() const noexcept { return ray_count_; }
    void closest_hit(const EmbreeScene& scene, ThreadPool& pool);
    void any_hit(const EmbreeScene& scene, ThreadPool& pool);

    /// What the last closest_hit() found; the primitive is the scene triangle, the instance 0.
    [[nodiscard]] std::vector<Hit> hits() const;
    /// What the last any_hit() found: 1 where occluded, else 0.
    [[nodiscard]] std::vector<std::uint32_t> flags() const;

  private:
    static constexpr std::size_t width = 8;

    /// Rows of RTCRay8, without those that are the same for all rays.
    struct alignas(32) Rays {
        float origin[3][width], tmin[width], direction[3][width], tmax[width];
    };
    /// Rows of RTCRayHit8 that make a setka::Hit.
    struct alignas(32) Hits {
        float t[width], u[width], v[width];
        std::uint32_t primitive[width], geometry[width];
    };
    /// Row tfar of RTCRay8.
    struct alignas(32) Ends {
        float t[width];
    };

    template <typename Body>
    void for_each_packet(ThreadPool& pool, const Body& body);
    static void load(const Rays& source, RTCRay8& target);

    std::size_t ray_count_;
    Coherence coherence_;
    std::vector<Rays> rays_;
    std::vector<Hits> hits_;
    std::vector<Ends> ends_;
};

}  // namespace setka::bench
