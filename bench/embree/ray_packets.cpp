// SPDX-License-Identifier: MIT
/// How are rays handed to Embree? See the header.
#include "bench/embree/ray_packets.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace setka::bench {

namespace {

/// So many rays that taking their packets costs nothing beside tracing them, and so few that all threads end at about the same time.
constexpr std::size_t rays_a_chunk = 1024;

alignas(64) constexpr int all_lanes[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

[[nodiscard]] RTCIntersectContext make_context(Coherence coherence) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherence == Coherence::Coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

/// Embree's records and calls for packets of one width.
template <std::size_t width>
struct Calls;
template <>
struct Calls<8> {
    using PacketOfRays = RTCRay8;
    using PacketOfHits = RTCRayHit8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Calls<16> {
    using PacketOfRays = RTCRay16;
    using PacketOfHits = RTCRayHit16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

template <std::size_t width>
class PacketsOf final : public RayPackets {
  public:
    PacketsOf(std::span<const Ray> rays, Coherence coherence)
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

    [[nodiscard]] std::size_t size() const noexcept override { return ray_count_; }

    void closest_hit(const EmbreeScene& scene, ThreadPool& pool) override {
        for_each_packet(pool, [&](std::size_t i, RTCIntersectContext& context) {
            typename Calls<width>::PacketOfHits packet;
            load(rays_[i], packet.ray);
            std::memset(packet.hit.geomID, 0xff, sizeof packet.hit.geomID);  // RTC_INVALID_GEOMETRY_ID
            Calls<width>::intersect(all_lanes, scene.handle(), &context, &packet);
            Hits& hits = hits_[i];
            std::memcpy(hits.t, packet.ray.tfar, sizeof hits.t);
            std::memcpy(hits.u, packet.hit.u, sizeof hits.u);
            std::memcpy(hits.v, packet.hit.v, sizeof hits.v);
            std::memcpy(hits.primitive, packet.hit.primID, sizeof hits.primitive);
            std::memcpy(hits.geometry, packet.hit.geomID, sizeof hits.geometry);
        });
    }

    void any_hit(const EmbreeScene& scene, ThreadPool& pool) override {
        for_each_packet(pool, [&](std::size_t i, RTCIntersectContext& context) {
            typename Calls<width>::PacketOfRays packet;
            load(rays_[i], packet);
            Calls<width>::occluded(all_lanes, scene.handle(), &context, &packet);
            std::memcpy(ends_[i].t, packet.tfar, sizeof packet.tfar);
        });
    }

    [[nodiscard]] std::vector<Hit> hits() const override {
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

    [[nodiscard]] std::vector<std::uint32_t> flags() const override {
        std::vector<std::uint32_t> all(ray_count_);
        // Embree sets the end of an occluded ray to -infinity.
        for (std::size_t i = 0; i < ray_count_; ++i) all[i] = ends_[i / width].t[i % width] < 0 ? 1 : 0;
        return all;
    }

  private:
    static constexpr std::size_t row_bytes = width * sizeof(float);

    /// Rows of a packet of rays, without those that are the same for all of them.
    struct alignas(row_bytes) Rays {
        float origin[3][width], tmin[width], direction[3][width], tmax[width];
    };
    /// Rows of a packet of hits that make a setka::Hit.
    struct alignas(row_bytes) Hits {
        float t[width], u[width], v[width];
        std::uint32_t primitive[width], geometry[width];
    };
    /// Row tfar of a packet of rays.
    struct alignas(row_bytes) Ends {
        float t[width];
    };

    static void load(const Rays& source, typename Calls<width>::PacketOfRays& target) {
        std::memcpy(target.org_x, source.origin[0], row_bytes);
        std::memcpy(target.org_y, source.origin[1], row_bytes);
        std::memcpy(target.org_z, source.origin[2], row_bytes);
        std::memcpy(target.tnear, source.tmin, row_bytes);
        std::memcpy(target.dir_x, source.direction[0], row_bytes);
        std::memcpy(target.dir_y, source.direction[1], row_bytes);
        std::memcpy(target.dir_z, source.direction[2], row_bytes);
        std::memset(target.time, 0, row_bytes);
        std::memcpy(target.tfar, source.tmax, row_bytes);
        std::memset(target.mask, 0xff, row_bytes);
        std::memset(target.flags, 0, row_bytes);
    }

    template <typename Body>
    void for_each_packet(ThreadPool& pool, const Body& body) {
        pool.for_each_chunk(rays_.size(), rays_a_chunk / width, [&](std::size_t first, std::size_t last) {
            RTCIntersectContext context = make_context(coherence_);
            for (std::size_t i = first; i < last; ++i) body(i, context);
        });
    }

    std::size_t ray_count_;
    Coherence coherence_;
    std::vector<Rays> rays_;
    std::vector<Hits> hits_;
    std::vector<Ends> ends_;
};

}  // namespace

std::size_t packet_width() {
    const std::unique_ptr<std::remove_pointer_t<RTCDevice>, decltype(&rtcReleaseDevice)> device(rtcNewDevice(""),
                                                                                               rtcReleaseDevice);
    if (!device) return 8;  // building the scene says why there is none
    return rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0 ? 16 : 8;
}

std::unique_ptr<RayPackets> make_ray_packets(std::span<const Ray> rays, Coherence coherence, std::size_t width) {
    if (width == 16) return std::make_unique<PacketsOf<16>>(rays, coherence);
    return std::make_unique<PacketsOf<8>>(rays, coherence);
}

}  // namespace setka::bench
