// SPDX-License-Identifier: MIT
/// What does setka show on its front page? A grid, which is what the name means: columns that rise into a
/// wave around a mirror ball, a glass ball, a golden knot and a spiral of beads.
#include "scene/showcase.hpp"

#include <algorithm>
#include <cmath>

#include "core/exact_math.hpp"
#include "scene/shapes.hpp"
#include "scene/vector.hpp"

namespace setka {

namespace {

constexpr double degrees = exact::pi / 180;

/// A uniform scale, a turn around y after a tilt around x, then a move.
struct Placement {
    double scale = 1, tilt_degrees = 0, turn_degrees = 0;
    glm::dvec3 position{0};
};

[[nodiscard]] Matrix34 to_matrix(const Placement& p) {
    const auto [st, ct] = exact::sin_cos(p.tilt_degrees * degrees);
    const auto [sy, cy] = exact::sin_cos(p.turn_degrees * degrees);
    const double rows[3][3] = {{cy, sy * st, sy * ct}, {0, ct, -st}, {-sy, cy * st, cy * ct}};
    Matrix34 matrix;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            matrix.rows[4 * row + column] = static_cast<float>(p.scale * rows[row][column]);
        matrix.rows[4 * row + 3] = static_cast<float>(p.position[row]);
    }
    return matrix;
}

/// The scene while it is put together.
class Stage {
  public:
    [[nodiscard]] std::uint32_t add(Mesh mesh) {
        scene.meshes.push_back(std::move(mesh));
        return static_cast<std::uint32_t>(scene.meshes.size() - 1);
    }
    [[nodiscard]] std::uint32_t add(Material material) {
        scene.materials.push_back(std::move(material));
        return static_cast<std::uint32_t>(scene.materials.size() - 1);
    }
    void place(std::uint32_t mesh, std::uint32_t material, const Placement& placement) {
        scene.instances.push_back({mesh, to_matrix(placement), material});
    }

