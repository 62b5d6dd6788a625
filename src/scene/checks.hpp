// SPDX-License-Identifier: MIT
/// Can this part of a scene be used? Each throws InvalidData, which names it by its number and says why not.
#pragma once

#include <cstddef>
#include <span>

#include "setka/scene.hpp"

namespace setka {

/// "mesh 3 'wheel'", or without a name "mesh 3".
template <typename T>
[[nodiscard]] std::string label(const char* kind, std::size_t index, const T& item) {
    const std::string text = std::string(kind) + ' ' + std::to_string(index);
    return item.name.empty() ? text : text + " '" + item.name + '\'';
}

[[nodiscard]] bool is_finite(const Float3& v) noexcept;
[[nodiscard]] bool is_finite(const Matrix34& m) noexcept;

/// Throws unless all are finite: "mesh 3: position 7 is not finite".
void check_finite(const std::string& owner, const char* what, std::span<const Float3> values);

void check(const Mesh& mesh, std::size_t index);
void check(const Material& material, std::size_t index);
void check(const PointLight& light, std::size_t index);
void check(const DirectionalLight& light, std::size_t index);
void check(const Camera& camera);
void check(const Background& background);

}  // namespace setka
