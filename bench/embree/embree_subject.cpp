// SPDX-License-Identifier: MIT
/// What does Embree build and trace? See the header.
#include "bench/embree/embree_subject.hpp"

#if defined(__SSE__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <thread>

#include "bench/agreement.hpp"

namespace setka::bench {

namespace {

/// As Embree's manual asks of threads that trace. Those of the pool do nothing else.
void flush_denormals() {
#if defined(__SSE__)
    constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
    _mm_setcsr(_mm_getcsr() | flush_to_zero | denormals_are_zero);
#endif
}

[[nodiscard]] Coherence coherence(Buffer<Ray> workload::StandardRays::*kind) {
    return kind == &workload::StandardRays::diffuse ? Coherence::Incoherent : Coherence::Coherent;
}

/// The rays of a square picture in tiles of four columns and `width` rays, one tile after the other: packets as setka's own, of such rays
/// (RayBatch::row_length). Where there is none, the next one moves up, so that no packet has gaps.
[[nodiscard]] std::vector<Ray> in_tiles(const std::vector<Ray>& picture, std::uint32_t size, std::size_t width) {
    const auto rows = static_cast<std::uint32_t>(width / 4);
    std::vector<Ray> tiles;
    tiles.reserve(picture.size());
    for (std::uint32_t top = 0; top < size; top += rows)
        for (std::uint32_t left = 0; left < size; left += 4)
            for (std::uint32_t y = top; y < std::min(top + rows, size); ++y)
                for (std::uint32_t x = left; x < std::min(left + 4, size); ++x)
                    if (const Ray& ray = picture[std::size_t(y) * size + x]; ray.tmin <= ray.tmax) tiles.push_back(ray);
    return tiles;
}

}  // namespace

EmbreeSubject::EmbreeSubject(Target& target, const SceneCase& name, const LoadedScene& loaded,
                             const Options& options, Validator& validator)
    : name_(name.to_string()), pool_(std::max(1u, std::thread::hardware_concurrency()), flush_denormals) {
    Subject reference(target, name, loaded, options, validator);
    Queue& queue = reference.queue();
    const std::size_t width = packet_width();
    for (const auto kind : {&workload::StandardRays::primary, &workload::StandardRays::shadow,
                            &workload::StandardRays::diffuse}) {
        std::vector<Ray> rays = queue.download(reference.rays().*kind);
        if (kind == &workload::StandardRays::shadow)
            rays = workload::in_places(rays, reference.rays().pixels, reference.rays().primary.size());
        if (coherence(kind) == Coherence::Coherent) rays = in_tiles(rays, options.size, width);
        batches_.push_back({kind, Tracer().closest_hit(queue, reference.grid(), rays),
                            make_ray_packets(rays, coherence(kind), width)});
    }
}

void EmbreeSubject::use(EmbreeQuality quality, const LoadedScene& loaded) {
    if (quality_ == quality) return;
    quality_.reset();
    scene_.reset();  // before there is another
    scene_.emplace(loaded.scene, quality);
    for (const TraceCase& what : trace_cases) {
        trace(what);
        const auto& [kind, expected, rays] = batch(what);
        const std::uint64_t differing = what.query == Query::Closest
                                            ? count_disagreements(expected, rays->hits())
                                            : count_disagreements(expected, rays->flags());
        require_agreement(differing, rays->size(),
                          name_ + " on embree/" + to_string(quality) + ", rays " + what.name);
        disagreements_[what.name] = differing;
    }
    quality_ = quality;
}

const EmbreeSubject::Batch& EmbreeSubject::batch(const TraceCase& what) const {
    return *std::ranges::find(batches_, what.rays, &Batch::kind);
}

std::size_t EmbreeSubject::ray_count(const TraceCase& what) const { return batch(what).rays->size(); }

void EmbreeSubject::trace(const TraceCase& what) {
    RayPackets& rays = *batch(what).rays;
    if (what.query == Query::Closest) rays.closest_hit(*scene_, pool_);
    else rays.any_hit(*scene_, pool_);
}

std::uint64_t EmbreeSubject::disagreements(const TraceCase& what) const {
    return disagreements_.at(what.name);
}

Coherence coherence(const TraceCase& what) { return coherence(what.rays); }

const char* to_string(EmbreeQuality quality) noexcept {
    return quality == EmbreeQuality::Low ? "low" : "medium";
}

}  // namespace setka::bench
