// SPDX-License-Identifier: MIT
/// How do a file's polygons become a Mesh? Checks, triangles, welding, and normals that can be trusted.
#include "io/raw_mesh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "io/file.hpp"

namespace setka::io::detail {

namespace {

constexpr std::uint32_t unset = std::numeric_limits<std::uint32_t>::max();

bool is_finite(const Float3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string describe(const RawMesh& raw) {
    return raw.name.empty() ? "the mesh" : "mesh " + in_quotes(raw.name, 60);
}

void check_corners(const std::filesystem::path& file, const RawMesh& raw) {
    std::uint32_t begin = 0;
    for (std::size_t face = 0; face < raw.face_ends.size(); ++face) {
        const std::uint32_t end = raw.face_ends[face];
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t corner = raw.corners[i];
            if (corner >= raw.positions.size())
                fail_read(file, "face " + std::to_string(face) + " of " + describe(raw) + " uses vertex " +
                                    std::to_string(corner) + ", but there are only " +
                                    std::to_string(raw.positions.size()) + " (numbered from 0)");
            const Float3& p = raw.positions[corner];
            if (end - begin >= 3 && !is_finite(p))
                fail_read(file, "vertex " + std::to_string(corner) + " of " + describe(raw) +
                                    " is not finite: (" + std::to_string(p.x) + ", " + std::to_string(p.y) +
                                    ", " + std::to_string(p.z) + ")");
        }
        begin = end;
    }
}

/// Normals are usable if each one that a triangle uses is finite and not zero.
bool normals_usable(const Mesh& mesh) {
    if (mesh.normals.size() != mesh.positions.size()) return false;
    const auto usable = [&](std::uint32_t i) {
        const Float3& n = mesh.normals[i];
        return is_finite(n) && (n.x != 0 || n.y != 0 || n.z != 0);
    };
    for (const Triangle& t : mesh.triangles)
        if (!usable(t.a) || !usable(t.b) || !usable(t.c)) return false;
    return true;
}

struct VertexBits {
    std::uint32_t words[9];
    friend bool operator==(const VertexBits&, const VertexBits&) = default;
};

struct VertexHash {
    std::size_t operator()(const VertexBits& key) const noexcept {
        std::uint64_t hash = 0x9e3779b97f4a7c15u;
        for (const std::uint32_t word : key.words) {
            hash = (hash ^ word) * 0xff51afd7ed558ccdu;
            hash ^= hash >> 32;
        }
        return static_cast<std::size_t>(hash);
    }
};

/// For each vertex, the first one with the same bits of position, normal and colour.
std::vector<std::uint32_t> first_equal(const Mesh& mesh) {
    std::vector<std::uint32_t> first(mesh.positions.size());
    std::unordered_map<VertexBits, std::uint32_t, VertexHash> seen;
    seen.reserve(mesh.positions.size() / 2);
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        const Float3& p = mesh.positions[i];
        const Float3 n = mesh.normals.empty() ? Float3{} : mesh.normals[i];
        const Float3 c = mesh.colors.empty() ? Float3{} : mesh.colors[i];
        VertexBits key;
        std::ranges::transform(std::array{p.x, p.y, p.z, n.x, n.y, n.z, c.x, c.y, c.z}, key.words,
                               [](float value) { return std::bit_cast<std::uint32_t>(value); });
        first[i] = seen.try_emplace(key, i).first->second;
    }
    return first;
}

/// Keeps the vertices that triangles use, in their order, and renumbers the triangles. Returns the former
/// number of each.
std::vector<std::uint32_t> compact(Mesh& mesh) {
    std::vector<std::uint32_t> number(mesh.positions.size(), unset);
    for (const Triangle& t : mesh.triangles) number[t.a] = number[t.b] = number[t.c] = 0;
    std::uint32_t count = 0;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < number.size(); ++i) {
        if (number[i] == unset) continue;
        mesh.positions[count] = mesh.positions[i];
        if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[i];
        if (!mesh.colors.empty()) mesh.colors[count] = mesh.colors[i];
        kept.push_back(i);
        number[i] = count++;
    }
    mesh.positions.resize(count);
    if (!mesh.normals.empty()) mesh.normals.resize(count);
    if (!mesh.colors.empty()) mesh.colors.resize(count);
    for (Triangle& t : mesh.triangles) t = {number[t.a], number[t.b], number[t.c]};
    return kept;
}

}  // namespace

Mesh finish_mesh(const std::filesystem::path& file, RawMesh raw) {
    return finish_traced_mesh(file, std::move(raw)).mesh;
}

TracedMesh finish_traced_mesh(const std::filesystem::path& file, RawMesh raw) {
    // Indices and triangle numbers are 32-bit everywhere.
    if (raw.positions.size() >= unset || raw.corners.size() >= unset)
        fail_read(file, describe(raw) + " has more than 2^32 - 2 vertices or corners");
    check_corners(file, raw);

    TracedMesh traced;
    Mesh& mesh = traced.mesh;
    mesh.name = std::move(raw.name);
    mesh.positions = std::move(raw.positions);
    mesh.normals = std::move(raw.normals);
    mesh.colors = std::move(raw.colors);
    std::uint32_t begin = 0;
    for (const std::uint32_t end : raw.face_ends) {
        triangulate(mesh.positions, std::span(raw.corners).subspan(begin, end - begin), mesh.triangles);
        begin = end;
    }
    // One NaN or zero normal makes all of them doubtful: such files come from exporters that failed at
    // normals.
    const bool keep_normals = normals_usable(mesh);
    if (!keep_normals) mesh.normals.clear();
    if (raw.sharing == Sharing::ByPosition) {
        const std::vector<std::uint32_t> first = first_equal(mesh);
        for (Triangle& t : mesh.triangles) t = {first[t.a], first[t.b], first[t.c]};
    }
    traced.sources = compact(mesh);
    if (keep_normals) return traced;
    traced.normals_from = NormalsFrom::Faces;
    for (const std::uint32_t repeated : make_normals(mesh)) {
        traced.sources.push_back(traced.sources[repeated]);
        if (!mesh.colors.empty()) mesh.colors.push_back(Float3(mesh.colors[repeated]));
    }
    return traced;
}

}  // namespace setka::io::detail
