// SPDX-License-Identifier: MIT
/// Of what are there golden digests?
#pragma once

#include <vector>

#include "workload/golden.hpp"

namespace golden {

/// Scenes of every size and kind at the default density, and some of them coarse and fine.
[[nodiscard]] inline std::vector<setka::workload::GoldenCase> cases() {
    using setka::workload::Viewpoint;
    const auto outside = Viewpoint::Outside, inside = Viewpoint::Inside;
    std::vector<setka::workload::GoldenCase> all{
        {"cube", outside, 4},
        {"plane:20000", outside, 4},
        {"showcase", outside, 4},
        {"scan/stanford-bunny.obj", outside, 4},
        {"scan/dragon.obj", outside, 4},
        {"arch/sponza_dabrovic.obj", inside, 4},
        {"arch/kitchen_fatih", inside, 4},
        {"gltf/2CylinderEngine.glb", outside, 4},
        {"soup:1000000", outside, 4},
        {"spheres:1000000", outside, 4},
        {"terrain:4000000", outside, 4},
        {"spheres:10000000", outside, 4},
    };
    for (const float density : {0.5f, 4.0f, 16.0f})
        for (const char* scene : {"sphere:20000", "torus:20000", "terrain:50000", "spheres:50000", "soup:50000"})
            all.push_back({scene, outside, density});
    for (const float density : {0.5f, 16.0f}) {
        all.push_back({"scan/dragon.obj", outside, density});
        all.push_back({"arch/sponza_dabrovic.obj", inside, density});
    }
    return all;
}

}  // namespace golden
