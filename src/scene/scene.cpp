// SPDX-License-Identifier: MIT
/// Is this scene usable, how large is it, and how do two become one? Host-side questions about plain values.
#include "setka/scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "scene/checks.hpp"
#include "scene/transform.hpp"
#include "scene/vector.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

void check(const Instance& instance, std::size_t index, const Scene& scene) {
    if (instance.mesh >= scene.meshes.size())
        fail(ErrorCategory::InvalidData, "instance ", index, ": ", absence("mesh", instance.mesh, scene.meshes.size()));
    if (instance.material >= scene.materials.size())
        fail(ErrorCategory::InvalidData, "instance ", index, ": ",
             absence("material", instance.material, scene.materials.size()));
    if (!is_finite(instance.transform))
        fail(ErrorCategory::InvalidData, "instance ", index, ": its transform is not finite");
}

/// The positions that triangles use, each once: files hold stray ones, which must not move a box.
[[nodiscard]] std::vector<Float3> used_positions(const Mesh& mesh) {
    std::vector<bool> is_used(mesh.positions.size());
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t index : {t.a, t.b, t.c})
            if (index < is_used.size()) is_used[index] = true;
    std::vector<Float3> used;
    for (std::size_t i = 0; i < is_used.size(); ++i)
        if (is_used[i]) used.push_back(mesh.positions[i]);
    return used;
}

/// Moves the elements of `source` to the end of `target`.
template <typename T>
void move_to_end(std::vector<T>& target, std::vector<T>& source) {
    target.insert(target.end(), std::make_move_iterator(source.begin()),
                  std::make_move_iterator(source.end()));
}

}  // namespace

std::uint64_t Scene::triangle_count() const noexcept {
    std::uint64_t count = 0;
    for (const Instance& instance : instances)
        if (instance.mesh < meshes.size()) count += meshes[instance.mesh].triangles.size();
    return count;
}

Bounds Scene::bounds() const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Bounds box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    std::vector<std::vector<Float3>> used(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) used[i] = used_positions(meshes[i]);
    for (const Instance& instance : instances) {
        if (instance.mesh >= meshes.size()) continue;
        for (const Float3& position : used[instance.mesh]) {
            const Float3 p = transform_point(instance.transform, position);
            const float values[3] = {p.x, p.y, p.z};
            for (int axis = 0; axis < 3; ++axis) {
                if (values[axis] < box.lower[axis]) box.lower[axis] = values[axis];
                if (values[axis] > box.upper[axis]) box.upper[axis] = values[axis];
            }
        }
    }
    return box;
}

void Scene::validate() const {
    for (std::size_t i = 0; i < meshes.size(); ++i) check(meshes[i], i);
    for (std::size_t i = 0; i < materials.size(); ++i) check(materials[i], i);
    for (std::size_t i = 0; i < instances.size(); ++i) check(instances[i], i, *this);
    for (std::size_t i = 0; i < point_lights.size(); ++i) check(point_lights[i], i);
    for (std::size_t i = 0; i < directional_lights.size(); ++i) check(directional_lights[i], i);
    if (camera) check(*camera);
    check(background);
    if (triangle_count() == 0) fail(ErrorCategory::InvalidData, "the scene has no triangle");
}

void append(Scene& target, Scene source) {
    const auto first_mesh = static_cast<std::uint32_t>(target.meshes.size());
    const auto first_material = static_cast<std::uint32_t>(target.materials.size());
    for (Instance& instance : source.instances) {
        instance.mesh += first_mesh;
        instance.material += first_material;
    }
    move_to_end(target.meshes, source.meshes);
    move_to_end(target.instances, source.instances);
    move_to_end(target.materials, source.materials);
    move_to_end(target.point_lights, source.point_lights);
    move_to_end(target.directional_lights, source.directional_lights);
    if (!target.camera) target.camera = source.camera;
}

}  // namespace setka
