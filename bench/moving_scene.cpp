// SPDX-License-Identifier: MIT
#include "bench/moving_scene.hpp"

#include "bench/validation.hpp"
#include "setka/structure.hpp"
#include "workload/measure.hpp"

namespace setka::bench {

namespace {

/// A turn of about 0.02 * step about the vertical axis, before the instance's own transform.
[[nodiscard]] Matrix34 turned(const Matrix34& place, std::uint32_t step) {
    const float t = 0.01f * float(step % 100), cosine = (1 - t * t) / (1 + t * t), sine = 2 * t / (1 + t * t);
    Matrix34 result = place;
    for (std::size_t row = 0; row < 12; row += 4) {
        const float x = place.rows[row], z = place.rows[row + 2];
        result.rows[row] = x * cosine - z * sine;
        result.rows[row + 2] = x * sine + z * cosine;
    }
    return result;
}

[[nodiscard]] std::vector<Matrix34> places_of(const Scene& scene) {
    std::vector<Matrix34> places;
    for (const Instance& instance : scene.instances) places.push_back(instance.transform);
    return places;
}

/// Vertices of each mesh, a little closer to its origin.
[[nodiscard]] std::vector<std::vector<Float3>> shrunk(const Scene& scene) {
    std::vector<std::vector<Float3>> meshes;
    for (const Mesh& mesh : scene.meshes) {
        meshes.push_back(mesh.positions);
        for (Float3& p : meshes.back()) p = {p.x * 0.96875f, p.y * 0.96875f, p.z * 0.96875f};
    }
    return meshes;
}

/// The scene with the standard view's light alone: one shadow ray for each point of a surface.
[[nodiscard]] Scene with_one_light(const LoadedScene& loaded) {
    Scene scene = loaded.scene;
    scene.directional_lights.clear();
    scene.point_lights = {{.position = loaded.view.light}};
    return scene;
}

}  // namespace

MovingScene::MovingScene(Target& target, const SceneCase& name, const LoadedScene& loaded, const Options& options)
    : queue_(target.device().make_queue()),
      host_(with_one_light(loaded)),
      places_(places_of(host_)),
      smaller_(shrunk(host_)),
      scene_(queue_, host_),
      camera_(loaded.view.camera),
      builder_(make_grid_builder({.density = options.densities.front()})),
      renderer_({.width = options.picture_width, .height = options.picture_height, .max_depth = 0, .pixels = Pixels::Srgb}) {
    for (const Motion motion : {Motion::Instances, Motion::Vertices})
        check(motion, name.to_string() + " on " + target.name());
}

void MovingScene::edit(Motion motion) {
    ++frame_;
    for (std::uint32_t i = 0; i < places_.size(); ++i) {
        host_.instances[i].transform = turned(places_[i], frame_);
        scene_.set_transform(i, host_.instances[i].transform);
    }
    if (motion == Motion::Vertices) {
        for (std::uint32_t i = 0; i < host_.meshes.size(); ++i)
            scene_.set_vertices(queue_, i, frame_ % 2 == 0 ? host_.meshes[i].positions : smaller_[i]);
    }
    scene_.commit(queue_);
}

FrameParts MovingScene::frame(Motion motion) {
    FrameParts parts;
    const workload::Stopwatch upload;
    edit(motion);
    parts.upload_ms = upload.elapsed_ms();
    const workload::Stopwatch build;
    const Grid grid = builder_->build(queue_, scene_);
    parts.build_ms = build.elapsed_ms();
    const workload::Stopwatch picture;
    picture_ = renderer_.render(queue_, scene_, grid, camera_);
    parts.picture_ms = picture.elapsed_ms();
    return parts;
}

void MovingScene::check(Motion motion, const std::string& who) {
    if (motion == Motion::Vertices && frame_ % 2 == 1) (void)frame(motion);  // so that they are the small ones
    (void)frame(motion);
    Scene now = host_;
    for (std::uint32_t i = 0; i < now.meshes.size() && motion == Motion::Vertices; ++i)
        now.meshes[i].positions = smaller_[i];
    const DeviceScene fresh(queue_, now);
    const Grid edited_grid = builder_->build(queue_, scene_), fresh_grid = builder_->build(queue_, fresh);
    if (edited_grid.digest(queue_) != fresh_grid.digest(queue_))
        throw Mismatch(who + ": an edited scene and a fresh one have different grids; it is not timed");
    if (Renderer(renderer_).render(queue_, fresh, fresh_grid, camera_).srgb != picture_.srgb)
        throw Mismatch(who + ": an edited scene and a fresh one give different pictures; it is not timed");
}

}  // namespace setka::bench
