// SPDX-License-Identifier: MIT
#include "scene/mesh_tables.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "backend/device.hpp"
#include "setka/error.hpp"

namespace setka {

namespace {

/// The values' components, one behind the other.
std::span<const float> components(std::span<const Float3> values) {
    static_assert(sizeof(Float3) == 3 * sizeof(float));
    return {reinterpret_cast<const float*>(values.data()), 3 * values.size()};
}

std::span<const std::uint32_t> components(std::span<const Triangle> values) {
    static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));
    return {reinterpret_cast<const std::uint32_t*>(values.data()), 3 * values.size()};
}

/// A table for `capacity` elements of three numbers that begins with what `old` holds.
template <typename T>
Buffer<T> grown(Queue& queue, const Buffer<T>& old, std::uint64_t capacity, const char* name) {
    auto table = queue.make_buffer<T>(3 * capacity, name);
    queue.copy(old, 0, table, 0, old.size());
    return table;
}

/// The same where elements that nobody has written are 0.
Buffer<float> grown_of_zeros(Queue& queue, const Buffer<float>& old, std::uint64_t capacity, const char* name) {
    auto table = queue.make_buffer<float>(3 * capacity, name);
    queue.impl().fill(*table.memory(), 0, table.size_bytes());
    queue.copy(old, 0, table, 0, old.size());
    return table;
}

/// Calls grow(capacity) for a table that has too little room in one piece. It grows by half, so that a scene that is put together mesh by mesh
/// is not copied for each; or, where memory does not suffice for that, by what is needed.
template <typename Grow>
void enlarge(const Room& room, std::uint64_t more, const char* what, const Grow& grow) {
    const std::uint64_t least = room.capacity() + more, half_more = room.capacity() + room.capacity() / 2;
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    if (least > most)
        throw Error(ErrorCategory::OutOfMemory, "there is no room for " + std::to_string(more) + ' ' + what +
                                                    " in one piece in a table of " + std::to_string(room.capacity()));
    if (half_more > least && half_more <= most) {
        try {
            return grow(half_more);
        } catch (const Error& error) {
            if (error.category() != ErrorCategory::OutOfMemory) throw;
        }
    }
    grow(least);
}

/// Uploads to a table. What goes to neighbouring places goes together, since small transfers cost more than their bytes. Complete after flush().
template <typename T>
class Transfers {
  public:
    Transfers(Queue& queue, const Buffer<T>& table) : queue_(queue), table_(table) {}

    void add(std::span<const T> values, std::uint64_t first) {
        constexpr std::size_t large = (std::size_t{1} << 20) / sizeof(T);  // worth a transfer, not worth a copy
        if (first != first_ + pending_.size() || pending_.size() + values.size() > large) flush();
        if (values.size() > large) return queue_.upload(values, table_, first);
        if (pending_.empty()) first_ = first;
        pending_.insert(pending_.end(), values.begin(), values.end());
    }

    void flush() {
        if (!pending_.empty()) queue_.upload(std::span<const T>(pending_), table_, first_);
        pending_.clear();
    }

  private:
    Queue& queue_;
    const Buffer<T>& table_;
    std::vector<T> pending_;
    std::uint64_t first_ = 0;
};

}  // namespace

void MeshTables::reserve_vertices(Queue& queue, std::uint64_t more) {
    if (const auto range = vertex_room_.take(more)) return vertex_room_.give(*range);
    enlarge(vertex_room_, more, "vertices", [&](std::uint64_t capacity) {
        auto positions = grown(queue, positions_, capacity, "positions");
        auto normals = normals_.empty() ? normals_ : grown_of_zeros(queue, normals_, capacity, "normals");
        auto colors = colors_.empty() ? colors_ : grown_of_zeros(queue, colors_, capacity, "colors");
        vertex_room_.grow(capacity);
        positions_ = std::move(positions);
        normals_ = std::move(normals);
        colors_ = std::move(colors);
    });
}

void MeshTables::reserve_triangles(Queue& queue, std::uint64_t more) {
    if (const auto range = triangle_room_.take(more)) return triangle_room_.give(*range);
    enlarge(triangle_room_, more, "triangles", [&](std::uint64_t capacity) {
        auto indices = grown(queue, indices_, capacity, "indices");
        triangle_room_.grow(capacity);
        indices_ = std::move(indices);
    });
}

std::vector<MeshPlace> MeshTables::place(Queue& queue, std::span<const Mesh> meshes) {
    std::uint64_t vertices = 0, triangles = 0;
    for (const Mesh& mesh : meshes) {
        vertices += mesh.positions.size();
        triangles += mesh.triangles.size();
    }
    std::vector<MeshPlace> places;
    places.reserve(meshes.size());
    reserve_vertices(queue, vertices);
    reserve_triangles(queue, triangles);
    for (const Mesh& mesh : meshes)
        places.push_back({*vertex_room_.take(mesh.positions.size()), *triangle_room_.take(mesh.triangles.size()),
                          !mesh.normals.empty(), !mesh.colors.empty()});
    try {
        upload(queue, places, meshes);
    } catch (...) {
        for (const MeshPlace& place : places) remove(place);
        throw;
    }
    return places;
}

void MeshTables::upload(Queue& queue, std::span<const MeshPlace> places, std::span<const Mesh> meshes) {
    if (std::ranges::any_of(places, &MeshPlace::has_normals)) provide(queue, normals_, "normals");
    if (std::ranges::any_of(places, &MeshPlace::has_colors)) provide(queue, colors_, "colors");
    Transfers positions(queue, positions_), normals(queue, normals_), colors(queue, colors_);
    Transfers indices(queue, indices_);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::uint64_t first_vertex = 3 * places[i].vertices.first;
        positions.add(components(std::span(meshes[i].positions)), first_vertex);
        indices.add(components(std::span(meshes[i].triangles)), 3 * places[i].triangles.first);
        if (places[i].has_normals) normals.add(components(std::span(meshes[i].normals)), first_vertex);
        if (places[i].has_colors) colors.add(components(std::span(meshes[i].colors)), first_vertex);
    }
    positions.flush();
    indices.flush();
    normals.flush();
    colors.flush();
}

void MeshTables::provide(Queue& queue, Buffer<float>& table, const char* name) const {
    if (table.empty()) table = grown_of_zeros(queue, table, vertex_room_.capacity(), name);
}

void MeshTables::remove(const MeshPlace& place) {
    vertex_room_.give(place.vertices);
    triangle_room_.give(place.triangles);
}

void MeshTables::write_positions(Queue& queue, const MeshPlace& place, std::span<const Float3> values) {
    queue.upload(components(values), positions_, 3 * place.vertices.first);
}

void MeshTables::write_normals(Queue& queue, const MeshPlace& place, std::span<const Float3> values) {
    queue.upload(components(values), normals_, 3 * place.vertices.first);
}

std::uint64_t MeshTables::size_bytes() const noexcept {
    return positions_.size_bytes() + normals_.size_bytes() + colors_.size_bytes() + indices_.size_bytes();
}

}  // namespace setka
