// SPDX-License-Identifier: MIT
/// Where does the scene end? The box around all triangles, reduced on the device.
#pragma once

#include <cstdint>

#include "setka/scene.hpp"

namespace setka {

/// The inverse of sk_ordered in device/reduce.h.
[[nodiscard]] float float_of_ordered(std::uint32_t ordered) noexcept;

/// Bytes of scratch that the reduction over n triangles holds while it runs.
[[nodiscard]] std::uint64_t reduce_scratch_bytes(const Device& device, std::uint32_t n);

/// Minimum and maximum over the vertices of n triangles of nine floats each; waits. For n = 0 lower is +infinity and upper
/// -infinity. No vertex may be NaN.
[[nodiscard]] Bounds reduce_bounds(Queue& queue, const Buffer<float>& triangles, std::uint32_t n);

}  // namespace setka
