// SPDX-License-Identifier: MIT
/// What value does an animated property of glTF have at a time? Steps, lines and cubic splines between keys,
/// in double from + - * / and sqrt only, so that a pose has the same bits on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "io/gltf_document.hpp"

namespace setka::io::detail {

enum class Interpolation { Step, Linear, CubicSpline };

/// What the values are: three numbers, unit quaternions, which turn along the shortest arc, or weights of
/// morph targets.
enum class Values { Vectors, Quaternions, Weights };

/// The keys of one sampler (glTF 2.0, appendix C). Before the first and after the last, the ends hold.
struct Track {
    Interpolation interpolation = Interpolation::Linear;
    Values kind = Values::Vectors;
    std::size_t width = 0;                    ///< numbers of a value
    std::shared_ptr<const GltfNumbers> keys;  ///< seconds, not falling; channels share them
    std::shared_ptr<const GltfNumbers>
        values;  ///< width a key; of a spline thrice: tangent in, value, tangent out

    /// The value at a time: `width` numbers.
    [[nodiscard]] std::vector<double> at(double seconds) const;
};

/// Spherical interpolation of unit quaternions: the arc is halved until the rest is too short to differ from
/// its chord.
[[nodiscard]] std::array<double, 4> slerp(const std::array<double, 4>& from, std::array<double, 4> to,
                                          double share);

/// Reads a sampler for values of `width` numbers. Throws InvalidData that starts with `what` for times that
/// fall or are not finite, other counts than glTF demands, and an interpolation that does not exist.
[[nodiscard]] Track read_track(const GltfDocument& document, const nlohmann::json& sampler, std::size_t width,
                               Values kind, const std::string& what);

}  // namespace setka::io::detail
