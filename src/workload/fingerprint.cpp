// SPDX-License-Identifier: MIT
/// Did a device compute the right thing? See the header.
#include "workload/fingerprint.hpp"

#include "core/digest.hpp"
#include "setka/renderer.hpp"

namespace setka::workload {

namespace {

template <typename... Vectors>
[[nodiscard]] Digest digest_of(const Vectors&... vectors) {
    Digester digester;
    (digester.add(vectors), ...);
    return digester.digest();
}

}  // namespace

std::array<std::pair<const char*, Digest>, 5> Fingerprint::parts() const {
    return {{{"tables", tables}, {"primary", primary}, {"shadow", shadow}, {"diffuse", diffuse}, {"picture", picture}}};
}

Results take_results(Queue& queue, const DeviceScene& lit, const Grid& grid, const StandardView& view,
                     const StandardRays& rays, GridStep step) {
    const TraceOptions trace{.step = step};
    const Tracer tracer(trace);
    const auto closest = [&](const Buffer<Ray>& batch) {
        const auto hits = queue.make_buffer<Hit>(batch.size(), "hits");
        tracer.closest_hit(queue, grid, batch, hits);
        return queue.download(hits);
    };
    Results results;
    results.primary = closest(rays.primary);
    results.diffuse = closest(rays.diffuse);
    const auto occluded = queue.make_buffer<std::uint32_t>(rays.shadow.size(), "occlusion flags");
    tracer.any_hit(queue, grid, rays.shadow, occluded);
    results.shadow = queue.download(occluded);
    RenderOptions options;
    options.width = fingerprint_width;
    options.height = fingerprint_height;
    options.trace = trace;
    results.picture = Renderer(options).render(queue, lit, grid, view.camera);
    return results;
}

Fingerprint fingerprint(const Digest& tables, const Results& results) {
    return {tables, digest_of(results.primary), digest_of(results.shadow), digest_of(results.diffuse),
            digest_of(results.picture.linear, results.picture.srgb)};
}

Fingerprint take_fingerprint(Queue& queue, Scene scene, Viewpoint viewpoint, const GridOptions& options, GridStep step) {
    const StandardView view = standard_view(scene.bounds(), viewpoint);
    if (scene.point_lights.empty() && scene.directional_lights.empty()) add_default_lights(scene, view.camera);
    const DeviceScene lit(queue, scene);
    scene = {};  // a large scene need not stand in the host's memory twice
    const Grid grid = make_grid_builder(options)->build(queue, lit);
    const StandardRays rays = standard_rays(queue, grid, view, fingerprint_rays_size);
    return fingerprint(grid.digest(queue), take_results(queue, lit, grid, view, rays, step));
}

}  // namespace setka::workload
