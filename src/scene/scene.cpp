// SPDX-License-Identifier: MIT
/// Is this scene usable, how large is it, and how do two become one? Host-side questions about plain values.
#include "setka/scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>

#include "scene/transform.hpp"
#include "scene/vector.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

template <typename... Ts>
[[noreturn]] void fail(const Ts&... parts) {
    std::ostringstream message;
    (message << ... << parts);
    throw Error(ErrorCategory::InvalidData, message.str());
}

[[nodiscard]] bool is_finite(const Float3& v) noexcept {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// "mesh 3 'wheel'", or without a name "mesh 3".
template <typename T>
[[nodiscard]] std::string label(const char* kind, std::size_t index, const T& item) {
    const std::string text = std::string(kind) + ' ' + std::to_string(index);
    return item.name.empty() ? text : text + " '" + item.name + '\'';
}

void validate(const Mesh& mesh, std::size_t index) {
    const auto find_non_finite = [](const std::vector<Float3>& list) {
        return std::size_t(std::ranges::find_if_not(list, is_finite) - list.begin());
    };
    if (mesh.positions.size() > std::numeric_limits<std::uint32_t>::max())
        fail(label("mesh", index, mesh), ": ", mesh.positions.size(), " positions are more than 2^32 - 1");
    if (const std::size_t i = find_non_finite(mesh.positions); i < mesh.positions.size())
        fail(label("mesh", index, mesh), ": position ", i, " is not finite");
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
        fail(label("mesh", index, mesh), ": ", mesh.normals.size(), " normals for ", mesh.positions.size(),
             " positions; one each or none is accepted");
    if (const std::size_t i = find_non_finite(mesh.normals); i < mesh.normals.size())
        fail(label("mesh", index, mesh), ": normal ", i, " is not finite");
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const std::uint32_t largest = std::max({t.a, t.b, t.c});
        if (largest >= mesh.positions.size())
            fail(label("mesh", index, mesh), ": triangle ", i, " uses vertex ", largest, " of ",
                 mesh.positions.size());
    }
}

void validate(const Instance& instance, std::size_t index, const Scene& scene) {
    if (instance.mesh >= scene.meshes.size())
        fail("instance ", index, ": mesh ", instance.mesh, " does not exist; there are ",
             scene.meshes.size());
    if (instance.material >= scene.materials.size())
        fail("instance ", index, ": material ", instance.material, " does not exist; there are ",
             scene.materials.size());
    if (!std::ranges::all_of(instance.transform.rows, [](float value) { return std::isfinite(value); }))
        fail("instance ", index, ": its transform is not finite");
}

void validate(const Material& material, std::size_t index) {
    const auto require = [&](bool holds, const char* member, float value, const char* accepted) {
        if (!holds)
            fail(label("material", index, material), ": ", member, " = ", value, "; accepted is ", accepted);
    };
    const auto is_share = [](float value) { return value >= 0 && value <= 1; };
    if (!is_finite(material.diffuse) || !is_finite(material.specular) || !is_finite(material.emission) ||
        !is_finite(material.transmission))
        fail(label("material", index, material), ": a colour is not finite");
    require(material.shininess >= 1 && material.shininess <= 65536, "shininess", material.shininess,
            "1 to 65536");
    require(is_share(material.reflectivity), "reflectivity", material.reflectivity, "0 to 1");
    require(is_share(material.transparency), "transparency", material.transparency, "0 to 1");
    require(material.refractive_index > 0 && std::isfinite(material.refractive_index), "refractive_index",
            material.refractive_index, "a positive number");
}

void validate(const PointLight& light, std::size_t index) {
    if (!is_finite(light.position) || !is_finite(light.intensity))
        fail("point light ", index, ": its position or intensity is not finite");
    if (!(light.reference_distance >= 0) || !std::isfinite(light.reference_distance))
        fail("point light ", index, ": reference_distance = ", light.reference_distance,
             "; accepted is 0 or a positive number");
}

void validate(const DirectionalLight& light, std::size_t index) {
    if (!is_finite(light.direction) || !is_finite(light.intensity))
        fail("directional light ", index, ": its direction or intensity is not finite");
    if (light.direction == Float3{}) fail("directional light ", index, ": its direction is zero");
}

void validate(const Camera& camera) {
    if (!is_finite(camera.eye) || !is_finite(camera.target) || !is_finite(camera.up))
        fail("camera: its eye, target or up is not finite");
    if (!(camera.vertical_fov_degrees > 0 && camera.vertical_fov_degrees < 180))
        fail("camera: vertical_fov_degrees = ", camera.vertical_fov_degrees,
             "; accepted is above 0 and below 180");
    const glm::dvec3 view = to_glm(camera.target) - to_glm(camera.eye);
    const glm::dvec3 up = to_glm(camera.up);
    if (glm::dot(view, view) == 0) fail("camera: eye and target are the same point");
    const double sine = glm::length(glm::cross(view, up)) / (glm::length(view) * glm::length(up));
    if (!(sine > 1e-6)) fail("camera: up is zero or points along the view");
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
    for (std::size_t i = 0; i < meshes.size(); ++i) setka::validate(meshes[i], i);
    for (std::size_t i = 0; i < materials.size(); ++i) setka::validate(materials[i], i);
    for (std::size_t i = 0; i < instances.size(); ++i) setka::validate(instances[i], i, *this);
    for (std::size_t i = 0; i < point_lights.size(); ++i) setka::validate(point_lights[i], i);
    for (std::size_t i = 0; i < directional_lights.size(); ++i) setka::validate(directional_lights[i], i);
    if (camera) setka::validate(*camera);
    if (!is_finite(background.zenith) || !is_finite(background.horizon) || !is_finite(background.ground) ||
        !std::isfinite(background.ambient))
        fail("background: a colour or the ambient share is not finite");
    if (triangle_count() == 0) fail("the scene has no triangle");
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
