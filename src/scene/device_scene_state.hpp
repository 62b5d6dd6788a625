// SPDX-License-Identifier: MIT
/// What does a scene on a device remember of itself? Its meshes and instances, which of these were edited, and what the device's tables hold.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "scene/checks.hpp"
#include "scene/mesh_tables.hpp"
#include "setka/device_scene.hpp"

namespace setka {

struct MeshEntry {
    MeshPlace place;
    std::uint32_t users = 0;  ///< instances that have the mesh
    bool is_live = false;
};

[[nodiscard]] inline VertexCounts counts_of(const MeshPlace& place) noexcept {
    return {place.vertices.size, place.has_normals ? place.vertices.size : 0};
}

struct InstanceEntry {
    Instance instance;
    bool is_live = false;
    bool is_edited = false;  ///< since the last commit
};

struct DeviceScene::State {
    MeshTables tables;
    std::vector<MeshEntry> meshes;
    std::vector<InstanceEntry> entries;
    std::set<std::uint32_t> free_meshes, free_entries;  ///< numbers among them

    /// Numbers of instances. Where places have come and gone, which layout_changed tells, it may hold some twice and some that are no more.
    std::vector<std::uint32_t> edited;
    bool layout_changed = false;        ///< instances are more or fewer, or a mesh of theirs is another

    // On the device, as committed.
    Buffer<::SetkaInstance> instances;
    Buffer<std::uint32_t> instance_starts;
    std::vector<::SetkaInstance> records;  ///< what `instances` holds
    std::vector<std::uint32_t> starts;     ///< what `instance_starts` holds
    std::uint32_t common_mask = ~0u;

    std::vector<Material> materials;
    std::vector<PointLight> point_lights;
    std::vector<DirectionalLight> directional_lights;
    Background background;

    [[nodiscard]] bool is_committed() const noexcept { return edited.empty() && !layout_changed; }
    /// Both throw InvalidArgument for a number that names nothing.
    [[nodiscard]] MeshEntry& mesh(std::uint32_t index);
    [[nodiscard]] InstanceEntry& entry(std::uint32_t index);
    [[nodiscard]] SceneNumbers numbers() const;
    /// Remembers that the instance's record may be another.
    void edit(std::uint32_t index);
    void commit(Queue& queue);

  private:
    /// A record of the table of instances, and where in it that goes.
    struct Change {
        std::uint32_t number = 0;
        ::SetkaInstance record{};
    };

    [[nodiscard]] ::SetkaInstance record_of(std::uint32_t index, std::uint32_t first_triangle) const;
    /// The first triangle of each instance, then the total.
    [[nodiscard]] std::vector<std::uint32_t> make_starts() const;
    /// Records that are not what the table holds, in ascending order.
    [[nodiscard]] std::vector<Change> changes(const std::vector<std::uint32_t>& new_starts) const;
    /// The table with the changes. Another buffer than before if a structure has that one, or if its size is another.
    [[nodiscard]] Buffer<::SetkaInstance> with(Queue& queue, const std::vector<Change>& changed) const;
};

[[nodiscard]] bool is_opaque(const Material& material) noexcept;

}  // namespace setka
