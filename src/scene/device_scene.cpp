// SPDX-License-Identifier: MIT
/// What does an edit change on the device, and when? Vertices at once, the table of instances when all edits of a moment are known.
#include "setka/device_scene.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "scene/checks.hpp"
#include "scene/device_scene_state.hpp"
#include "scene/limits.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

template <typename... Ts>
[[noreturn]] void refuse(const Ts&... parts) {
    fail(ErrorCategory::InvalidArgument, parts...);
}

/// The lowest number that is free.
template <typename Entry>
std::uint32_t free_number(const std::vector<Entry>& entries, const std::set<std::uint32_t>& free) {
    return free.empty() ? static_cast<std::uint32_t>(entries.size()) : *free.begin();
}

/// Puts an entry at a free number.
template <typename Entry>
void put(std::vector<Entry>& entries, std::set<std::uint32_t>& free, std::uint32_t index, Entry entry) {
    if (index == entries.size()) {
        entries.push_back(std::move(entry));
    } else {
        entries[index] = std::move(entry);
        free.erase(index);
    }
}

void check_instance(const std::vector<MeshEntry>& meshes, const std::vector<Material>& materials,
                    const Instance& instance, std::uint32_t index) {
    const std::string owner = "instance " + std::to_string(index);
    if (instance.mesh >= meshes.size() || !meshes[instance.mesh].is_live)
        refuse(owner, ": ", absence("mesh", instance.mesh, meshes.size()));
    if (instance.material >= materials.size())
        refuse(owner, ": ", absence("material", instance.material, materials.size()));
    check_finite(owner, instance.transform);
}

/// Throws if the scene would be too large with `mesh` in place of one that takes `old`, and that so many instances have.
void check_room(const MeshTables& tables, const Mesh& mesh, const MeshPlace& old, std::uint32_t users) {
    check_scene_size({.vertices = tables.vertices() - old.vertices.size + mesh.positions.size(),
                      .mesh_triangles = tables.triangles() - old.triangles.size + mesh.triangles.size(),
                      .triangles = std::uint64_t(users) * mesh.triangles.size(),
                      .instances = 0});
}

MeshPlace place_one(Queue& queue, MeshTables& tables, const Mesh& mesh) {
    return tables.place(queue, {&mesh, 1}).front();
}

}  // namespace

DeviceScene::DeviceScene() : state_(std::make_unique<State>()) {}
DeviceScene::~DeviceScene() = default;
DeviceScene::DeviceScene(DeviceScene&&) noexcept = default;
DeviceScene& DeviceScene::operator=(DeviceScene&&) noexcept = default;

DeviceScene::DeviceScene(Queue& queue, const Scene& scene) : DeviceScene() {
    scene.validate();
    SceneSize size{.vertices = 0, .mesh_triangles = 0, .triangles = scene.triangle_count(),
                   .instances = scene.instances.size()};
    for (const Mesh& mesh : scene.meshes) {
        size.vertices += mesh.positions.size();
        size.mesh_triangles += mesh.triangles.size();
    }
    check_scene_size(size);
    State& state = *state_;
    for (const MeshPlace& place : state.tables.place(queue, scene.meshes)) state.meshes.push_back({place, 0, true});
    for (const Instance& instance : scene.instances) {
        state.entries.push_back({instance, true, false});
        ++state.meshes[instance.mesh].users;
    }
    state.materials = scene.materials;
    state.point_lights = scene.point_lights;
    state.directional_lights = scene.directional_lights;
    state.background = scene.background;
    state.layout_changed = true;
    commit(queue);
}

std::uint32_t DeviceScene::add_mesh(Queue& queue, const Mesh& mesh) {
    State& state = *state_;
    const auto index = free_number(state.meshes, state.free_meshes);
    check(mesh, index);
    check_room(state.tables, mesh, MeshPlace{}, 0);
    state.meshes.reserve(state.meshes.size() + 1);  // so that nothing fails when the mesh has its place
    put(state.meshes, state.free_meshes, index, {place_one(queue, state.tables, mesh), 0, true});
    return index;
}

