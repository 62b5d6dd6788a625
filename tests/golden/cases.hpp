// SPDX-License-Identifier: MIT
/// Of what are there golden digests?
#pragma once

#include <string>
#include <vector>

#include "workload/golden.hpp"

namespace golden {

/// Scenes of every size and kind at one density, some of them coarse and fine; and what moves in files, frame by frame.
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
    const auto add_frames = [&](const std::string& sequence, int first, int last) {
        for (int i = first; i <= last; ++i) all.push_back({sequence + "+" + std::to_string(i), outside, 4});
    };
    add_frames("dynamic/horse_poses", 1, 10);
    add_frames("dynamic/cloth-ball", 92, 93);
    add_frames("dynamic/cloth-funnel", 227, 228);
    add_frames("dynamic/rod-twist", 3036, 3037);
    for (const char* seconds : {"0", "0.125", "0.25", "0.375", "0.5", "0.75", "1", "1.25"}) {
        all.push_back({std::string("gltf/pigman/scene.gltf+") + seconds, outside, 4});
        all.push_back({std::string("gltf/CesiumMilkTruck.glb+") + seconds, outside, 4});
    }
    return all;
}

}  // namespace golden
