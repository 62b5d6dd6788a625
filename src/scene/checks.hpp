// SPDX-License-Identifier: MIT
/// Can this part of a scene be used, and can this update be applied to it? Parts are refused with InvalidData, updates with InvalidArgument; the
/// message names what is wrong by its number and says why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <sstream>
#include <string>

#include "setka/error.hpp"
#include "setka/scene.hpp"

namespace setka {

/// "mesh 3 'wheel'", or without a name "mesh 3".
template <typename T>
[[nodiscard]] std::string label(const char* kind, std::size_t index, const T& item) {
    const std::string text = std::string(kind) + ' ' + std::to_string(index);
    return item.name.empty() ? text : text + " '" + item.name + '\'';
}

/// "mesh 3 does not exist; it was removed", or "; there are 2".
[[nodiscard]] std::string absence(const char* what, std::uint64_t number, std::uint64_t count);

/// Throws an error whose message is the parts, one behind the other.
template <typename... Ts>
[[noreturn]] void fail(ErrorCategory category, const Ts&... parts) {
    std::ostringstream message;
    (message << ... << parts);
    throw Error(category, message.str());
}

[[nodiscard]] bool is_finite(const Float3& v) noexcept;
[[nodiscard]] bool is_finite(const Matrix34& m) noexcept;

/// Throws unless all are finite: "mesh 3: position 7 is not finite: (0, nan, 2)".
void check_finite(const std::string& owner, const char* what, std::span<const Float3> values);
/// "instance 3: element 7 of its transform is inf; finite numbers are accepted", as an InvalidArgument.
void check_finite(const std::string& owner, const Matrix34& transform);

/// How many a mesh has.
struct VertexCounts {
    std::uint64_t positions = 0, normals = 0;
};

/// What there is in a scene under the numbers of an update.
struct SceneNumbers {
    std::uint64_t meshes = 0, instances = 0;                              ///< all numbers are below
    std::function<std::optional<VertexCounts>(std::uint32_t)> vertices;  ///< nothing: there is no such mesh
    std::function<bool(std::uint32_t)> has_instance;
};

/// Throws InvalidArgument unless so many positions and normals can be those of the mesh; 0 normals leave it those that it has.
void check_counts(std::uint32_t mesh, const VertexCounts& counts, std::uint64_t positions, std::uint64_t normals);
/// The same of what is on the host; InvalidData if it is not finite.
void check_vertices(std::uint32_t mesh, const VertexCounts& counts, std::span<const Float3> positions,
                    std::span<const Float3> normals);

/// Throws InvalidArgument, "update.vertices[1]: mesh 7 does not exist; there are 2", unless all but the camera can be applied.
void check(const SceneUpdate& update, const SceneNumbers& scene);

void check(const Mesh& mesh, std::size_t index);
void check(const Material& material, std::size_t index);
void check(const PointLight& light, std::size_t index);
void check(const DirectionalLight& light, std::size_t index);
void check(const Camera& camera);
void check(const Background& background);

}  // namespace setka
