// SPDX-License-Identifier: MIT
#include "scene/checks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scene/vector.hpp"
#include "setka/error.hpp"

namespace setka {

std::string absence(const char* what, std::uint64_t number, std::uint64_t count) {
    return std::string(what) + ' ' + std::to_string(number) + " does not exist; " +
           (number < count ? "it was removed" : "there are " + std::to_string(count));
}

bool is_finite(const Float3& v) noexcept { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_finite(const Matrix34& m) noexcept {
    return std::ranges::all_of(m.rows, [](float value) { return std::isfinite(value); });
}

namespace {

/// Whether all are finite. On the bits, without a branch, so that compilers make vectors of it: a moving scene's vertices are checked in each
/// frame, and this is as fast as memory.
[[nodiscard]] bool all_finite(std::span<const Float3> values) noexcept {
    constexpr std::uint32_t exponent = 0x7f800000u;
    std::uint32_t bad = 0;
    for (const Float3& v : values)
        for (const float component : {v.x, v.y, v.z}) bad |= (std::bit_cast<std::uint32_t>(component) & exponent) == exponent;
    return bad == 0;
}

}  // namespace

void check_finite(const std::string& owner, const char* what, std::span<const Float3> values) {
    if (all_finite(values)) return;
    const auto bad = std::ranges::find_if_not(values, [](const Float3& v) { return is_finite(v); });
    fail(ErrorCategory::InvalidData, owner, ": ", what, ' ', bad - values.begin(), " is not finite: (", bad->x, ", ", bad->y,
         ", ", bad->z, ')');
}

void check_finite(const std::string& owner, const Matrix34& transform) {
    const auto bad = std::ranges::find_if_not(transform.rows, [](float v) { return std::isfinite(v); });
    if (bad != transform.rows.end())
        fail(ErrorCategory::InvalidArgument, owner, ": element ", bad - transform.rows.begin(), " of its transform is ", *bad,
             "; finite numbers are accepted");
}

void check_counts(std::uint32_t mesh, const VertexCounts& counts, std::uint64_t positions, std::uint64_t normals) {
    const auto check_count = [&](std::uint64_t count, std::uint64_t accepted, const char* what) {
        if (count != accepted)
            fail(ErrorCategory::InvalidArgument, count, ' ', what, " for mesh ", mesh, ", which has ", accepted);
    };
    check_count(positions, counts.positions, "positions");
    if (normals != 0) check_count(normals, counts.normals, "normals");
}

void check_vertices(std::uint32_t mesh, const VertexCounts& counts, std::span<const Float3> positions,
                    std::span<const Float3> normals) {
    check_counts(mesh, counts, positions.size(), normals.size());
    const std::string owner = "mesh " + std::to_string(mesh);
    check_finite(owner, "position", positions);
    check_finite(owner, "normal", normals);
}

void check(const SceneUpdate& update, const SceneNumbers& scene) {
    std::string part;
    try {
        for (std::size_t i = 0; i < update.placements.size(); ++i) {
            part = "update.placements[" + std::to_string(i) + "]: ";
            const auto& [instance, transform] = update.placements[i];
            if (!scene.has_instance(instance))
                fail(ErrorCategory::InvalidArgument, absence("instance", instance, scene.instances));
            check_finite("instance " + std::to_string(instance), transform);
        }
        for (std::size_t i = 0; i < update.vertices.size(); ++i) {
            part = "update.vertices[" + std::to_string(i) + "]: ";
            const auto& [mesh, positions, normals] = update.vertices[i];
            const auto counts = scene.vertices(mesh);
            if (!counts) fail(ErrorCategory::InvalidArgument, absence("mesh", mesh, scene.meshes));
            check_vertices(mesh, *counts, positions, normals);
        }
    } catch (const Error& error) {
        fail(ErrorCategory::InvalidArgument, part, error.what());
    }
}

void check(const Mesh& mesh, std::size_t index) {
    const std::string owner = label("mesh", index, mesh);
    const std::size_t vertices = mesh.positions.size();
    if (vertices > std::numeric_limits<std::uint32_t>::max())
        fail(ErrorCategory::InvalidData, owner, ": ", vertices, " positions are more than 2^32 - 1");
    check_finite(owner, "position", mesh.positions);
    const auto check_each = [&](const char* what, const std::vector<Float3>& values) {
        if (!values.empty() && values.size() != vertices)
            fail(ErrorCategory::InvalidData, owner, ": ", values.size(), ' ', what, "s for ", vertices, " positions; one each or none is accepted");
        check_finite(owner, what, values);
    };
    check_each("normal", mesh.normals);
    check_each("color", mesh.colors);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const std::uint32_t largest = std::max({t.a, t.b, t.c});
        if (largest >= vertices) fail(ErrorCategory::InvalidData, owner, ": triangle ", i, " uses vertex ", largest, " of ", vertices);
    }
}

void check(const Material& material, std::size_t index) {
    const auto require = [&](bool holds, const char* member, float value, const char* accepted) {
        if (!holds)
            fail(ErrorCategory::InvalidData, label("material", index, material), ": ", member, " = ", value, "; accepted is ", accepted);
    };
    const auto is_share = [](float value) { return value >= 0 && value <= 1; };
    if (!is_finite(material.diffuse) || !is_finite(material.specular) || !is_finite(material.emission) ||
        !is_finite(material.transmission))
        fail(ErrorCategory::InvalidData, label("material", index, material), ": a colour is not finite");
    require(material.shininess >= 1 && material.shininess <= 65536, "shininess", material.shininess,
            "1 to 65536");
    require(is_share(material.reflectivity), "reflectivity", material.reflectivity, "0 to 1");
    require(is_share(material.transparency), "transparency", material.transparency, "0 to 1");
    require(material.refractive_index > 0 && std::isfinite(material.refractive_index), "refractive_index",
            material.refractive_index, "a positive number");
}

void check(const PointLight& light, std::size_t index) {
    if (!is_finite(light.position) || !is_finite(light.intensity))
        fail(ErrorCategory::InvalidData, "point light ", index, ": its position or intensity is not finite");
    if (!(light.reference_distance >= 0) || !std::isfinite(light.reference_distance))
        fail(ErrorCategory::InvalidData, "point light ", index, ": reference_distance = ", light.reference_distance,
             "; accepted is 0 or a positive number");
}

void check(const DirectionalLight& light, std::size_t index) {
    if (!is_finite(light.direction) || !is_finite(light.intensity))
        fail(ErrorCategory::InvalidData, "directional light ", index, ": its direction or intensity is not finite");
    if (light.direction == Float3{}) fail(ErrorCategory::InvalidData, "directional light ", index, ": its direction is zero");
}

void check(const Camera& camera) {
    if (!is_finite(camera.eye) || !is_finite(camera.target) || !is_finite(camera.up))
        fail(ErrorCategory::InvalidData, "camera: its eye, target or up is not finite");
    if (!(camera.vertical_fov_degrees > 0 && camera.vertical_fov_degrees < 180))
        fail(ErrorCategory::InvalidData, "camera: vertical_fov_degrees = ", camera.vertical_fov_degrees,
             "; accepted is above 0 and below 180");
    const glm::dvec3 view = to_glm(camera.target) - to_glm(camera.eye);
    const glm::dvec3 up = to_glm(camera.up);
    if (glm::dot(view, view) == 0) fail(ErrorCategory::InvalidData, "camera: eye and target are the same point");
    const double sine = glm::length(glm::cross(view, up)) / (glm::length(view) * glm::length(up));
    if (!(sine > 1e-6)) fail(ErrorCategory::InvalidData, "camera: up is zero or points along the view");
}

void check(const Background& background) {
    if (!is_finite(background.zenith) || !is_finite(background.horizon) || !is_finite(background.ground) ||
        !std::isfinite(background.ambient))
        fail(ErrorCategory::InvalidData, "background: a colour or the ambient share is not finite");
}

}  // namespace setka
