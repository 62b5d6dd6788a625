// SPDX-License-Identifier: MIT
/// What does Embree build and trace? A scene with the rays that setka traces, once both see the same.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/embree/embree_scene.hpp"
#include "bench/embree/ray_packets.hpp"
#include "bench/embree/thread_pool.hpp"
#include "bench/subject.hpp"

namespace setka::bench {

class EmbreeSubject final : public Fixture {
  public:
    /// Takes the rays and what they hit from a device of setka, where they are checked as those that are
    /// timed.
    EmbreeSubject(Target& target, const SceneCase& name, const LoadedScene& loaded, const Options& options,
                  Validator& validator);

    /// Builds the scene that the constructor had in this quality, and compares the hits of all rays with
    /// setka's; nothing if it is the one in use. Throws Mismatch, or OutOfMemory.
    void use(EmbreeQuality quality, const LoadedScene& loaded);

    [[nodiscard]] EmbreeScene& scene() noexcept { return *scene_; }
    [[nodiscard]] std::size_t thread_count() const noexcept { return pool_.size(); }
    [[nodiscard]] std::size_t ray_count(const TraceCase& what) const;
    void trace(const TraceCase& what);
    /// Of the rays of this case so many did not agree with setka's.
    [[nodiscard]] std::uint64_t disagreements(const TraceCase& what) const;

  private:
    struct Batch {
        Buffer<Ray> workload::StandardRays::*kind;
        std::vector<Hit> expected;
        std::unique_ptr<RayPackets> rays;
    };
    [[nodiscard]] const Batch& batch(const TraceCase& what) const;

    std::string name_;
    std::vector<Batch> batches_;
    ThreadPool pool_;
    std::optional<EmbreeQuality> quality_;  ///< of a scene that was checked
    std::optional<EmbreeScene> scene_;
    std::map<std::string, std::uint64_t> disagreements_;  ///< by the case's name
};

/// What Embree is told of the rays of a case.
[[nodiscard]] Coherence coherence(const TraceCase& what);

[[nodiscard]] const char* to_string(EmbreeQuality quality) noexcept;

}  // namespace setka::bench
