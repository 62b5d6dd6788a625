// SPDX-License-Identifier: MIT
/// What does Embree build? See the header.
#include "bench/embree/embree_scene.hpp"

#include <algorithm>

#include "scene/transform.hpp"
#include "setka/error.hpp"

namespace setka::bench {

namespace {

[[nodiscard]] bool count_bytes(void* monitor, ssize_t bytes, bool /*is_past*/) {
    static_cast<MemoryMonitor*>(monitor)->add(bytes);
    return true;
}

[[nodiscard]] RTCBuildQuality build_quality(EmbreeQuality quality) {
    return quality == EmbreeQuality::Low ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

}  // namespace

void MemoryMonitor::add(std::int64_t bytes) noexcept {
    const std::int64_t now = in_use_.fetch_add(bytes) + bytes;
    for (std::int64_t peak = peak_; peak < now && !peak_.compare_exchange_weak(peak, now);) {
    }
}

EmbreeScene::EmbreeScene(const Scene& scene, EmbreeQuality quality) : device_(rtcNewDevice("")) {
    if (!device_)
        throw Error(ErrorCategory::Unsupported,
                    "rtcNewDevice gives no device, but error " + std::to_string(rtcGetDeviceError(nullptr)));
    rtcSetDeviceMemoryMonitorFunction(device_.get(), count_bytes, memory_.get());
    geometry_.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    check("rtcNewGeometry");
    rtcSetGeometryBuildQuality(geometry_.get(), build_quality(quality));
    float* const vertices = set_mesh(scene);
    const std::vector<float> positions(vertices, vertices + 3 * vertex_count_);
    // Along one axis, by more than the scene is long: every ray of the standard view then misses.
    const Bounds bounds = scene.bounds();
    const float away = 4 * (bounds.upper[0] - bounds.lower[0]) + 4 * (bounds.upper[1] - bounds.lower[1]) +
                       4 * (bounds.upper[2] - bounds.lower[2]);
    for (std::uint64_t i = 0; i < vertex_count_; ++i) vertices[3 * i + 1] -= away;
    rtcCommitGeometry(geometry_.get());

    scene_.reset(rtcNewScene(device_.get()));
    check("rtcNewScene");
    rtcSetSceneBuildQuality(scene_.get(), build_quality(quality));
    if (quality == EmbreeQuality::Low) rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_DYNAMIC);
    rtcAttachGeometry(scene_.get(), geometry_.get());
    rtcCommitScene(scene_.get());
    check("rtcCommitScene");
    std::ranges::copy(positions, vertices);
    rebuild();
}

void EmbreeScene::rebuild() {
    rtcUpdateGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry_.get());
    rtcCommitScene(scene_.get());
    check("rtcCommitScene");
}

void EmbreeScene::check(const char* call) const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw Error(ErrorCategory::OutOfMemory, std::string(call) + ": Embree is out of memory");
    throw Error(ErrorCategory::DeviceFailed, std::string(call) + ": Embree's error " + std::to_string(error));
}

float* EmbreeScene::set_mesh(const Scene& scene) {
    for (const Instance& instance : scene.instances) {
        vertex_count_ += scene.meshes[instance.mesh].positions.size();
        triangle_count_ += scene.meshes[instance.mesh].triangles.size();
    }
    void* const vertex_buffer = rtcSetNewGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                        RTC_FORMAT_FLOAT3, sizeof(Float3), vertex_count_);
    void* const index_buffer = rtcSetNewGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_INDEX, 0,
                                                       RTC_FORMAT_UINT3, sizeof(Triangle), triangle_count_);
    check("rtcSetNewGeometryBuffer");
    auto* vertex = static_cast<Float3*>(vertex_buffer);
    auto* triangle = static_cast<Triangle*>(index_buffer);
    std::uint32_t first = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (const Float3& p : mesh.positions) *vertex++ = transform_point(instance.transform, p);
        for (const Triangle& t : mesh.triangles) *triangle++ = {first + t.a, first + t.b, first + t.c};
        first += static_cast<std::uint32_t>(mesh.positions.size());
    }
    return static_cast<float*>(vertex_buffer);
}

}  // namespace setka::bench
