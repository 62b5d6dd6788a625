// SPDX-License-Identifier: MIT
#include "scene/device_scene_state.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "scene/limits.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

/// Records that lie so close together in the table are one transfer, with those between them.
constexpr std::uint32_t close = 16;

/// The entry with this number. Throws InvalidArgument if it was removed or never there.
template <typename Entry>
Entry& find(std::vector<Entry>& entries, std::uint32_t index, const char* what) {
    if (index < entries.size() && entries[index].is_live) return entries[index];
    fail(ErrorCategory::InvalidArgument, absence(what, index, entries.size()));
}

}  // namespace

bool is_opaque(const Material& material) noexcept { return !(material.transparency > 0); }

MeshEntry& DeviceScene::State::mesh(std::uint32_t index) { return find(meshes, index, "mesh"); }
InstanceEntry& DeviceScene::State::entry(std::uint32_t index) { return find(entries, index, "instance"); }

SceneNumbers DeviceScene::State::numbers() const {
    return {.meshes = meshes.size(),
            .instances = entries.size(),
            .vertices = [this](std::uint32_t mesh) -> std::optional<VertexCounts> {
                if (mesh >= meshes.size() || !meshes[mesh].is_live) return {};
                return counts_of(meshes[mesh].place);
            },
            .has_instance = [this](std::uint32_t index) { return index < entries.size() && entries[index].is_live; }};
}

void DeviceScene::State::edit(std::uint32_t index) {
    if (entries[index].is_edited) return;
    edited.push_back(index);
    entries[index].is_edited = true;
}

::SetkaInstance DeviceScene::State::record_of(std::uint32_t index, std::uint32_t first_triangle) const {
    ::SetkaInstance record{};
    record.first_triangle = first_triangle;
    if (!entries[index].is_live) return record;
    const Instance& instance = entries[index].instance;
    const MeshPlace& place = meshes[instance.mesh].place;
    std::ranges::copy(instance.transform.rows, record.matrix);
    record.first_index = static_cast<std::uint32_t>(place.triangles.first);
    record.first_vertex = static_cast<std::uint32_t>(place.vertices.first);
    record.material = instance.material;
    record.mask = instance.mask & ~SETKA_MASK_OPAQUE;
    // An instance that the user's masks hide stays hidden from every query.
    if (record.mask != 0 && is_opaque(materials[instance.material])) record.mask |= SETKA_MASK_OPAQUE;
    record.flags = (place.has_normals ? SETKA_INSTANCE_HAS_NORMALS : 0u) |
                   (place.has_colors ? SETKA_INSTANCE_HAS_COLORS : 0u);
    return record;
}

std::vector<std::uint32_t> DeviceScene::State::make_starts() const {
    std::vector<std::uint32_t> result;
    result.reserve(entries.size() + 1);
    SceneSize size{.vertices = tables.vertices(), .mesh_triangles = tables.triangles(), .triangles = 0,
                   .instances = entries.size()};
    for (const InstanceEntry& entry : entries) {
        result.push_back(static_cast<std::uint32_t>(size.triangles));
        if (entry.is_live) size.triangles += meshes[entry.instance.mesh].place.triangles.size;
    }
    check_scene_size(size);
    if (size.triangles == 0) throw Error(ErrorCategory::InvalidData, "the scene has no triangle");
    result.push_back(static_cast<std::uint32_t>(size.triangles));
    return result;
}

auto DeviceScene::State::changes(const std::vector<std::uint32_t>& new_starts) const -> std::vector<Change> {
    std::vector<Change> result;
    const auto add = [&](std::uint32_t index) {
        const Change change{index, record_of(index, new_starts[index])};
        if (index >= records.size() || std::memcmp(&records[index], &change.record, sizeof(change.record)) != 0)
            result.push_back(change);
    };
    if (layout_changed) {
        for (std::uint32_t index = 0; index < entries.size(); ++index) add(index);
    } else {
        std::vector<std::uint32_t> numbers = edited;
        std::ranges::sort(numbers);
        for (const std::uint32_t index : numbers) add(index);
    }
    return result;
}

Buffer<::SetkaInstance> DeviceScene::State::with(Queue& queue, const std::vector<Change>& changed) const {
    Buffer<::SetkaInstance> table = instances;
    if (changed.empty() && instances.size() == entries.size()) return table;
    const bool is_shared = instances.memory().use_count() > 2;  // this one's copy, above, is the second
    if (is_shared || instances.size() != entries.size()) {
        table = queue.make_buffer<::SetkaInstance>(entries.size(), "instances");
        if (changed.size() < entries.size())
            queue.copy(instances, 0, table, 0, std::min(instances.size(), table.size()));
    }
    for (std::size_t i = 0; i < changed.size();) {
        const std::uint32_t first = changed[i].number;
        std::vector<::SetkaInstance> run{changed[i].record};
        for (++i; i < changed.size() && changed[i].number - (first + run.size()) < close; ++i) {
            while (first + run.size() < changed[i].number) run.push_back(records[first + run.size()]);
            run.push_back(changed[i].record);
        }
        queue.upload(std::span<const ::SetkaInstance>(run), table, first);
    }
    return table;
}

void DeviceScene::State::commit(Queue& queue) {
    std::vector<std::uint32_t> new_starts = layout_changed ? make_starts() : starts;
    const std::vector<Change> changed = changes(new_starts);
    // If a transfer fails, part of the table may be new: then nobody knows these records, and the next commit writes them again.
    for (const Change& change : changed)
        if (change.number < records.size()) records[change.number].first_triangle = SETKA_NO_HIT;
    auto table = with(queue, changed);
    if (new_starts != starts) {
        instance_starts = queue.upload(std::span<const std::uint32_t>(new_starts), "instance starts");
        starts = std::move(new_starts);
    }
    instances = std::move(table);
    records.resize(entries.size());
    for (const Change& change : changed) records[change.number] = change.record;
    common_mask = ~0u;
    for (std::size_t index = 0; index < entries.size(); ++index)
        if (starts[index] != starts[index + 1]) common_mask &= records[index].mask;
    for (const std::uint32_t index : edited)
        if (index < entries.size()) entries[index].is_edited = false;
    edited.clear();
    layout_changed = false;
}

}  // namespace setka
