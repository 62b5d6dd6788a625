// SPDX-License-Identifier: MIT
/// How large may a scene be? So large that every number of a vertex, a triangle or an instance has 32 bits, with
/// room to spare for tables that grow.
#pragma once

#include <cstdint>
#include <string>

#include "setka/error.hpp"

namespace setka {

struct SceneSize {
    std::uint64_t vertices = 0;        ///< of all meshes
    std::uint64_t mesh_triangles = 0;  ///< of all meshes, each once, instanced or not
    std::uint64_t triangles = 0;       ///< of all instances
    std::uint64_t instances = 0;
};

/// Throws InvalidArgument, naming the count.
inline void check_scene_size(const SceneSize& size) {
    constexpr std::uint64_t most_triangles = std::uint64_t{1} << 28, most_vertices = std::uint64_t{1} << 30;
    const auto check = [](const char* owner, std::uint64_t count, const char* what, std::uint64_t most) {
        if (count > most)
            throw Error(ErrorCategory::InvalidArgument, std::string(owner) + " " + std::to_string(count) +
                                                            " " + what + "; up to " + std::to_string(most) +
                                                            " are accepted");
    };
    check("the scene has", size.vertices, "vertices", most_vertices);
    check("the scene's meshes have", size.mesh_triangles, "triangles", most_triangles);
    check("the scene has", size.triangles, "triangles", most_triangles);
    check("the scene has", size.instances, "instances", most_triangles);
}

}  // namespace setka
