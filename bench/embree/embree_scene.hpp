// SPDX-License-Identifier: MIT
/// What does Embree build? One indexed mesh of all triangles of a scene, in world space, and a tree over it.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "bench/embree.hpp"
#include "setka/scene.hpp"

namespace setka::bench {

/// Bytes that Embree holds now, and the most since the last reset. Embree's threads report them.
class MemoryMonitor {
  public:
    void add(std::int64_t bytes) noexcept;
    void reset_peak() noexcept { peak_ = in_use_.load(); }
    [[nodiscard]] std::uint64_t in_use_bytes() const noexcept { return std::uint64_t(in_use_.load()); }
    [[nodiscard]] std::uint64_t peak_bytes() const noexcept { return std::uint64_t(peak_.load()); }

  private:
    std::atomic<std::int64_t> in_use_{0}, peak_{0};
};

class EmbreeScene {
  public:
    /// Builds the tree once over a mesh of which every vertex is elsewhere, moves the vertices to where they
    /// belong, and rebuilds: a rebuild that did not see what moved would give hits that are wrong.
    EmbreeScene(const Scene& scene, EmbreeQuality quality);

    /// What a frame needs in which every vertex may have moved.
    void rebuild();

    [[nodiscard]] RTCScene handle() const noexcept { return scene_.get(); }
    [[nodiscard]] std::uint64_t triangle_count() const noexcept { return triangle_count_; }
    /// Vertices, indices and the tree.
    [[nodiscard]] MemoryMonitor& memory() noexcept { return *memory_; }

  private:
    void check(const char* call) const;
    [[nodiscard]] float* set_mesh(const Scene& scene);

    template <auto release>
    struct Release {
        template <typename T>
        void operator()(T* handle) const noexcept {
            release(handle);
        }
    };
    template <typename Handle, auto release>
    using Owner = std::unique_ptr<std::remove_pointer_t<Handle>, Release<release>>;

    std::unique_ptr<MemoryMonitor> memory_ = std::make_unique<MemoryMonitor>();
    std::uint64_t triangle_count_ = 0, vertex_count_ = 0;
    Owner<RTCDevice, rtcReleaseDevice> device_;
    Owner<RTCGeometry, rtcReleaseGeometry> geometry_;
    Owner<RTCScene, rtcReleaseScene> scene_;
};

}  // namespace setka::bench
