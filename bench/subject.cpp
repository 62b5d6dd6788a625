// SPDX-License-Identifier: MIT
/// What is built and traced? See the header.
#include "bench/subject.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "backend/device.hpp"
#include "workload/fingerprint.hpp"

namespace setka::bench {

namespace {

/// The queries that no fingerprint covers: each ray has to be occluded exactly if it has a closest hit.
void check_queries(Queue& queue, const Grid& grid, const workload::StandardRays& rays, GridStep step,
                   const std::string& who) {
    const Tracer tracer({.step = step});
    for (const Buffer<Ray>* const batch : {&rays.shadow, &rays.diffuse}) {
        const auto device_hits = queue.make_buffer<Hit>(batch->size(), "hits");
        const auto device_flags = queue.make_buffer<std::uint32_t>(batch->size(), "occlusion flags");
        tracer.closest_hit(queue, grid, *batch, device_hits);
        tracer.any_hit(queue, grid, *batch, device_flags);
        const auto hits = queue.download(device_hits);
        const auto flags = queue.download(device_flags);
        const bool agree = std::ranges::equal(hits, flags, [](const Hit& hit, std::uint32_t flag) {
            return flag == (hit.primitive != SETKA_NO_HIT ? 1u : 0u);
        });
        if (!agree)
            throw Mismatch(who + ": closest hit and any hit disagree on the same rays; it is not timed");
    }
}

}  // namespace

Subject::Subject(Target& target, const SceneCase& name, const LoadedScene& loaded, const Options& options,
                 Validator& validator)
    : name_(name),
      view_(loaded.view),
      target_(target.name()),
      options_(options),
      validator_(validator),
      queue_(target.device().make_queue()),
      scene_(queue_, loaded.scene) {
    use_density(golden_density);
    rays_ = workload::standard_rays(queue_, *grid_, view_, options.size);
    if (queue_.device().impl()->width() > 1)
        shadow_picture_ = queue_.upload(
            std::span<const Ray>(workload::in_places(queue_.download(rays_.shadow), rays_.pixels, rays_.primary.size())), "shadow rays");
    hits_ = queue_.make_buffer<Hit>(rays_.primary.size(), "hits");
    flags_ = queue_.make_buffer<std::uint32_t>(rays_.primary.size(), "occlusion flags");
    check_picture();
}

void Subject::use_density(float density) {
    if (density_ == density) return;
    density_.reset();
    costs_.clear();
    validate(density);
    density_ = density;
}

void Subject::validate(float density) {
    builder_ = make_grid_builder({.density = density});
    rebuild();
    const Digest tables = grid_->digest(queue_);
    const auto rays = workload::standard_rays(queue_, *grid_, view_, workload::fingerprint_rays_size);
    for (const GridStep step : options_.steps) {
        const std::string who = target_ + ", step " + to_string(step);
        const workload::Results results = workload::take_results(queue_, scene_, *grid_, view_, rays, step);
        validator_.check(name_, density, workload::fingerprint(tables, results), who);
        check_queries(queue_, *grid_, rays, step, name_.to_string() + " on " + who);
    }
}

void Subject::rebuild() {
    grid_.reset();
    grid_ = builder_->build(queue_, scene_);
}

void Subject::trace(const TraceCase& what, GridStep step) {
    const Tracer tracer({.step = step});
    if (what.query == Query::Closest) tracer.closest_hit(queue_, *grid_, batch(what), hits_);
    else tracer.any_hit(queue_, *grid_, batch(what), flags_);
}

RayBatch Subject::batch(const TraceCase& what) const {
    if (what.is_shadow() && !shadow_picture_.empty()) return {shadow_picture_, {}, options_.size};
    return {rays_.*what.rays, {}, what.is_primary() ? options_.size : 0};
}

void Subject::check_picture() {
    if (shadow_picture_.empty()) return;
    const Tracer tracer;
    const RayBatch picture(shadow_picture_, {}, options_.size);
    tracer.closest_hit(queue_, *grid_, picture, hits_);
    tracer.any_hit(queue_, *grid_, picture, flags_);
    const auto hits = queue_.download(hits_);
    const auto flags = queue_.download(flags_);
    tracer.closest_hit(queue_, *grid_, rays_.shadow, hits_);
    tracer.any_hit(queue_, *grid_, rays_.shadow, flags_);
    const auto expected_hits = queue_.download(hits_);
    const auto expected_flags = queue_.download(flags_);
    for (std::size_t i = 0; i < rays_.pixels.size(); ++i) {
        const std::uint32_t pixel = rays_.pixels[i];
        if (std::memcmp(&hits[pixel], &expected_hits[i], sizeof(Hit)) != 0 || flags[pixel] != expected_flags[i])
            throw Mismatch(name_.to_string() + " on " + target_ + ": the shadow ray of pixel " + std::to_string(pixel) +
                           " has another result as one of a picture than alone; it is not timed");
    }
}

const MeanCost& Subject::cost(const TraceCase& what, GridStep step) {
    const auto [entry, is_new] = costs_.try_emplace({what.name, step});
    if (!is_new) return entry->second;
    const Buffer<Ray>& batch = rays_.*what.rays;
    const auto device_costs = queue_.make_buffer<TraceCost>(batch.size(), "costs");
    Tracer({.step = step}).closest_hit_cost(queue_, *grid_, batch, device_costs);
    MeanCost& mean = entry->second;
    for (const TraceCost& cost : queue_.download(device_costs)) {
        mean.cells += cost.steps;
        mean.tests += cost.tests;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(batch.size(), 1));
    mean = {mean.cells / count, mean.tests / count};
    return mean;
}

}  // namespace setka::bench
