// SPDX-License-Identifier: MIT
/// How are rays handed to Embree? See the header.
#include "bench/embree/ray_packets.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace setka::bench {

namespace {

/// So many packets that taking them costs nothing beside tracing them, and so few that all threads end at
/// about the same time.
constexpr std::size_t packets_a_chunk = 128;

alignas(32) constexpr int all_lanes[8] = {-1, -1, -1, -1, -1, -1, -1, -1};

[[nodiscard]] RTCIntersectContext make_context(Coherence coherence) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherence == Coherence::Coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

}  // namespace

RayPackets::RayPackets(std::span<const Ray> rays, Coherence coherence)
    : ray_count_(rays.size()),
      coherence_(coherence),
      rays_((rays.size() + width - 1) / width),
      hits_(rays_.size()),
      ends_(rays_.size()) {
    // The last packet is filled up with its last ray, which costs nothing beside the others.
    for (std::size_t i = 0; i < rays_.size() * width; ++i) {
        const Ray& ray = rays[std::min(i, ray_count_ - 1)];
        Rays& packet = rays_[i / width];
        const std::size_t lane = i % width;
        for (int axis = 0; axis < 3; ++axis) {
            packet.origin[axis][lane] = ray.origin[axis];
            packet.direction[axis][lane] = ray.direction[axis];
        }
        packet.tmin[lane] = ray.tmin;
        packet.tmax[lane] = ray.tmax;
    }
}

template <typename Body>
void RayPackets::for_each_packet(ThreadPool& pool, const Body& body) {
    pool.for_each_chunk(rays_.size(), packets_a_chunk, [&](std::size_t first, std::size_t last) {
        RTCIntersectContext context = make_context(coherence_);
        for (std::size_t i = first; i < last; ++i) body(i, context);
    });
}

void RayPackets::load(const Rays& source, RTCRay8& target) {
    std::memcpy(target.org_x, source.origin[0], sizeof target.org_x);
    std::memcpy(target.org_y, source.origin[1], sizeof target.org_y);
    std::memcpy(target.org_z, source.origin[2], sizeof target.org_z);
    std::memcpy(target.tnear, source.tmin, sizeof target.tnear);
    std::memcpy(target.dir_x, source.direction[0], sizeof target.dir_x);
    std::memcpy(target.dir_y, source.direction[1], sizeof target.dir_y);
    std::memcpy(target.dir_z, source.direction[2], sizeof target.dir_z);
    std::memset(target.time, 0, sizeof target.time);
    std::memcpy(target.tfar, source.tmax, sizeof target.tfar);
    std::memset(target.mask, 0xff, sizeof target.mask);
    std::memset(target.flags, 0, sizeof target.flags);
}

void RayPackets::closest_hit(const EmbreeScene& scene, ThreadPool& pool) {
    for_each_packet(pool, [&](std::size_t i, RTCIntersectContext& context) {
        RTCRayHit8 packet;
        load(rays_[i], packet.ray);
        std::memset(packet.hit.geomID, 0xff, sizeof packet.hit.geomID);  // RTC_INVALID_GEOMETRY_ID
        rtcIntersect8(all_lanes, scene.handle(), &context, &packet);
        Hits& hits = hits_[i];
        std::memcpy(hits.t, packet.ray.tfar, sizeof hits.t);
        std::memcpy(hits.u, packet.hit.u, sizeof hits.u);
        std::memcpy(hits.v, packet.hit.v, sizeof hits.v);
        std::memcpy(hits.primitive, packet.hit.primID, sizeof hits.primitive);
        std::memcpy(hits.geometry, packet.hit.geomID, sizeof hits.geometry);
    });
}

void RayPackets::any_hit(const EmbreeScene& scene, ThreadPool& pool) {
    for_each_packet(pool, [&](std::size_t i, RTCIntersectContext& context) {
        RTCRay8 packet;
        load(rays_[i], packet);
        rtcOccluded8(all_lanes, scene.handle(), &context, &packet);
        std::memcpy(ends_[i].t, packet.tfar, sizeof packet.tfar);
    });
}

std::vector<Hit> RayPackets::hits() const {
    std::vector<Hit> all(ray_count_,
                         {std::numeric_limits<float>::infinity(), 0, 0, SETKA_NO_HIT, SETKA_NO_HIT});
    for (std::size_t i = 0; i < ray_count_; ++i) {
        const Hits& packet = hits_[i / width];
        const std::size_t lane = i % width;
        if (packet.geometry[lane] != RTC_INVALID_GEOMETRY_ID)
            all[i] = {packet.t[lane], packet.u[lane], packet.v[lane], packet.primitive[lane], 0};
    }
    return all;
}

std::vector<std::uint32_t> RayPackets::flags() const {
    std::vector<std::uint32_t> all(ray_count_);
    // Embree sets the end of an occluded ray to -infinity.
    for (std::size_t i = 0; i < ray_count_; ++i) all[i] = ends_[i / width].t[i % width] < 0 ? 1 : 0;
    return all;
}

}  // namespace setka::bench
