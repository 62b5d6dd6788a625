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

}  // namespace

void MeshTables::reserve(Queue& queue, std::uint64_t vertices, std::uint64_t triangles) {
    reserve_vertices(queue, vertices);
    reserve_triangles(queue, triangles);
}

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

MeshPlace MeshTables::place(Queue& queue, const Mesh& mesh) {
    reserve(queue, mesh.positions.size(), mesh.triangles.size());
    const MeshPlace place{*vertex_room_.take(mesh.positions.size()), *triangle_room_.take(mesh.triangles.size()),
                          !mesh.normals.empty(), !mesh.colors.empty()};
    try {
        upload(queue, place, mesh);
    } catch (...) {
        remove(place);
        throw;
    }
    return place;
}

void MeshTables::upload(Queue& queue, const MeshPlace& place, const Mesh& mesh) {
    write_positions(queue, place, mesh.positions);
    queue.upload(components(std::span(mesh.triangles)), indices_, 3 * place.triangles.first);
    if (place.has_normals) {
        provide(queue, normals_, "normals");
        write_normals(queue, place, mesh.normals);
    }
    if (place.has_colors) {
        provide(queue, colors_, "colors");
        queue.upload(components(std::span(mesh.colors)), colors_, 3 * place.vertices.first);
    }
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
