// SPDX-License-Identifier: MIT
#include "accel/world_geometry.hpp"
#include "core/launch.hpp"
#include "setka/structure.hpp"

namespace setka {

BruteForce BruteForce::build(Queue& queue, const DeviceScene& scene) {
    WorldGeometry geometry = transform_scene(queue, scene);
    queue.impl().begin_stage("pack");
    const std::uint32_t padded = (geometry.triangle_count + lane_count - 1) / lane_count * lane_count;
    auto packets = queue.make_buffer<float>(std::size_t(padded) * 9, "triangle packets");
    launch_items(queue, Kernel::trace_pack, padded, geometry.triangle_count, geometry.triangles, packets);
    return BruteForce(std::move(geometry), std::move(packets));
}

std::vector<Section> BruteForce::sections() const {
    auto sections = geometry_sections(geometry());
    sections.push_back({"packets", packets_.size_bytes()});
    return sections;
}

}  // namespace setka
