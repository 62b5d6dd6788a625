// SPDX-License-Identifier: MIT
/// How do a scene's materials and lights, and the curves of a picture, become tables? Only exact arithmetic:
/// the same tables on every machine.
#include "trace/shading_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/exact_math.hpp"

namespace setka {

static_assert(sizeof(SkCamera) == 64);
static_assert(sizeof(SkMaterial) == 64);
static_assert(sizeof(SkLight) == 32);
static_assert(sizeof(SkBackground) == 40);
static_assert(sizeof(SkSurfacePoint) == 76);

namespace {

void store(float (&target)[3], const Float3& value) {
    target[0] = value.x;
    target[1] = value.y;
    target[2] = value.z;
}

/// Squarings that raise to the exponent, rounded up to a power of two; 65536 at most.
std::uint32_t squarings(float exponent) {
    std::uint32_t count = 0;
    while (count < 16 && static_cast<float>(1u << count) < exponent) ++count;
    return count;
}

}  // namespace

std::vector<SkMaterial> make_material_table(const std::vector<Material>& materials) {
    std::vector<SkMaterial> table(materials.size());
    std::transform(materials.begin(), materials.end(), table.begin(), [](const Material& material) {
        SkMaterial entry{};
        store(entry.diffuse, material.diffuse);
        store(entry.specular, material.specular);
        store(entry.emission, material.emission);
        store(entry.transmission, material.transmission);
        entry.reflectivity = material.reflectivity;
        entry.transparency = material.transparency;
        entry.refractive_index = material.refractive_index > 0 ? material.refractive_index : 1.0f;
        entry.squarings = squarings(material.shininess);
        return entry;
    });
    return table;
}

std::vector<SkLight> make_light_table(const DeviceScene& scene) {
    std::vector<SkLight> table;
    table.reserve(scene.point_lights().size() + scene.directional_lights().size());
    for (const PointLight& light : scene.point_lights()) {
        SkLight entry{};
        store(entry.place, light.position);
        store(entry.intensity, light.intensity);
        entry.kind = SK_LIGHT_POINT;
        entry.reference_distance = light.reference_distance;
        table.push_back(entry);
    }
    for (const DirectionalLight& light : scene.directional_lights()) {
        const double x = light.direction.x, y = light.direction.y, z = light.direction.z;
        const double length = std::sqrt(x * x + y * y + z * z);
        SkLight entry{};
        store(entry.place, {static_cast<float>(-x / length), static_cast<float>(-y / length),
                            static_cast<float>(-z / length)});
        store(entry.intensity, light.intensity);
        entry.kind = SK_LIGHT_DIRECTIONAL;
        table.push_back(entry);
    }
    return table;
}

SkBackground make_background(const Background& background) {
    SkBackground entry{};
    store(entry.zenith, background.zenith);
    store(entry.horizon, background.horizon);
    store(entry.ground, background.ground);
    entry.ambient = background.ambient;
    return entry;
}

bool any_transparent(const std::vector<Material>& materials) {
    return std::any_of(materials.begin(), materials.end(),
                       [](const Material& m) { return m.transparency > 0; });
}

bool any_onward(const std::vector<Material>& materials) {
    return std::any_of(materials.begin(), materials.end(),
                       [](const Material& m) { return m.reflectivity != 0 || m.transparency != 0; });
}

const std::array<float, 255>& srgb_thresholds() {
    static const std::array<float, 255> thresholds = [] {
        std::array<float, 255> made{};
        for (int code = 1; code <= 255; ++code)
            made[code - 1] = static_cast<float>(exact::srgb_to_linear((code - 0.5) / 255));
        return made;
    }();
    return thresholds;
}

std::vector<float> make_heat_ramp() {
    constexpr int knots[][3] = {{8, 8, 28},    {40, 22, 92},   {92, 28, 122},  {148, 38, 110}, {200, 56, 78},
                                {236, 92, 42}, {250, 146, 22}, {248, 204, 58}, {255, 252, 208}};
    std::vector<float> ramp;
    for (const auto& knot : knots)
        for (const int code : knot) ramp.push_back(static_cast<float>(exact::srgb_to_linear(code / 255.0)));
    return ramp;
}

std::vector<float> make_depth_ramp() { return {1, 1, 1, 0, 0, 0}; }

}  // namespace setka
