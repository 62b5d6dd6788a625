// SPDX-License-Identifier: MIT
/// Where do the vertices and triangles of meshes lie on the device? In tables that all meshes share, each in a range of its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/room.hpp"
#include "setka/device.hpp"
#include "setka/scene.hpp"

namespace setka {

/// Where a mesh lies: its vertices in the tables of vertices, its triangles in that of indices.
struct MeshPlace {
    Range vertices, triangles;
    bool has_normals = false, has_colors = false;
};

class MeshTables {
  public:
    /// Takes room for meshes and uploads them; if that throws, the room is free again.
    [[nodiscard]] std::vector<MeshPlace> place(Queue& queue, std::span<const Mesh> meshes);
    /// Its room is free for others.
    void remove(const MeshPlace& place);

    void write_positions(Queue& queue, const MeshPlace& place, std::span<const Float3> values);
    void write_normals(Queue& queue, const MeshPlace& place, std::span<const Float3> values);

    /// Vertices and triangles of all meshes.
    [[nodiscard]] std::uint64_t vertices() const noexcept { return vertex_room_.taken(); }
    [[nodiscard]] std::uint64_t triangles() const noexcept { return triangle_room_.taken(); }
    [[nodiscard]] std::uint64_t size_bytes() const noexcept;

    [[nodiscard]] const Buffer<float>& positions() const noexcept { return positions_; }
    [[nodiscard]] const Buffer<std::uint32_t>& indices() const noexcept { return indices_; }
    /// Empty until a mesh has some. One vertex number serves all tables; what they hold for meshes without is not read.
    [[nodiscard]] const Buffer<float>& normals() const noexcept { return normals_; }
    [[nodiscard]] const Buffer<float>& colors() const noexcept { return colors_; }

  private:
    void reserve_vertices(Queue& queue, std::uint64_t more);
    void reserve_triangles(Queue& queue, std::uint64_t more);
    void upload(Queue& queue, std::span<const MeshPlace> places, std::span<const Mesh> meshes);
    /// Makes one of the tables that not every scene has.
    void provide(Queue& queue, Buffer<float>& table, const char* name) const;

    Room vertex_room_, triangle_room_;
    Buffer<float> positions_, normals_, colors_;
    Buffer<std::uint32_t> indices_;
};

}  // namespace setka
