// SPDX-License-Identifier: MIT
/// Does light arrive where it should, as much as it should, and nowhere else?
#include <cmath>

#include "fixture.hpp"

namespace setka::render_test {
namespace {

constexpr Float3 white{1, 1, 1};

/// A floor at height 0, seen from straight above: pixel (x, y) of 64 shows (x - 31.5, y - 31.5) * half_size
/// / 32.
Scene floor_from_above(float half_size) {
    Scene scene = dark_scene();
    add(scene, quad({0, 0, 0}, {0, 0, 2 * half_size}, {2 * half_size, 0, 0}), matte(white));
    scene.camera = look({0, half_size, 0}, {0, 0, 0}, 90, {0, 0, -1});
    return scene;
}

float floor_coordinate(std::uint32_t pixel, float half_size) {
    return (static_cast<float>(pixel) - 31.5f) * half_size / 32;
}

TEST_F(Render, DirectionalLightFollowsLambert) {
    Scene scene = floor_from_above(1);
    scene.directional_lights.push_back({{-3, -4, 0}, {1, 0.5f, 0.25f}});
    const Picture picture = render(scene);
    for (const Float3& colour : picture.image.linear) ASSERT_TRUE(near(colour, {0.8f, 0.4f, 0.2f}, 1e-6f));
    EXPECT_EQ(picture.statistics.shadow_rays, 64u * 64);
}

TEST_F(Render, VertexColoursMultiplyTheDiffuseColour) {
    Scene scene = floor_from_above(1);
    scene.background = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, 0.5f};  // ambient light as well
    scene.directional_lights.push_back({{0, -1, 0}, {0.5f, 0.5f, 0.5f}});
    scene.materials[0].diffuse = {0.8f, 0.4f, 0.6f};
    const Float3 plain = render(scene).at(32, 32);
    scene.meshes[0].colors.assign(4, {0.5f, 0.25f, 0});
    const Float3 tinted = render(scene).at(32, 32);
    EXPECT_NEAR(tinted.x, 0.5f * plain.x, 1e-6);
    EXPECT_NEAR(tinted.y, 0.25f * plain.y, 1e-6);
    EXPECT_EQ(tinted.z, 0);
    scene.meshes[0].colors.assign(4, {1, 1, 1});
    EXPECT_NEAR(render(scene).at(32, 32).x, plain.x, 1e-6);

    for (std::size_t i = 0; i < 4; ++i)
        scene.meshes[0].colors[i] = scene.meshes[0].positions[i].x < 0 ? Float3{1, 0, 0} : Float3{0, 1, 0};
    const Picture blend = render(scene);  // of a floor that reaches from -2 to 2
    for (const std::uint32_t x : {8u, 20u, 32u, 60u}) {
        const float green = 0.5f + floor_coordinate(x, 1) / 4;
        EXPECT_NEAR(blend.at(x, 32).x, plain.x * (1 - green), 1e-5) << x;
        EXPECT_NEAR(blend.at(x, 32).y, plain.y * green, 1e-5) << x;
    }
}

TEST_F(Render, PointLightFallsOffWithTheSquare) {
    Scene scene = floor_from_above(1);
    scene.point_lights.push_back({{0.25f, 0.5f, 0}, {1, 2, 3}, 2});
    scene.point_lights.push_back({{0, 3, 0}, {0.125f, 0, 0}, 0});
    const Picture picture = render(scene);
    for (std::uint32_t y = 0; y < 64; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            const float px = floor_coordinate(x, 1) - 0.25f, pz = floor_coordinate(y, 1), qx = px + 0.25f;
            const float d = std::sqrt(px * px + 0.25f + pz * pz), e = std::sqrt(qx * qx + 9 + pz * pz);
            const float expected = 0.5f / d * 4 / (d * d), steady = 0.125f * 3 / e;
            ASSERT_TRUE(near(picture.at(x, y), {expected + steady, 2 * expected, 3 * expected}, 2e-3f))
                << x << " " << y;
        }
    }
}

TEST_F(Render, HighlightIsBlinnPhong) {
    Scene scene = floor_from_above(1);
    scene.materials[0].diffuse = black;
    scene.materials[0].specular = {1, 0.5f, 0.25f};
    scene.materials[0].shininess = 50;  // rounded to 64
    scene.directional_lights.push_back({{0, -1, 0}, white});
    const Picture picture = render(scene);
    for (std::uint32_t x = 0; x < 64; ++x) {
        const float px = floor_coordinate(x, 1), pz = floor_coordinate(20, 1);
        const float length = std::sqrt(px * px + pz * pz + 1);
        // The halfway vector of up and the viewer.
        const float hx = -px / length, hy = 1 / length + 1, hz = -pz / length;
        const float expected = std::pow(hy / std::sqrt(hx * hx + hy * hy + hz * hz), 64.0f);
        ASSERT_TRUE(near(picture.at(x, 20), {expected, expected / 2, expected / 4}, 1e-4f)) << x;
    }
}