void DeviceScene::replace_mesh(Queue& queue, std::uint32_t mesh, const Mesh& with) {
    State& state = *state_;
    MeshEntry& entry = state.mesh(mesh);
    check(with, mesh);
    check_room(state.tables, with, entry.place, entry.users);
    const MeshPlace place = place_one(queue, state.tables, with);
    state.tables.remove(entry.place);
    entry.place = place;
    if (entry.users > 0) state.layout_changed = true;
}

namespace {

/// Vertices in a buffer of 3 floats each.
std::size_t vertices_in(const char* what, const Buffer<float>& buffer) {
    if (buffer.size() % 3 != 0) refuse(what, " has ", buffer.size(), " floats; a multiple of 3 is accepted");
    return buffer.size() / 3;
}

void write_vertices(Queue& queue, MeshTables& tables, const MeshPlace& place, std::span<const Float3> positions,
                    std::span<const Float3> normals) {
    tables.write_positions(queue, place, positions);
    if (!normals.empty()) tables.write_normals(queue, place, normals);
}

}  // namespace

void DeviceScene::set_vertices(Queue& queue, std::uint32_t mesh, std::span<const Float3> positions,
                               std::span<const Float3> normals) {
    const MeshPlace& place = state_->mesh(mesh).place;
    check_vertices(mesh, counts_of(place), positions, normals);
    write_vertices(queue, state_->tables, place, positions, normals);
}

void DeviceScene::set_vertices(Queue& queue, std::uint32_t mesh, const Buffer<float>& positions,
                               const Buffer<float>& normals) {
    const MeshPlace& place = state_->mesh(mesh).place;
    check_counts(mesh, counts_of(place), vertices_in("positions", positions), vertices_in("normals", normals));
    const MeshTables& tables = state_->tables;
    if (positions.memory() == tables.positions().memory() || (!normals.empty() && normals.memory() == tables.normals().memory()))
        refuse("positions or normals for mesh ", mesh, " are the scene's own table; another buffer is accepted");
    const std::size_t first = 3 * place.vertices.first;
    queue.copy(positions, 0, tables.positions(), first, positions.size());
    if (!normals.empty()) queue.copy(normals, 0, tables.normals(), first, normals.size());
}

void DeviceScene::apply(Queue& queue, const SceneUpdate& update) {
    check(update, state_->numbers());
    for (const auto& [mesh, positions, normals] : update.vertices)
        write_vertices(queue, state_->tables, state_->mesh(mesh).place, positions, normals);
    for (const auto& [instance, transform] : update.placements) set_transform(instance, transform);
    commit(queue);
}

void DeviceScene::remove_mesh(std::uint32_t mesh) {
    State& state = *state_;
    MeshEntry& entry = state.mesh(mesh);
    if (entry.users > 0) {
        const auto user = std::ranges::find_if(state.entries, [&](const InstanceEntry& e) {
            return e.is_live && e.instance.mesh == mesh;
        });
        refuse("mesh ", mesh, " cannot be removed: it is that of ", entry.users, " instances, such as ",
               std::uint64_t(user - state.entries.begin()), "; remove these first");
    }
    state.free_meshes.insert(mesh);
    state.tables.remove(entry.place);
    entry = {};
}

std::uint32_t DeviceScene::add_instance(const Instance& instance) {
    State& state = *state_;
    const auto index = free_number(state.entries, state.free_entries);
    check_instance(state.meshes, state.materials, instance, index);
    put(state.entries, state.free_entries, index, {instance, true, false});
    ++state.meshes[instance.mesh].users;
    state.layout_changed = true;
    return index;
}

void DeviceScene::set_instance(std::uint32_t number, const Instance& instance) {
    State& state = *state_;
    InstanceEntry& entry = state.entry(number);
    check_instance(state.meshes, state.materials, instance, number);
    state.edit(number);  // this may fail; what follows may not
    if (instance.mesh != entry.instance.mesh) {
        --state.meshes[entry.instance.mesh].users;
        ++state.meshes[instance.mesh].users;
        state.layout_changed = true;
    }
    entry.instance = instance;
}

