// SPDX-License-Identifier: MIT
/// Where does an instance put a point? The same operations in the same order as sk_transform_point on a
/// device, so that what the host computes agrees with the tables.
#pragma once

#include "setka/scene.hpp"

namespace setka {

[[nodiscard]] inline Float3 transform_point(const Matrix34& matrix, const Float3& p) {
    const auto& m = matrix.rows;
    return {(((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3]) + 0.0f,
            (((m[4] * p.x + m[5] * p.y) + m[6] * p.z) + m[7]) + 0.0f,
            (((m[8] * p.x + m[9] * p.y) + m[10] * p.z) + m[11]) + 0.0f};
}

}  // namespace setka