TEST_F(Render, NothingIsLitFromBehind) {
    Scene scene = floor_from_above(1);
    scene.directional_lights.push_back({{0, 1, 0}, white});
    const Picture picture = render(scene);
    for (const Float3& colour : picture.image.linear) ASSERT_EQ(colour, black);
    EXPECT_EQ(picture.statistics.shadow_rays, 0u);
}

TEST_F(Render, AmbientLightFollowsTheNormal) {
    Scene scene = floor_from_above(1);
    scene.background = {{0.1f, 0.2f, 0.3f}, {1, 1, 1}, {0.5f, 0.5f, 0.5f}, 0.5f};
    scene.materials[0].diffuse = {1, 0.5f, 0.25f};
    EXPECT_TRUE(near(render(scene).at(31, 31), {0.05f, 0.05f, 0.0375f}, 1e-6f));
    // From below: two-sided.
    scene.camera = look({0, -1, 0}, {0, 0, 0}, 90, {0, 0, -1});
    EXPECT_TRUE(near(render(scene).at(31, 31), {0.25f, 0.125f, 0.0625f}, 1e-6f));
}

/// How many pixels of the middle row and column are dark, and where: a 1 x 1 plate at height 2 over x = -2.
struct Shadow {
    std::uint32_t first_x = 64, last_x = 0, first_y = 64, last_y = 0, count = 0;
};
Shadow shadow_in(const Picture& picture) {
    Shadow s;
    for (std::uint32_t y = 0; y < 64; ++y) {
        for (std::uint32_t x = 0; x < 64; ++x) {
            if (picture.at(x, y).x > 0) continue;
            s.first_x = std::min(s.first_x, x);
            s.last_x = std::max(s.last_x, x);
            s.first_y = std::min(s.first_y, y);
            s.last_y = std::max(s.last_y, y);
            ++s.count;
        }
    }
    return s;
}

TEST_F(Render, ShadowsLieWhereTheyShould) {
    // Light travels along (1, -1, 0): the plate at x = -2.5 to -1.5 and height 2 darkens x = -0.5 to 0.5. The
    // camera at height 4 sees 8 x 8, eight pixels a unit, and the plate itself at x = -5 to -3.
    Scene scene = floor_from_above(4);
    add(scene, quad({-2, 2, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}), glowing(white));
    scene.directional_lights.push_back({{1, -1, 0}, white});
    const Shadow shadow = shadow_in(render(scene));
    EXPECT_EQ(shadow.first_x, 28u);
    EXPECT_EQ(shadow.last_x, 35u);
    EXPECT_EQ(shadow.first_y, 28u);
    EXPECT_EQ(shadow.last_y, 35u);
    EXPECT_EQ(shadow.count, 64u);

    // A point light at (-4, 4, 0): the same plate throws a shadow of twice its size around the origin.
    scene.directional_lights.clear();
    scene.point_lights.push_back({{-4, 4, 0}, white, 0});
    const Shadow wide = shadow_in(render(scene));
    EXPECT_EQ(wide.first_x, 24u);
    EXPECT_EQ(wide.last_x, 39u);
    EXPECT_EQ(wide.first_y, 24u);
    EXPECT_EQ(wide.last_y, 39u);

    // Nothing beyond the light throws a shadow.
    scene.point_lights = {{{0, 1, 0}, white, 0}};
    EXPECT_EQ(shadow_in(render(scene)).count, 0u);
}

TEST_F(Render, HiddenInstancesThrowNoShadow) {
    Scene scene = floor_from_above(4);
    add(scene, quad({-2, 2, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}), matte(white)).mask = 2;
    scene.directional_lights.push_back({{1, -1, 0}, white});
    RenderOptions options{.width = 64, .height = 64};
    options.trace.mask = 1;
    EXPECT_EQ(shadow_in(render(scene, options)).count, 0u);
    options.trace.mask = 2;
    EXPECT_EQ(render(scene, options).at(32, 32), black);  // the background: the floor has all bits
    options.trace.mask = 3;
    EXPECT_EQ(shadow_in(render(scene, options)).count, 64u);
}

TEST_F(Render, TransparentThingsThrowPaleShadows) {
    Scene scene = floor_from_above(4);
    add(scene, quad({-2, 2, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}), glass(1));
    scene.directional_lights.push_back({{0.6f, -0.6f, 0}, white});
    const Picture pale = render(scene);
    const float full = std::sqrt(0.5f);
    EXPECT_TRUE(near(pale.at(48, 32), {full, full, full}, 1e-6f));
    EXPECT_TRUE(near(pale.at(32, 32), {0.75f * full, 0.75f * full, 0.75f * full}, 1e-6f));
    EXPECT_TRUE(near(pale.at(28, 28), pale.at(32, 32), 1e-6f));
    EXPECT_TRUE(near(pale.at(27, 28), pale.at(48, 32), 1e-6f));

    // What is opaque behind glass still darkens.
    add(scene, quad({-1, 1, 0}, {0, 0, 0.25f}, {0.25f, 0, 0}), glowing(white));
    const Picture dark = render(scene);
    EXPECT_EQ(dark.at(32, 32), black);
    EXPECT_TRUE(near(dark.at(28, 28), pale.at(28, 28), 1e-6f));
}

