// SPDX-License-Identifier: MIT
/// How are rays handed to Embree? In packets of as many as it has registers for, which are laid out before anything is timed.
#pragma once

#include <cstdint>
#include <memory>
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
    RayPackets() = default;
    virtual ~RayPackets() = default;
    RayPackets(const RayPackets&) = delete;
    RayPackets& operator=(const RayPackets&) = delete;

    [[nodiscard]] virtual std::size_t size() const noexcept = 0;
    virtual void closest_hit(const EmbreeScene& scene, ThreadPool& pool) = 0;
    virtual void any_hit(const EmbreeScene& scene, ThreadPool& pool) = 0;

    /// What the last closest_hit() found; the primitive is the scene triangle, the instance 0.
    [[nodiscard]] virtual std::vector<Hit> hits() const = 0;
    /// What the last any_hit() found: 1 where occluded, else 0.
    [[nodiscard]] virtual std::vector<std::uint32_t> flags() const = 0;
};

/// The rays of a packet: 16 where Embree says that the processor has registers for them, else 8.
[[nodiscard]] std::size_t packet_width();

/// `width` is 8 or 16.
[[nodiscard]] std::unique_ptr<RayPackets> make_ray_packets(std::span<const Ray> rays, Coherence coherence,
                                                           std::size_t width);

}  // namespace setka::bench
