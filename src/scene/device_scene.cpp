// SPDX-License-Identifier: MIT
/// How does a scene get onto a device? Concatenated tables, with instances that say where their mesh lies in them.
#include <algorithm>

#include "scene/limits.hpp"
#include "setka/scene.hpp"

namespace setka {

namespace {

SceneSize size_of(const Scene& scene) {
    SceneSize size;
    for (const Mesh& mesh : scene.meshes) {
        size.vertices += mesh.positions.size();
        size.mesh_triangles += mesh.triangles.size();
    }
    size.triangles = scene.triangle_count();
    size.instances = scene.instances.size();
    return size;
}

/// Meshes one behind the other.
struct HostTables {
    std::vector<float> positions, normals;
    std::vector<std::uint32_t> indices;
    std::vector<::SetkaInstance> instances;
    std::vector<std::uint32_t> starts;
};

void add(std::vector<float>& table, const std::vector<Float3>& values) {
    for (const Float3& v : values) table.insert(table.end(), {v.x, v.y, v.z});
}

HostTables tables_of(const Scene& scene, const SceneSize& size) {
    HostTables tables;
    struct Place {
        std::uint32_t first_index, first_vertex;
    };
    std::vector<Place> places;
    const bool any_normals = std::ranges::any_of(scene.meshes, [](const Mesh& m) { return !m.normals.empty(); });
    tables.positions.reserve(3 * size.vertices);
    tables.indices.reserve(3 * size.mesh_triangles);
    for (const Mesh& mesh : scene.meshes) {
        places.push_back({static_cast<std::uint32_t>(tables.indices.size() / 3),
                          static_cast<std::uint32_t>(tables.positions.size() / 3)});
        add(tables.positions, mesh.positions);
        for (const Triangle& t : mesh.triangles) tables.indices.insert(tables.indices.end(), {t.a, t.b, t.c});
        // Meshes without normals get zeros, so that one vertex index serves both tables.
        if (any_normals) {
            add(tables.normals, mesh.normals);
            tables.normals.resize(tables.positions.size(), 0.0f);
        }
    }
    std::uint32_t first_triangle = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        ::SetkaInstance record{};
        std::ranges::copy(instance.transform.rows, record.matrix);
        record.first_triangle = first_triangle;
        record.first_index = places[instance.mesh].first_index;
        record.first_vertex = places[instance.mesh].first_vertex;
        record.material = instance.material;
        record.mask = instance.mask & ~SETKA_MASK_OPAQUE;
        // An instance that the user's masks hide stays hidden from every query.
        if (record.mask != 0 && !(scene.materials[instance.material].transparency > 0)) record.mask |= SETKA_MASK_OPAQUE;
        record.flags = mesh.normals.empty() ? 0 : SETKA_INSTANCE_HAS_NORMALS;
        tables.starts.push_back(first_triangle);
        tables.instances.push_back(record);
        first_triangle += static_cast<std::uint32_t>(mesh.triangles.size());
    }
    tables.starts.push_back(first_triangle);
    return tables;
}

}  // namespace

DeviceScene::DeviceScene(Queue& queue, const Scene& scene) {
    scene.validate();
    const SceneSize size = size_of(scene);
    check_scene_size(size);
    const HostTables tables = tables_of(scene, size);
    triangle_count_ = tables.starts.back();
    instance_count_ = static_cast<std::uint32_t>(scene.instances.size());
    common_mask_ = ~0u;
    for (const ::SetkaInstance& instance : tables.instances) common_mask_ &= instance.mask;
    positions_ = queue.upload(std::span(tables.positions), "positions");
    indices_ = queue.upload(std::span(tables.indices), "indices");
    normals_ = queue.upload(std::span(tables.normals), "normals");
    instances_ = queue.upload(std::span(tables.instances), "instances");
    instance_starts_ = queue.upload(std::span(tables.starts), "instance starts");
    materials_ = scene.materials;
    point_lights_ = scene.point_lights;
    directional_lights_ = scene.directional_lights;
    background_ = scene.background;
}

std::uint64_t DeviceScene::size_bytes() const noexcept {
    return positions_.size_bytes() + indices_.size_bytes() + normals_.size_bytes() + instances_.size_bytes() +
           instance_starts_.size_bytes();
}

}  // namespace setka
