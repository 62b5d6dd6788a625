// SPDX-License-Identifier: MIT
/// What is there to see? Meshes, their placed instances, materials, lights and a camera, as plain host values.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "setka/layout.h"

namespace setka {

using Ray = ::SetkaRay;
using Hit = ::SetkaHit;
using Primitive = ::SetkaPrimitive;
using Bounds = ::SetkaBounds;
using TraceCost = ::SetkaTraceCost;

/// Three packed floats: a point, a direction or a linear RGB colour.
struct Float3 {
    float x = 0, y = 0, z = 0;
    friend bool operator==(const Float3&, const Float3&) = default;
};

/// The vertex indices of a triangle.
struct Triangle {
    std::uint32_t a = 0, b = 0, c = 0;
    friend bool operator==(const Triangle&, const Triangle&) = default;
};

/// An affine map, three rows of four: world = rows * (x, y, z, 1).
struct Matrix34 {
    std::array<float, 12> rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    friend bool operator==(const Matrix34&, const Matrix34&) = default;
};

/// A surface for Whitted shading; colours are linear RGB, 0 to 1 unless said otherwise.
struct Material {
    std::string name;
    Float3 diffuse{0.7f, 0.7f, 0.7f};
    Float3 specular{0.04f, 0.04f, 0.04f};  ///< colour of highlights and of mirror reflection
    Float3 emission{};                     ///< added as it is; may exceed 1
    float shininess = 32;                  ///< Blinn-Phong exponent, 1 to 65536; rounded to the next power of two
    float reflectivity = 0;                ///< share of a mirror ray, 0 to 1
    float transparency = 0;                ///< share of a refracted ray, 0 to 1: 1 is clear glass
    Float3 transmission{1, 1, 1};          ///< tint of the refracted ray
    float refractive_index = 1.5f;         ///< of the inside, relative to the outside; 1 does not bend
};

/// Triangles with their vertices in object space.
struct Mesh {
    std::string name;
    std::vector<Float3> positions;
    std::vector<Triangle> triangles;
    std::vector<Float3> normals;  ///< one per position for smooth shading, or empty for flat shading
    std::vector<Float3> colors;   ///< one per position, linear RGB, by which the material's diffuse colour is multiplied; or empty
};

/// A mesh placed in the world with a material.
struct Instance {
    std::uint32_t mesh = 0;
    Matrix34 transform;
    std::uint32_t material = 0;
    /// Visible to a query whose mask shares a bit with this one. The highest bit is SETKA_MASK_OPAQUE: it is set on the device
    /// according to the material, except where no other bit is set: a mask of 0 hides from every query.
    std::uint32_t mask = 0x7fffffffu;
};

struct PointLight {
    Float3 position;
    Float3 intensity{1, 1, 1};  ///< colour reaching a surface at distance `reference_distance`
    /// Where `intensity` holds; the light falls off with the square of the distance from there. 0: no fall-off.
    float reference_distance = 0;
};

struct DirectionalLight {
    Float3 direction{0, -1, 0};  ///< the way the light travels; any length but 0
    Float3 intensity{1, 1, 1};
};

/// A pinhole camera.
struct Camera {
    Float3 eye{0, 0, 1};
    Float3 target{};
    Float3 up{0, 1, 0};
    float vertical_fov_degrees = 50;  ///< above 0, below 180
};

/// A vertical gradient seen by rays that leave the scene, and the light that comes from everywhere.
struct Background {
    Float3 zenith{0.35f, 0.5f, 0.75f};
    Float3 horizon{0.9f, 0.93f, 0.97f};
    Float3 ground{0.35f, 0.33f, 0.3f};
    float ambient = 0.35f;  ///< how much of the background's colour lights a surface turned to it
};

/// Everything that is rendered. A triangle's number in the scene counts instances in order, each with all triangles of
/// its mesh in order.
struct Scene {
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials;  ///< at least one if there is an instance
    std::vector<PointLight> point_lights;
    std::vector<DirectionalLight> directional_lights;
    std::optional<Camera> camera;
    Background background;

    /// Triangles of all instances; 64-bit, since instances multiply.
    [[nodiscard]] std::uint64_t triangle_count() const noexcept;
    /// The box around all transformed vertices, computed on the host; lower > upper if there is no triangle.
    [[nodiscard]] Bounds bounds() const;
    /// Throws InvalidData that names the first mesh, instance, light or camera that cannot be used: an index out of range, a
    /// non-finite number, a normal count that differs from the position count, a degenerate camera, no triangle at all.
    void validate() const;
};

/// Appends `source` to `target`: meshes, instances, materials and lights with indices moved; the camera if there is none.
void append(Scene& target, Scene source);

/// What moved in a scene: new placements, new vertices, a new camera. Triangles, materials and lights stay.
struct SceneUpdate {
    struct Placement {
        std::uint32_t instance = 0;
        Matrix34 transform;
    };
    struct Vertices {
        std::uint32_t mesh = 0;
        std::vector<Float3> positions;  ///< as many as the mesh has, in its object space
        std::vector<Float3> normals;    ///< as many as the mesh has; empty: those that it has stay
    };
    std::vector<Placement> placements;
    std::vector<Vertices> vertices;
    std::optional<Camera> camera;
};

/// Moves the scene. Throws InvalidArgument, and changes nothing, for an instance or mesh that does not exist, other numbers of
/// positions or normals than the mesh has, a number that is not finite, or a camera that cannot be used.
void apply(Scene& scene, const SceneUpdate& update);

/// A camera that sees the whole box from direction (0.6, 0.35, 1) of its centre, for an image of this width over height.
[[nodiscard]] Camera frame(const Bounds& bounds, float aspect, float vertical_fov_degrees = 50);
/// A camera inside the box, below its middle, looking along its longer horizontal side.
[[nodiscard]] Camera frame_inside(const Bounds& bounds, float vertical_fov_degrees = 65);
/// Lights for a scene without any: a key light over the camera's shoulder and a weak fill light at the eye.
void add_default_lights(Scene& scene, const Camera& camera);

}  // namespace setka
