// SPDX-License-Identifier: MIT
/// Which scene breaks the build or the walk? Any bits as positions, indices, matrices, options and rays:
/// refused as an Error, or else tables and hits of the oracle, which load again when they are saved.
#include "fuzz/check.hpp"
#include "fuzz/host_device.hpp"
#include "fuzz/queries.hpp"
#include "fuzz/scene_input.hpp"
#include "setka/save.hpp"
#include "support/compare.hpp"

namespace {

using setka::ErrorCategory;

void check_saving(setka::Queue& queue, const setka::Grid& grid) {
    for (const std::string& violation : setka::validate(queue, grid))
        fuzz::fail("a built grid violates: " + violation);
    const auto bytes = setka::serialize(queue, grid);
    std::optional<setka::Grid> loaded;
    // Two copies of a grid may be more than the device may hold.
    if (fuzz::succeeds({ErrorCategory::OutOfMemory}, [&] { loaded = setka::deserialize_grid(queue, bytes); }))
        fuzz::check(loaded->digest(queue) == grid.digest(queue), "a loaded grid is the saved one");
}

void check_scene(setka::Queue& queue, const setka::DeviceScene& scene, const setka::Grid& grid,
                 const oracle::World& world, const setka::GridOptions& options, fuzz::Input& input) {
    // The paper's tables may be more than the device may hold beside the grid.
    (void)fuzz::succeeds({ErrorCategory::OutOfMemory}, [&] {
        fuzz::check(support::same_tables(oracle::make_tables(world, options), support::download(queue, grid)),
                    "tables");
        check_saving(queue, grid);
    });
    fuzz::Queries queries;
    queries.rays = fuzz::read_rays(input, 12, queue.download(grid.geometry().triangles));
    queries.skip = fuzz::read_skip(input, queries.rays.size());
    if (const std::uint8_t kind = input.byte(); kind & 1) queries.mask = input.raw<std::uint32_t>();
    queries.max_hits = input.byte();
    const auto right = fuzz::right_hits(world, queries);
    fuzz::check_queries(queue, grid, queries, right);
    std::optional<setka::BruteForce> brute_force;
    if (fuzz::succeeds({ErrorCategory::OutOfMemory},
                       [&] { brute_force = setka::BruteForce::build(queue, scene); }))
        fuzz::check_queries(queue, *brute_force, queries, right);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Input input({data, size});
    setka::Queue& queue = fuzz::queue();
    const setka::Scene scene = fuzz::read_scene(input);
    const setka::GridOptions options = fuzz::read_grid_options(input);
    std::optional<setka::DeviceScene> device_scene;
    std::optional<setka::Grid> grid;
    const auto refusals = {ErrorCategory::InvalidArgument, ErrorCategory::InvalidData,
                           ErrorCategory::OutOfMemory};
    if (fuzz::succeeds(refusals, [&] {
            device_scene.emplace(queue, scene);
            grid = setka::make_grid_builder(options)->build(queue, *device_scene);
        }))
        check_scene(queue, *device_scene, *grid, oracle::make_world(scene), options, input);
    grid.reset();
    device_scene.reset();
    fuzz::check(queue.device().memory_in_use_bytes() == 0, "everything is given back");
    return 0;
}
