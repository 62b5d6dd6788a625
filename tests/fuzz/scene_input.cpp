// SPDX-License-Identifier: MIT
#include "fuzz/scene_input.hpp"

namespace fuzz {

using setka::Float3;

namespace {

setka::Mesh read_mesh(Input& input, const Floats& floats) {
    setka::Mesh mesh;
    mesh.positions.resize(input.below(25));
    for (Float3& p : mesh.positions) p = read_vector(input, floats);
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.triangles.resize(input.below(25));
    for (setka::Triangle& t : mesh.triangles)
        for (std::uint32_t* index : {&t.a, &t.b, &t.c}) {
            const std::uint32_t value = input.byte();
            *index = value == 255 ? input.raw<std::uint32_t>() : value % std::max(vertices, 1u);
        }
    if (input.byte() >= 224) {
        mesh.normals.resize(input.byte() < 240 ? mesh.positions.size() : input.byte());
        for (Float3& n : mesh.normals) n = read_vector(input, floats);
    }
    return mesh;
}

setka::Instance read_instance(Input& input, const Floats& floats, const setka::Scene& scene) {
    setka::Instance instance;
    const std::uint8_t kind = input.byte();
    instance.mesh =
        kind == 255 ? input.raw<std::uint32_t>() : kind % static_cast<std::uint32_t>(scene.meshes.size());
    if (kind & 64) instance.material = input.below(4);
    if (kind & 32) instance.mask = input.raw<std::uint32_t>();
    if (kind & 16)
        for (const int place : {3, 7, 11})
            instance.transform.rows[static_cast<std::size_t>(place)] = floats(input);
    if (kind & 8)
        for (float& value : instance.transform.rows) value = floats(input);
    return instance;
}

/// A point of a triangle: a corner, a point of an edge, or inside.
Float3 point_of(Input& input, std::span<const float> triangle) {
    static constexpr float shares[][3] = {{1, 0, 0},          {0, 1, 0},       {0, 0, 1},
                                          {0.5f, 0.5f, 0},    {0, 0.5f, 0.5f}, {0.25f, 0.25f, 0.5f},
                                          {0.375f, 0, 0.625f}};
    const auto& share = shares[input.below(std::size(shares))];
    float p[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = (share[0] * triangle[axis] + share[1] * triangle[3 + axis]) + share[2] * triangle[6 + axis];
    return {p[0], p[1], p[2]};
}

setka::Ray read_ray(Input& input, const Floats& floats, std::span<const float> triangles) {
    const std::uint8_t kind = input.byte();
    const auto triangle = [&] {
        return triangles.subspan(9 * input.below(static_cast<std::uint32_t>(triangles.size() / 9)), 9);
    };
    const bool has_target = !triangles.empty() && (kind & 1), has_start = !triangles.empty() && (kind & 2);
    const Float3 o = has_start ? point_of(input, triangle()) : read_vector(input, floats);
    Float3 d = has_target ? point_of(input, triangle()) : read_vector(input, floats);
    if (has_target) d = {d.x - o.x, d.y - o.y, d.z - o.z};
    setka::Ray ray{{o.x, o.y, o.z}, 0, {d.x, d.y, d.z}, std::numeric_limits<float>::infinity()};
    if (kind & 4) ray.tmin = floats(input);
    if (kind & 8) ray.tmax = floats(input);
    if (kind & 16) ray.tmin = -ray.tmax;
    if (kind & 32)  // from far away
        for (int axis = 0; axis < 3; ++axis) ray.origin[axis] -= ray.direction[axis] * 1000;
    return ray;
}

}  // namespace

Float3 read_vector(Input& input, const Floats& floats) {
    const float x = floats(input), y = floats(input), z = floats(input);
    return {x, y, z};
}

setka::Scene read_scene(Input& input) {
    const Floats floats(input);
    setka::Scene scene;
    scene.meshes.resize(1 + input.below(3));
    for (setka::Mesh& mesh : scene.meshes) mesh = read_mesh(input, floats);
    scene.materials.resize(2);
    scene.materials[1].transparency = 0.5f;
    scene.instances.resize(1 + input.below(4));
    for (setka::Instance& instance : scene.instances) instance = read_instance(input, floats, scene);
    return scene;
}

setka::GridOptions read_grid_options(Input& input) {
    static constexpr float densities[] = {4, 0.5f, 1, 64, 1000, 1e-6f, 1e6f};
    static constexpr std::uint32_t mosts[] = {2048, 1, 2, 7, 64, 4096};
    setka::GridOptions options;
    const std::uint8_t kind = input.byte();
    options.density = kind % 8 < std::size(densities) ? densities[kind % 8] : Floats(input)(input);
    const std::uint8_t most = kind / 8 % 8;
    options.max_cells_per_axis = most < std::size(mosts) ? mosts[most] : input.raw<std::uint32_t>();
    if (kind & 64) options.cell_tables = setka::CellTables::BinarySearch;
    if (kind & 128) options.cell_tables = kind & 64 ? setka::CellTables::Bins : setka::CellTables::RunBoundaries;
    return options;
}

std::vector<setka::Ray> read_rays(Input& input, std::uint32_t most, std::span<const float> triangles) {
    const Floats floats(input);
    std::vector<setka::Ray> rays(1 + input.below(most));
    for (setka::Ray& ray : rays) ray = read_ray(input, floats, triangles);
    return rays;
}

std::vector<setka::Primitive> read_skip(Input& input, std::size_t rays) {
    std::vector<setka::Primitive> skip;
    if (input.byte() % 4 != 0) return skip;
    skip.resize(rays);
    for (setka::Primitive& primitive : skip) {
        const std::uint8_t kind = input.byte();
        primitive = kind >= 240 ? setka::Primitive{input.raw<std::uint32_t>(), input.raw<std::uint32_t>()}
                                : setka::Primitive{kind % 16u, kind / 16u};
    }
    return skip;
}

}  // namespace fuzz
