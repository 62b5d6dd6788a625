// SPDX-License-Identifier: MIT
/// Which transforms, camera and lights does an imported scene have? Those that are usable, in world space.
#include "io/assimp_objects.hpp"

#include <assimp/light.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>

#include "core/exact_math.hpp"
#include "io/file.hpp"

namespace setka::io::detail {

namespace {

/// More light than this at the middle of the scene is taken for physical units.
constexpr double max_brightness = 2;

aiMatrix4x4 world_transform(const aiScene& source, const aiString& name) {
    aiMatrix4x4 transform;
    for (const aiNode* node = source.mRootNode->FindNode(name); node; node = node->mParent)
        transform = node->mTransformation * transform;
    return transform;
}

Float3 to_float3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

bool is_usable(const aiVector3D& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// A direction of length 1, or zero if it has none.
aiVector3D unit(const aiVector3D& v) {
    const float length = std::sqrt(v.SquareLength());
    return std::isfinite(length) && length > 0 ? aiVector3D(v.x / length, v.y / length, v.z / length)
                                               : aiVector3D();
}

double brightness(const Float3& intensity) { return std::max({intensity.x, intensity.y, intensity.z}); }

/// The light that reaches the middle of the scene.
double total_brightness(const Scene& scene) {
    const Bounds bounds = scene.bounds();
    double total = 0;
    for (const DirectionalLight& light : scene.directional_lights) total += brightness(light.intensity);
    for (const PointLight& light : scene.point_lights) {
        const float position[3] = {light.position.x, light.position.y, light.position.z};
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double distance = position[axis] - (double(bounds.lower[axis]) + bounds.upper[axis]) / 2;
            square += distance * distance;
        }
        if (square > 0) total += brightness(light.intensity) / square;
    }
    return total;
}

}  // namespace

std::optional<Camera> place_camera(const aiMatrix4x4& world, double vertical_fov) {
    const aiMatrix3x3 linear(world);
    const aiVector3D eye = world * aiVector3D(0, 0, 0);
    const aiVector3D view = unit(linear * aiVector3D(0, 0, -1)), up = unit(linear * aiVector3D(0, 1, 0));
    Camera camera;
    camera.eye = to_float3(eye);
    // As far away as the origin: one unit would be rounded away beside large coordinates.
    const float distance = std::max(1.0f, std::sqrt(eye.SquareLength()));
    camera.target = to_float3(eye + view * distance);
    camera.up = to_float3(up);
    camera.vertical_fov_degrees = static_cast<float>(vertical_fov * 180 / exact::pi);
    const bool usable = is_usable(eye) && view.SquareLength() > 0 && (view ^ up).SquareLength() > 1e-8f &&
                        camera.target != camera.eye && camera.vertical_fov_degrees > 0 &&
                        camera.vertical_fov_degrees < 180;
    return usable ? std::optional(camera) : std::nullopt;
}

Matrix34 take_transform(const std::filesystem::path& file, const aiMatrix4x4& matrix, const aiNode& node) {
    const auto fail = [&](const char* reason) {
        fail_read(file, "the transform of node " + in_quotes(node.mName.C_Str(), 60) + reason);
    };
    // Nodes may project as far as the format knows; instances cannot.
    if (matrix.d1 != 0 || matrix.d2 != 0 || matrix.d3 != 0 || matrix.d4 != 1)
        fail(" is not affine: its last row must be 0 0 0 1");
    Matrix34 transform;
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned column = 0; column < 4; ++column) {
            if (!std::isfinite(matrix[row][column])) fail(" is not finite");
            transform.rows[row * 4 + column] = matrix[row][column];
        }
    return transform;
}

std::optional<Camera> take_camera(const aiScene& source, std::span<const GltfCamera> cameras) {
    for (const GltfCamera& camera : cameras) {
        const aiString node("node " + std::to_string(camera.node));
        if (const auto placed = place_camera(world_transform(source, node), camera.vertical_fov))
            return placed;
    }
    return std::nullopt;
}

void take_lights(const aiScene& source, Scene& scene) {
    for (unsigned i = 0; i < source.mNumLights; ++i) {
        const aiLight& light = *source.mLights[i];
        const aiMatrix4x4 world = world_transform(source, light.mName);
        const aiVector3D position = world * light.mPosition;
        const aiVector3D direction = unit(aiMatrix3x3(world) * light.mDirection);
        const Float3 intensity{light.mColorDiffuse.r, light.mColorDiffuse.g, light.mColorDiffuse.b};
        if (!std::isfinite(brightness(intensity)) || brightness(intensity) <= 0) continue;
        if (light.mType == aiLightSource_DIRECTIONAL && direction.SquareLength() > 0)
            scene.directional_lights.push_back({to_float3(direction), intensity});
        else if ((light.mType == aiLightSource_POINT || light.mType == aiLightSource_SPOT) &&
                 is_usable(position))
            scene.point_lights.push_back({to_float3(position), intensity, 1});
    }
    const double total = total_brightness(scene);
    if (!(total > max_brightness) || !std::isfinite(total)) return;
    const auto dim = [&](Float3& c) {
        for (float* channel : {&c.x, &c.y, &c.z}) *channel = static_cast<float>(*channel / total);
    };
    for (PointLight& light : scene.point_lights) dim(light.intensity);
    for (DirectionalLight& light : scene.directional_lights) dim(light.intensity);
}

}  // namespace setka::io::detail
