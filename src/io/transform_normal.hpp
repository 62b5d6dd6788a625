// SPDX-License-Identifier: MIT
/// Where does a normal point after an affine map?
#pragma once

#include <cmath>

#include "setka/scene.hpp"

namespace setka::io::detail {

/// Normals are moved by the cofactors of the matrix, which need no inverse and keep mirrored surfaces right
/// side out. The result has length 1; a normal that has no image is returned as it is.
[[nodiscard]] inline Float3 transform_normal(const Matrix34& matrix, const Float3& n) {
    const auto& m = matrix.rows;
    const double c[3][3] = {
        {double(m[5]) * m[10] - double(m[6]) * m[9], double(m[6]) * m[8] - double(m[4]) * m[10],
         double(m[4]) * m[9] - double(m[5]) * m[8]},
        {double(m[9]) * m[2] - double(m[10]) * m[1], double(m[10]) * m[0] - double(m[8]) * m[2],
         double(m[8]) * m[1] - double(m[9]) * m[0]},
        {double(m[1]) * m[6] - double(m[2]) * m[5], double(m[2]) * m[4] - double(m[0]) * m[6],
         double(m[0]) * m[5] - double(m[1]) * m[4]}};
    double v[3];
    for (int i = 0; i < 3; ++i) v[i] = c[i][0] * n.x + c[i][1] * n.y + c[i][2] * n.z;
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0) || !std::isfinite(length)) return n;
    return {static_cast<float>(v[0] / length), static_cast<float>(v[1] / length),
            static_cast<float>(v[2] / length)};
}

}  // namespace setka::io::detail
