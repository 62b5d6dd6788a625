// SPDX-License-Identifier: MIT
/// Which rays does everybody trace? One camera and one light for any scene, and the three kinds of rays that renderers cast.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "setka/grid.hpp"
#include "setka/tracer.hpp"

namespace setka::workload {

/// Where the standard camera stands.
enum class Viewpoint {
    Outside,  ///< off the scene, looking at its middle: for objects
    Inside,   ///< near the middle, looking past it: for buildings
};

[[nodiscard]] const char* to_string(Viewpoint viewpoint) noexcept;

struct StandardView {
    Camera camera;   ///< 50 degrees, +y is up
    Float3 light;    ///< the point that shadow rays end at
    float lift = 0;  ///< how far secondary rays start off the surface: 1e-4 of the scene's diagonal
};

/// Eye = centre + unit(d) * diagonal * k, looking at the centre: d = (0.6, 0.35, 1), k = 0.9 outside and (1, 0.05, 0.1), 0.12
/// inside. Light = centre + diagonal * (0.3, 0.45, 0.2) outside, centre + 0.1 of the height inside.
[[nodiscard]] StandardView standard_view(const Bounds& bounds, Viewpoint viewpoint);

/// A square picture's rays. Shadow and diffuse rays start where primary rays hit, in the order of the pixels.
struct StandardRays {
    Buffer<Ray> primary;
    Buffer<Ray> shadow;   ///< to the light, which is at t = 1
    Buffer<Ray> diffuse;  ///< cosine-distributed around the face's normal, on the side of the ray
    std::vector<std::uint32_t> pixels;  ///< of the shadow and diffuse rays: the numbers of their primary rays
};

/// One for each primary ray, in their order, where `rays` are only those of some of them: the others have tmin > tmax.
[[nodiscard]] std::vector<Ray> in_places(std::span<const Ray> rays, std::span<const std::uint32_t> pixels, std::size_t size);

/// Traces the primary rays, and makes the others on the host with + - * / sqrt on floats: the same on every machine.
/// Shadow and diffuse are empty if no primary ray hits.
[[nodiscard]] StandardRays standard_rays(Queue& queue, const Structure& structure, const StandardView& view,
                                         std::uint32_t size);

}  // namespace setka::workload