/// A ball on a floor, both opaque, in the light of one direction.
Scene ball_on_floor(double scale, const Float3& at, int rings, double floor) {
    const auto s = [&](double v) { return static_cast<float>(v * scale); };
    const auto p = [&](double x, double y, double z) {
        return Float3{at.x + s(x), at.y + s(y), at.z + s(z)};
    };
    Scene scene = dark_scene();
    add(scene, quad(p(0, 0, 0), {0, 0, s(floor)}, {s(floor), 0, 0}), matte(white));
    add(scene, sphere(p(0, 1, 0), s(1), rings), matte(white));
    scene.directional_lights.push_back({{-1, -2, -1}, white});
    scene.camera = look(p(0.5, 2.5, 4), p(0, 0.8, 0), 60);
    return scene;
}

/// Pixels that differ from what a perfect ball on a plane shows by more than the facets explain.
int speckles(const Picture& picture, const Scene& scene, double scale, const Float3& at, double floor) {
    const Camera& camera = *scene.camera;
    const double f[3] = {double(camera.target.x) - camera.eye.x, double(camera.target.y) - camera.eye.y,
                         double(camera.target.z) - camera.eye.z};
    const double length = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    const double forward[3] = {f[0] / length, f[1] / length, f[2] / length};
    const double flat = std::sqrt(forward[0] * forward[0] + forward[2] * forward[2]);
    const double right[3] = {-forward[2] / flat, 0, forward[0] / flat};
    const double up[3] = {right[1] * forward[2] - right[2] * forward[1],
                          right[2] * forward[0] - right[0] * forward[2],
                          right[0] * forward[1] - right[1] * forward[0]};
    const double light[3] = {1 / std::sqrt(6.0), 2 / std::sqrt(6.0), 1 / std::sqrt(6.0)};
    const double eye[3] = {(camera.eye.x - at.x) / scale, (camera.eye.y - at.y) / scale,
                           (camera.eye.z - at.z) / scale};
    // The ray's distance from the ball's centre, and whether it comes near the ball at all.
    const auto closest = [](const double* o, const double* d) {
        const double c[3] = {-o[0], 1 - o[1], -o[2]};
        const double t = c[0] * d[0] + c[1] * d[1] + c[2] * d[2];
        const double q = c[0] * c[0] + c[1] * c[1] + c[2] * c[2] - t * t;
        return t > 0 ? std::sqrt(std::max(q, 0.0)) : 1e9;
    };
    int count = 0;
    const double tangent = std::tan(30 * 3.14159265358979 / 180);
    const int size = static_cast<int>(picture.image.width);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double sx = ((x + 0.5) / size * 2 - 1) * tangent, sy = (1 - (y + 0.5) / size * 2) * tangent;
            double d[3];
            for (int k = 0; k < 3; ++k) d[k] = forward[k] + right[k] * sx + up[k] * sy;
            const double n = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            for (double& k : d) k /= n;
            const double value = picture.at(x, y).x, miss = closest(eye, d);
            if (miss > 0.98 && miss < 1.02) continue;  // the facets' outline
            if (miss < 1) {
                const double c[3] = {-eye[0], 1 - eye[1], -eye[2]};
                const double t = c[0] * d[0] + c[1] * d[1] + c[2] * d[2] - std::sqrt(1 - miss * miss);
                double lambert = 0;
                for (int k = 0; k < 3; ++k) lambert += (eye[k] + t * d[k] - (k == 1)) * light[k];
                if (std::fabs(value - std::max(lambert, 0.0)) > 0.06) ++count;
            } else if (d[1] < 0) {
                double p[3];
                for (int k = 0; k < 3; ++k) p[k] = eye[k] - d[k] * eye[1] / d[1];
                if (std::fabs(p[0]) > floor - 0.1 || std::fabs(p[2]) > floor - 0.1) continue;
                const double shade = closest(p, light);
                if (shade > 0.97 && shade < 1.03) continue;
                if (std::fabs(value - (shade < 1 ? 0 : light[1])) > 1e-3) ++count;
            }
        }
    }
    return count;
}

TEST_F(Render, ThereIsNoAcne) {
    struct Case {
        double scale;
        Float3 at;
        int rings;
        double floor;
    };
    const Case cases[] = {{1, {0, 0, 0}, 16, 8},    {1, {0, 0, 0}, 200, 8},       {1e-3, {0, 0, 0}, 32, 8},
                          {1e4, {0, 0, 0}, 32, 30}, {1, {300, -200, 100}, 64, 8}, {1, {0, 0, 0}, 16, 2000}};
    for (const Case& c : cases) {
        const Scene scene = ball_on_floor(c.scale, c.at, c.rings, c.floor);
        const Picture picture = render(scene, {.width = 160, .height = 160});
        EXPECT_EQ(speckles(picture, scene, c.scale, c.at, c.floor), 0)
            << "scale " << c.scale << ", at " << c.at.x << ", rings " << c.rings << ", floor " << c.floor;
    }
}

}  // namespace
}  // namespace setka::render_test