    Scene scene;
};

/// From a (t = 0) to b (t = 1).
[[nodiscard]] Float3 mix(const Float3& a, const Float3& b, double t) {
    return to_float3(to_glm(a) * (1 - t) + to_glm(b) * t);
}

/// Deep water to foam to sand: t from 0 to 1.
[[nodiscard]] Float3 wave_colour(double t) {
    constexpr Float3 stops[] = {{0.035f, 0.11f, 0.19f},
                                {0.04f, 0.27f, 0.36f},
                                {0.25f, 0.55f, 0.55f},
                                {0.80f, 0.76f, 0.62f},
                                {0.86f, 0.50f, 0.26f}};
    const double position = std::clamp(t, 0.0, 1.0) * 4;
    const int stop = std::min(static_cast<int>(position), 3);
    return mix(stops[stop], stops[stop + 1], position - stop);
}

/// All hues in turn, t from 0 to 1: three cosines a third of a period apart.
[[nodiscard]] Float3 bead_colour(double t) {
    const auto channel = [&](double phase) {
        return static_cast<float>(0.45 + 0.4 * exact::sin_cos(2 * exact::pi * (t + phase)).cos);
    };
    return {channel(0), channel(2.0 / 3), channel(1.0 / 3)};
}

/// How high the column at (x, z) reaches: level around the centre, then waves that grow with the distance.
[[nodiscard]] double wave_height(double x, double z) {
    const double distance = std::sqrt(x * x + z * z);
    const double beyond = std::max(distance - 4.2, 0.0);
    const double growth = beyond * beyond / (beyond + 2.5);
    const double ripple = exact::sin_cos(1.25 * distance - 0.35 * x).sin;
    const double behind = std::clamp(0.5 - z / 12, 0.12, 1.0);  // the camera looks over the columns in front
    return growth * (0.55 + 0.3 * ripple) * behind;
}

void add_columns(Stage& stage) {
    constexpr int per_side = 44;
    constexpr double pitch = 0.5;
    constexpr int tones = 24;
    constexpr float half_height = 3;
    constexpr double highest = 3.2;
    const std::uint32_t mesh = stage.add(shapes::rounded_box({0.235f, half_height, 0.235f}, 0.05, 2));
    std::uint32_t first_material = 0;
    for (int tone = 0; tone < tones; ++tone) {
        Material material;
        material.name = "column tone " + std::to_string(tone);
        material.diffuse = wave_colour(static_cast<double>(tone) / (tones - 1));
        material.specular = {0.2f, 0.2f, 0.2f};
        material.shininess = 64;
        material.reflectivity = 0.08f;
        const std::uint32_t index = stage.add(std::move(material));
        if (tone == 0) first_material = index;
    }
    for (int i = 0; i < per_side; ++i)
        for (int j = 0; j < per_side; ++j) {
            const double x = (i - 0.5 * (per_side - 1)) * pitch;
            const double z = (j - 0.5 * (per_side - 1)) * pitch - 2;
            const double height = wave_height(x, z);
            const int checker = (i + j) % 2;  // a hint of a chessboard where the field is level
            const int tone =
                std::clamp(static_cast<int>(height / highest * tones) + 3 * checker, 0, tones - 1);
            stage.place(mesh, first_material + static_cast<std::uint32_t>(tone),
                        {.position = {x, height - half_height, z}});
        }
}

void add_bodies(Stage& stage) {
    Material mirror;
    mirror.name = "mirror";
    mirror.diffuse = {0.02f, 0.02f, 0.02f};
    mirror.specular = {0.95f, 0.95f, 0.97f};
    mirror.shininess = 2048;
    mirror.reflectivity = 0.95f;

    Material glass;
    glass.name = "glass";
    glass.diffuse = {0, 0, 0};
    glass.specular = {1, 1, 1};
    glass.shininess = 2048;
    glass.reflectivity = 0.08f;
    glass.transparency = 0.92f;
    glass.transmission = {0.94f, 1.0f, 0.97f};
    glass.refractive_index = 1.5f;

    Material gold;
    gold.name = "gold";
    gold.diffuse = {0.52f, 0.30f, 0.07f};
    gold.specular = {1.0f, 0.78f, 0.34f};
    gold.shininess = 128;
    gold.reflectivity = 0.4f;

    const std::uint32_t ball = stage.add(shapes::sphere(48));
    stage.place(ball, stage.add(mirror), {.scale = 1.4, .position = {-1.5, 1.4, -1.1}});
    stage.place(ball, stage.add(glass), {.scale = 0.85, .position = {0.55, 0.85, 1.7}});
    const std::uint32_t knot = stage.add(shapes::torus_knot({.p = 2,
                                                             .q = 3,
                                                             .radius = 0.85,
                                                             .knot_radius = 0.36,
                                                             .tube_radius = 0.17,
                                                             .along = 640,
                                                             .across = 40}));
    stage.place(knot, stage.add(gold),
                {.tilt_degrees = 72, .turn_degrees = -24, .position = {2.25, 1.36, -0.5}});
}

void add_beads(Stage& stage) {
    constexpr int count = 150;
    constexpr int hues = 30;
    const std::uint32_t mesh = stage.add(shapes::sphere(8));
    std::uint32_t first_material = 0;
    for (int hue = 0; hue < hues; ++hue) {
        Material material;
        material.name = "bead hue " + std::to_string(hue);
        material.diffuse = bead_colour(static_cast<double>(hue) / hues);
        material.specular = {0.6f, 0.6f, 0.6f};
        material.shininess = 256;
        material.reflectivity = 0.12f;
        const std::uint32_t index = stage.add(std::move(material));
        if (hue == 0) first_material = index;
    }
    for (int k = 0; k < count; ++k) {
        const double t = static_cast<double>(k) / (count - 1);
        const auto [sin, cos] = exact::sin_cos(2 * exact::pi * (2.6 * t) + 2.2);
        const double radius = 3.9 - 2.6 * t;
        const double height = 0.16 + 4.3 * t * t * (1.35 - 0.35 * t);
        stage.place(mesh, first_material + static_cast<std::uint32_t>(k * hues / count),
                    {.scale = 0.145 - 0.05 * t, .position = {radius * cos, height, radius * sin - 0.4}});
    }
}

}  // namespace

Scene make_showcase() {
    Stage stage;
    add_columns(stage);
    add_bodies(stage);
    add_beads(stage);

    Scene scene = std::move(stage.scene);
    scene.directional_lights.push_back({{0.8f, -1.0f, -0.25f}, {0.95f, 0.86f, 0.74f}});
    scene.point_lights.push_back({{6, 6, 7}, {0.16f, 0.2f, 0.28f}, 9});
    Background& sky = scene.background;
    sky.zenith = {0.16f, 0.30f, 0.55f};
    sky.horizon = {0.93f, 0.80f, 0.68f};
    sky.ground = {0.10f, 0.12f, 0.15f};
    sky.ambient = 0.32f;
    scene.camera = Camera{{3.6f, 3.9f, 9.6f}, {0.15f, 1.15f, -0.6f}, {0, 1, 0}, 38};
    return scene;
}

}  // namespace setka
