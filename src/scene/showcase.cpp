// SPDX-License-Identifier: MIT
/// What does setka show on its front page? A grid, which is what the name means: columns that rise into a
/// wave around a mirror ball, a glass ball, a golden knot and a spiral of beads.
#include "scene/showcase.hpp"

#include <algorithm>
#include <cmath>
#include <span>

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

/// The colour at t of stops that are evenly spread from 0 to 1.
[[nodiscard]] Float3 ramp(std::span<const Float3> stops, double t) {
    const auto last = static_cast<int>(stops.size()) - 1;
    const double position = std::clamp(t, 0.0, 1.0) * last;
    const int stop = std::min(static_cast<int>(position), last - 1);
    const auto at = static_cast<std::size_t>(stop);
    return mix(stops[at], stops[at + 1], position - stop);
}

/// Deep water to foam to sand: t from 0 to 1.
[[nodiscard]] Float3 wave_colour(double t) {
    constexpr Float3 stops[] = {{0.045f, 0.15f, 0.24f},
                                {0.05f, 0.31f, 0.39f},
                                {0.27f, 0.56f, 0.55f},
                                {0.82f, 0.76f, 0.60f},
                                {0.88f, 0.50f, 0.24f}};
    return ramp(stops, t);
}

/// Coral to amber to raspberry to violet: t from 0 to 1.
[[nodiscard]] Float3 bead_colour(double t) {
    constexpr Float3 stops[] = {{0.80f, 0.16f, 0.10f},
                                {0.90f, 0.42f, 0.08f},
                                {0.92f, 0.66f, 0.16f},
                                {0.80f, 0.16f, 0.30f},
                                {0.36f, 0.16f, 0.62f}};
    return ramp(stops, t);
}

/// How high the column at (x, z) reaches: level around the centre, then waves that grow with the distance and
/// stay below `highest_column`.
constexpr double highest_column = 3.4;
[[nodiscard]] double wave_height(double x, double z) {
    const double distance = std::sqrt(x * x + z * z);
    const double beyond = std::max(distance - 4.4, 0.0);
    const double growth = highest_column * beyond / (beyond + 3.5);
    const double ripple = exact::sin_cos(1.3 * distance - 0.5 * x).sin;
    const double behind = std::clamp(0.62 - z / 11, 0.1, 1.0);  // the camera looks over the columns in front
    return growth * (0.72 + 0.28 * ripple) * behind;
}

void add_columns(Stage& stage) {
    constexpr int per_side = 44;
    constexpr double pitch = 0.5;
    constexpr int tones = 24;
    constexpr float half_height = 1;
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
                std::clamp(static_cast<int>(height / highest_column * tones) + 3 * checker, 0, tones - 1);
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
    stage.place(ball, stage.add(glass), {.scale = 0.85, .position = {0.35, 0.85, 1.75}});
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
    constexpr int count = 90;
    constexpr int hues = 30;
    const std::uint32_t mesh = stage.add(shapes::sphere(8));
    std::uint32_t first_material = 0;
    for (int hue = 0; hue < hues; ++hue) {
        Material material;
        material.name = "bead hue " + std::to_string(hue);
        material.diffuse = bead_colour(static_cast<double>(hue) / (hues - 1));
        material.specular = {0.6f, 0.6f, 0.6f};
        material.shininess = 256;
        material.reflectivity = 0.12f;
        const std::uint32_t index = stage.add(std::move(material));
        if (hue == 0) first_material = index;
    }
    for (int k = 0; k < count; ++k) {
        // Around everything on the floor, then up and inwards.
        const double t = static_cast<double>(k) / (count - 1);
        const auto [sin, cos] = exact::sin_cos((168 - 410 * t) * degrees);
        const double rise = std::max(t - 0.3, 0.0) / 0.7;
        const double radius = 4.05 - 1.5 * rise * rise;
        const double height = 0.15 + 3.8 * rise * rise * (3 - 2 * rise);
        stage.place(mesh, first_material + static_cast<std::uint32_t>(k * hues / count),
                    {.scale = 0.15 - 0.06 * t, .position = {radius * cos, height, radius * sin - 0.2}});
    }
}

}  // namespace

Scene make_showcase() {
    Stage stage;
    add_columns(stage);
    add_bodies(stage);
    add_beads(stage);

    Scene scene = std::move(stage.scene);
    scene.directional_lights.push_back({{0.8f, -1.0f, -0.3f}, {1.05f, 0.95f, 0.8f}});
    scene.point_lights.push_back({{5, 6, 8}, {0.2f, 0.24f, 0.32f}, 9});
    Background& sky = scene.background;
    sky.zenith = {0.05f, 0.20f, 0.52f};
    sky.horizon = {0.95f, 0.79f, 0.63f};
    sky.ground = {0.10f, 0.12f, 0.15f};
    sky.ambient = 0.4f;
    scene.camera = Camera{{3.3f, 3.7f, 9.4f}, {0.1f, 1.05f, -0.4f}, {0, 1, 0}, 36};
    return scene;
}

}  // namespace setka
