// SPDX-License-Identifier: MIT
/// Did a device compute the right thing? Digests of a grid's tables, of the hits of three kinds of rays and of a picture.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "setka/grid.hpp"
#include "setka/image.hpp"
#include "setka/tracer.hpp"
#include "workload/standard_view.hpp"

namespace setka::workload {

/// Equal for every device, launch shape and step: a function of scene, viewpoint and density alone.
struct Fingerprint {
    Digest tables;   ///< Grid::digest
    Digest primary;  ///< closest hits of primary rays
    Digest shadow;   ///< any hits of shadow rays
    Digest diffuse;  ///< closest hits of diffuse rays
    Digest picture;  ///< linear and encoded pixels
    friend bool operator==(const Fingerprint&, const Fingerprint&) = default;

    /// Each digest with its name, in the order above.
    [[nodiscard]] std::array<std::pair<const char*, Digest>, 5> parts() const;
};

inline constexpr std::uint32_t fingerprint_rays_size = 512;  ///< rays along each side of the square picture
inline constexpr std::uint32_t fingerprint_width = 320, fingerprint_height = 180;

/// What the digests are made of.
struct Results {
    std::vector<Hit> primary;
    std::vector<std::uint32_t> shadow;
    std::vector<Hit> diffuse;
    Image picture;
};

/// Traces the rays and renders. `lit` is the scene on the queue's device, with lights, of which `grid` was built.
[[nodiscard]] Results take_results(Queue& queue, const DeviceScene& lit, const Grid& grid, const StandardView& view,
                                   const StandardRays& rays, GridStep step);

[[nodiscard]] Fingerprint fingerprint(const Digest& tables, const Results& results);

/// Builds, traces and renders. A scene without lights gets the default ones.
[[nodiscard]] Fingerprint take_fingerprint(Queue& queue, Scene scene, Viewpoint viewpoint, const GridOptions& options,
                                           GridStep step);

}  // namespace setka::workload