void DeviceScene::set_transform(std::uint32_t number, const Matrix34& transform) {
    InstanceEntry& entry = state_->entry(number);
    check_finite("instance " + std::to_string(number), transform);
    state_->edit(number);
    entry.instance.transform = transform;
}

void DeviceScene::remove_instance(std::uint32_t number) {
    State& state = *state_;
    InstanceEntry& entry = state.entry(number);
    state.free_entries.insert(number);
    --state.meshes[entry.instance.mesh].users;
    entry.is_live = false;
    // Places after the last instance are no more.
    while (!state.entries.empty() && !state.entries.back().is_live) {
        state.entries.pop_back();
        state.free_entries.erase(static_cast<std::uint32_t>(state.entries.size()));
    }
    state.layout_changed = true;
}

std::uint32_t DeviceScene::add_material(const Material& material) {
    const auto index = static_cast<std::uint32_t>(state_->materials.size());
    check(material, index);
    state_->materials.push_back(material);
    return index;
}

void DeviceScene::set_material(std::uint32_t number, const Material& material) {
    State& state = *state_;
    if (number >= state.materials.size())
        refuse(absence("material", number, state.materials.size()));
    check(material, number);
    Material copy = material;
    if (is_opaque(material) != is_opaque(state.materials[number]))
        for (std::uint32_t index = 0; index < state.entries.size(); ++index)
            if (state.entries[index].is_live && state.entries[index].instance.material == number) state.edit(index);
    state.materials[number] = std::move(copy);
}

void DeviceScene::set_lights(std::vector<PointLight> point_lights, std::vector<DirectionalLight> directional_lights) {
    for (std::size_t i = 0; i < point_lights.size(); ++i) check(point_lights[i], i);
    for (std::size_t i = 0; i < directional_lights.size(); ++i) check(directional_lights[i], i);
    state_->point_lights = std::move(point_lights);
    state_->directional_lights = std::move(directional_lights);
}

void DeviceScene::set_background(const Background& background) {
    check(background);
    state_->background = background;
}

void DeviceScene::commit(Queue& queue) {
    if (!state_->is_committed()) state_->commit(queue);
}

bool DeviceScene::is_committed() const noexcept { return state_->is_committed(); }

void DeviceScene::check_committed() const {
    if (!is_committed() || state_->starts.empty())
        refuse("scene has edits that are not on the device; commit() has to come first");
}

std::uint32_t DeviceScene::triangle_count() const noexcept { return state_->starts.empty() ? 0 : state_->starts.back(); }
std::uint32_t DeviceScene::instance_count() const noexcept {
    return static_cast<std::uint32_t>(state_->records.size());
}
std::uint64_t DeviceScene::size_bytes() const noexcept {
    return state_->tables.size_bytes() + state_->instances.size_bytes() + state_->instance_starts.size_bytes();
}
std::uint32_t DeviceScene::common_mask() const noexcept { return state_->common_mask; }
const Buffer<float>& DeviceScene::positions() const noexcept { return state_->tables.positions(); }
const Buffer<std::uint32_t>& DeviceScene::indices() const noexcept { return state_->tables.indices(); }
const Buffer<float>& DeviceScene::normals() const noexcept { return state_->tables.normals(); }
const Buffer<float>& DeviceScene::colors() const noexcept { return state_->tables.colors(); }
const Buffer<::SetkaInstance>& DeviceScene::instances() const noexcept { return state_->instances; }
const Buffer<std::uint32_t>& DeviceScene::instance_starts() const noexcept { return state_->instance_starts; }
const std::vector<Material>& DeviceScene::materials() const noexcept { return state_->materials; }
const std::vector<PointLight>& DeviceScene::point_lights() const noexcept { return state_->point_lights; }
const std::vector<DirectionalLight>& DeviceScene::directional_lights() const noexcept {
    return state_->directional_lights;
}
const Background& DeviceScene::background() const noexcept { return state_->background; }

}  // namespace setka
