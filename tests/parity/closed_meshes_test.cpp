// SPDX-License-Identifier: MIT
/// Does any ray leak, or hit twice, at an edge? A line passes the triangles of a closed mesh an even number of times: one that is missed
/// or doubled makes it odd. Lines aim at vertices, edges and faces; SETKA_CLOSED_LINES is how many a mesh and device, 720,000 unless set: ten million in all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <optional>

#include "setka/setka.hpp"
#include "support/closed_meshes.hpp"
#include "support/compare.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "workload/named_scene.hpp"

namespace {

const std::vector<std::string> meshes{
    "sphere:20000",  "torus:20000",   "cube",           "icosphere_1e4", "icosphere_1e5",           "icosphere_1e6",
    "icosphere_1e7", "icosphere_tiny", "icosphere_flat", "soup:3000",     "scan/stanford-bunny.obj", "scan/dragon.obj",
    "arch/sponza_dabrovic.obj", "gltf/2CylinderEngine.glb"};

std::optional<setka::Mesh> make(const std::string& name) {
    using support::icosphere;
    if (name == "icosphere_1e4") return icosphere(5, {1e4f, -1e4f, 1e4f}, 3);
    if (name == "icosphere_1e5") return icosphere(5, {-1e5f, 1e5f, 3e4f}, 20);
    if (name == "icosphere_1e6") return icosphere(5, {1e6f, 1e6f, -1e6f}, 10);  // steps of 1/16: many vertices meet
    if (name == "icosphere_1e7") return icosphere(6, {1e7f, -1e7f, 1e7f}, 1e3f);
    if (name == "icosphere_tiny") return icosphere(5, {1e-7f, 0, -1e-7f}, 1e-6f);
    if (name == "icosphere_flat") {
        setka::Mesh mesh = icosphere(5, {}, 1);
        for (setka::Float3& p : mesh.positions) p.z = std::nearbyint(p.z * 4) * 1e-3f;  // terraces, walls, doubled sheets
        return mesh;
    }
    const auto scene = setka::workload::NamedScene{name}.load(support::scene_folder().value_or("."));
    if (!scene) return std::nullopt;
    return support::close(support::in_world(*scene));
}

std::uint64_t line_count() {
    const char* set = std::getenv("SETKA_CLOSED_LINES");
    return set ? std::strtoull(set, nullptr, 10) : 720'000;
}

class ClosedMeshes : public support::DeviceAndTest<std::string> {};
SETKA_ON_EVERY_DEVICE_AND(ClosedMeshes, meshes);

TEST_P(ClosedMeshes, ArePassedAnEvenNumberOfTimes) {
    const auto mesh = make(other());
    if (!mesh) GTEST_SKIP() << "there is no " << other() << " in the folder of scene files; set SETKA_SCENES";
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene scene(queue, support::scene_of(*mesh));
    constexpr float densities[] = {4, 0.5f, 16};
    std::vector<setka::Grid> grids;
    for (const float density : densities)
        grids.push_back(setka::make_grid_builder({.density = density})->build(queue, scene));
    const std::uint64_t total = line_count(), batch = std::uint64_t{1} << (total > 10'000'000 ? 23 : 18);
    std::uint64_t hits = 0, most = 0, turn = 0;
    for (std::uint64_t first = 0; first < total; first += batch, ++turn) {
        const auto lines = support::lines_at(*mesh, 17, first, std::min(batch, total - first));
        const setka::Grid& grid = grids[turn % grids.size()];
        const auto counts = setka::Tracer().count_hits(queue, grid, lines);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            hits += counts[i];
            most = std::max<std::uint64_t>(most, counts[i]);
            ASSERT_EQ(counts[i] % 2, 0u) << "line " << first + i << " of " << counts[i] << " hits, density "
                                         << densities[turn % grids.size()] << ": origin " << lines[i].origin[0] << ' '
                                         << lines[i].origin[1] << ' ' << lines[i].origin[2] << ", direction "
                                         << lines[i].direction[0] << ' ' << lines[i].direction[1] << ' '
                                         << lines[i].direction[2];
        }
    }
    std::cout << other() << ": " << mesh->triangles.size() << " triangles, " << total << " lines, " << hits
              << " hits, at most " << most << " on one\n";
    EXPECT_GT(hits, total);  // most lines pass
}

/// What every line hits, in order, is what brute force finds: some lines, since that is slow.
TEST_P(ClosedMeshes, AreHitAsByBruteForce) {
    const auto mesh = make(other());
    if (!mesh) GTEST_SKIP() << "there is no " << other() << " in the folder of scene files; set SETKA_SCENES";
    setka::Queue queue = device().make_queue();
    const setka::DeviceScene scene(queue, support::scene_of(*mesh));
    const auto brute = setka::BruteForce::build(queue, scene);
    const auto grid = setka::make_grid_builder()->build(queue, scene);
    const std::size_t count = std::min<std::size_t>(line_count() / 50, 400'000'000 / mesh->triangles.size());
    const auto lines = support::lines_at(*mesh, 18, 0, count);
    const auto expected = setka::Tracer().all_hits(queue, brute, lines);
    const auto actual = setka::Tracer().all_hits(queue, grid, lines);
    ASSERT_EQ(expected.offsets, actual.offsets);
    ASSERT_EQ(expected.hits.size(), actual.hits.size());
    EXPECT_EQ(std::memcmp(expected.hits.data(), actual.hits.data(), actual.hits.size() * sizeof(setka::Hit)), 0);
    EXPECT_GT(actual.hits.size(), count);
}

}  // namespace
