// SPDX-License-Identifier: MIT
/// Which argument of the public functions breaks them? Rays, masks, primitives to skip, sizes of buffers,
/// cameras, lights, materials and options of pictures, over a few scenes that stay: refused as
/// InvalidArgument or InvalidData, or else what the oracle and brute force answer.
#include <array>
#include <cstring>
#include <memory>
#include <optional>

#include "fuzz/check.hpp"
#include "fuzz/host_device.hpp"
#include "fuzz/queries.hpp"
#include "fuzz/scene_input.hpp"
#include "setka/setka.hpp"
#include "support/scenes.hpp"

namespace {

using setka::ErrorCategory;
using setka::Float3;

/// A scene with everything that is made of it once.
struct Place {
    setka::Scene scene;
    oracle::World world;
    std::vector<float> triangles;
    std::unique_ptr<setka::DeviceScene> device_scene;
    std::unique_ptr<setka::BruteForce> brute_force;
    std::vector<setka::Grid> grids;
};

Place make_place(setka::Scene scene) {
    setka::Queue& queue = fuzz::queue();
    Place place{std::move(scene), {}, {}, {}, {}, {}};
    place.world = oracle::make_world(place.scene);
    place.device_scene = std::make_unique<setka::DeviceScene>(queue, place.scene);
    place.brute_force =
        std::make_unique<setka::BruteForce>(setka::BruteForce::build(queue, *place.device_scene));
    place.triangles = queue.download(place.brute_force->geometry().triangles);
    for (const float density : {4.0f, 0.01f, 60.0f})
        place.grids.push_back(
            setka::make_grid_builder({.density = density})->build(queue, *place.device_scene));
    return place;
}

setka::Scene scaled(setka::Scene scene, float factor) {
    for (setka::Instance& instance : scene.instances)
        for (float& value : instance.transform.rows) value *= factor;
    return scene;
}

/// Two balls, one of glass, over a floor: every kind of secondary ray.
setka::Scene shiny_scene() {
    setka::Scene scene = support::ball(48);
    scene.materials.resize(3);
    scene.materials[1].transparency = 0.9f;
    scene.materials[2].reflectivity = 0.5f;
    scene.instances[0].material = 1;
    setka::Instance other = scene.instances[0];
    other.transform.rows[3] = 1.5f;
    other.material = 2;
    other.mask = 6;
    scene.instances.push_back(other);
    scene.point_lights.push_back({{3, 5, 2}, {1, 1, 1}, 2});
    return scene;
}

const Place& place(std::uint32_t number) {
    static const std::array<Place, 6> places{
        make_place(shiny_scene()),
        make_place(support::ball(20)),
        make_place(support::from_triangles({{Float3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}})),
        make_place(scaled(support::ball(24), 1e19f)),
        make_place(scaled(support::ball(24), 0x1p-90f)),
        make_place(setka::make_scene("plane", 32)),
    };
    return places[number % places.size()];
}

void check_tracing(fuzz::Input& input) {
    setka::Queue& queue = fuzz::queue();
    const Place& at = place(input.byte());
    fuzz::Queries queries;
    queries.rays = fuzz::read_rays(input, 40, at.triangles);
    queries.skip = fuzz::read_skip(input, queries.rays.size());
    if (input.byte() & 1) queries.mask = input.raw<std::uint32_t>();
    queries.max_hits = input.byte();
    const auto right = fuzz::right_hits(at.world, queries);
    for (const setka::Grid& grid : at.grids) fuzz::check_queries(queue, grid, queries, right);
    fuzz::check_queries(queue, *at.brute_force, queries, right);
}

template <typename T>
setka::Buffer<T> upload(std::size_t size, const T& value) {
    const std::vector<T> values(size, value);
    return fuzz::queue().upload(std::span(values), "values");
}

/// Buffers of any size: one that is too small is refused, and nothing is written beyond the rays.
void check_sizes(fuzz::Input& input) {
    setka::Queue& queue = fuzz::queue();
    const Place& at = place(input.byte());
    const std::uint8_t kind = input.byte();
    const setka::Structure* structure = at.brute_force.get();
    if (kind & 1) structure = &at.grids[0];
    const std::size_t rays = input.below(6), results = input.below(6), skipped = input.below(6);
    const setka::RayBatch batch{upload(rays, setka::Ray{{0, 0, 5}, 0, {0, 0, -1}, 9}),
                                upload(skipped, setka::Primitive{})};
    const setka::Tracer tracer({kind & 2 ? setka::GridStep::Dda : setka::GridStep::BranchFree, 1});
    constexpr std::uint32_t sentinel = 0x12345678u;
    const auto flags = upload(results, sentinel);
    const auto query = [&] {
        switch (kind / 4 % 4) {
            case 0:
                return tracer.any_hit(queue, *structure, batch, flags);
            case 1:
                return tracer.count_hits(queue, *structure, batch, flags);
            case 2:
                return tracer.closest_hit(queue, *structure, batch, upload(results, setka::Hit{}));
            default:
                return tracer.closest_hit_cost(queue, *structure, batch, upload(results, setka::TraceCost{}));
        }
    };
    const bool skips_fit = skipped == 0 || skipped >= rays, fits = skips_fit && results >= rays;
    fuzz::check(fuzz::succeeds({ErrorCategory::InvalidArgument}, query) == fits,
                "a query with buffers of these sizes");
    const auto all = [&] { (void)tracer.all_hits(queue, *structure, batch); };
    fuzz::check(fuzz::succeeds({ErrorCategory::InvalidArgument}, all) == skips_fit,
                "all hits with so many to skip");
    const auto after = queue.download(flags);
    for (std::size_t i = fits ? rays : 0; i < after.size(); ++i)
        fuzz::check(after[i] == sentinel, "nothing is written beyond the rays");
}

std::uint32_t small_or_refused(fuzz::Input& input, std::uint32_t small, std::uint32_t largest) {
    const std::uint8_t kind = input.byte();
    if (kind < 248) return kind % (small + 1);
    const auto any = input.raw<std::uint32_t>();
    return any > largest ? any : small;
}

setka::Material read_material(fuzz::Input& input, const fuzz::Floats& floats) {
    setka::Material material;
    const std::uint8_t kind = input.byte();
    if (kind & 1) material.diffuse = fuzz::read_vector(input, floats);
    if (kind & 2) material.specular = fuzz::read_vector(input, floats);
    if (kind & 4) material.emission = fuzz::read_vector(input, floats);
    if (kind & 8) material.shininess = floats(input);
    if (kind & 16) material.reflectivity = floats(input);
    if (kind & 32) material.transparency = floats(input);
    if (kind & 64) material.transmission = fuzz::read_vector(input, floats);
    if (kind & 128) material.refractive_index = floats(input);
    return material;
}

setka::Scene read_lit_scene(fuzz::Input& input, const fuzz::Floats& floats) {
    setka::Scene scene = place(input.byte()).scene;
    for (setka::Material& material : scene.materials)
        if (input.byte() & 1) material = read_material(input, floats);
    const std::uint8_t lights = input.byte();
    if (lights & 1) scene.point_lights.clear();
    if (lights & 2)
        scene.point_lights.push_back(
            {fuzz::read_vector(input, floats), fuzz::read_vector(input, floats), floats(input)});
    if (lights & 4)
        scene.directional_lights.push_back(
            {fuzz::read_vector(input, floats), fuzz::read_vector(input, floats)});
    if (lights & 8)
        scene.background = {fuzz::read_vector(input, floats), fuzz::read_vector(input, floats),
                            fuzz::read_vector(input, floats), floats(input)};
    if (lights & 16)
        for (setka::Mesh& mesh : scene.meshes) {
            mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
            mesh.normals[input.byte() % mesh.normals.size()] = fuzz::read_vector(input, floats);
        }
    return scene;
}

setka::Camera read_camera(fuzz::Input& input, const fuzz::Floats& floats, const setka::Scene& scene) {
    setka::Camera camera = setka::frame(scene.bounds(), 1);
    const std::uint8_t kind = input.byte();
    if (kind & 1) camera.eye = fuzz::read_vector(input, floats);
    if (kind & 2) camera.target = fuzz::read_vector(input, floats);
    if (kind & 4) camera.up = fuzz::read_vector(input, floats);
    if (kind & 8) camera.vertical_fov_degrees = floats(input);
    if (kind & 16) camera = setka::frame_inside(scene.bounds());
    return camera;
}

setka::RenderOptions read_render_options(fuzz::Input& input) {
    setka::RenderOptions options;
    options.width = small_or_refused(input, 6, 16384);
    options.height = small_or_refused(input, 6, 16384);
    options.samples_per_axis = small_or_refused(input, 2, 16);
    options.max_depth = small_or_refused(input, 3, 16);
    const std::uint8_t kind = input.byte();
    options.view = static_cast<setka::View>(kind % 5);
    options.trace.step = kind & 64 ? setka::GridStep::BranchFree : setka::GridStep::Dda;
    if (kind & 128) options.trace.mask = input.raw<std::uint32_t>();
    return options;
}

/// Bit for bit, where a NaN is a NaN.
bool same_pixels(const setka::Image& a, const setka::Image& b) {
    const auto same = [](float x, float y) {
        return std::memcmp(&x, &y, sizeof x) == 0 || (x != x && y != y);
    };
    return a.srgb == b.srgb && std::ranges::equal(a.linear, b.linear, [&](const Float3& x, const Float3& y) {
               return same(x.x, y.x) && same(x.y, y.y) && same(x.z, y.z);
           });
}

/// Two structures make one picture.
void check_rendering(fuzz::Input& input) {
    setka::Queue& queue = fuzz::queue();
    const fuzz::Floats floats(input);
    const setka::Scene scene = read_lit_scene(input, floats);
    const setka::Camera camera = read_camera(input, floats, scene);
    const setka::RenderOptions options = read_render_options(input);
    const bool shows_costs = options.view == setka::View::Steps || options.view == setka::View::Tests;
    (void)fuzz::succeeds(
        {ErrorCategory::InvalidArgument, ErrorCategory::InvalidData, ErrorCategory::OutOfMemory}, [&] {
            const setka::DeviceScene device_scene(queue, scene);
            const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
            const setka::Image picture = setka::Renderer(options).render(queue, device_scene, grid, camera);
            fuzz::check(picture.linear.size() == std::size_t(options.width) * options.height,
                        "the size of the picture");
            const setka::BruteForce brute_force = setka::BruteForce::build(queue, device_scene);
            const setka::Image other =
                setka::Renderer(options).render(queue, device_scene, brute_force, camera);
            fuzz::check(shows_costs || same_pixels(picture, other),
                        "the picture does not depend on the structure");
        });
}

/// Host functions of the scene and the grid, any floats.
void check_host_functions(fuzz::Input& input) {
    const fuzz::Floats floats(input);
    const Float3 lower = fuzz::read_vector(input, floats), upper = fuzz::read_vector(input, floats);
    const setka::Bounds bounds{{lower.x, lower.y, lower.z}, {upper.x, upper.y, upper.z}};
    const float aspect = floats(input), fov = floats(input);
    const setka::GridOptions options = fuzz::read_grid_options(input);
    const auto triangle_count = input.raw<std::uint32_t>();
    const auto refusals = {ErrorCategory::InvalidArgument, ErrorCategory::InvalidData};
    (void)fuzz::succeeds(refusals, [&] { (void)setka::frame_inside(bounds, fov); });
    (void)fuzz::succeeds(refusals, [&] {
        setka::Scene scene = place(1).scene;
        scene.camera = setka::frame(bounds, aspect, fov);
        setka::add_default_lights(scene, *scene.camera);
    });
    (void)fuzz::succeeds(refusals, [&] {
        const setka::GridResolution cells = setka::grid_resolution(bounds, triangle_count, options);
        fuzz::check(cells.cell_size > 0, "cells have a size");
        for (const std::uint32_t dim : cells.dims)
            fuzz::check(dim >= 1 && dim <= options.max_cells_per_axis,
                        "1 to max_cells_per_axis cells along an axis");
        const oracle::GridResolution right = oracle::resolution(bounds, triangle_count, options);
        fuzz::check(std::memcmp(&right, &cells, sizeof right) == 0, "the oracle's resolution");
    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Input input({data, size});
    switch (input.byte() % 6) {
        case 0:
            check_host_functions(input);
            break;
        case 1:
            check_sizes(input);
            break;
        case 2:
        case 3:
            check_rendering(input);
            break;
        default:
            check_tracing(input);
            break;
    }
    return 0;
}
