// SPDX-License-Identifier: MIT
/// What is interrupted? Every piece of work that the library does on a queue, with its result as bytes.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "setka/setka.hpp"
#include "support/handmade.hpp"

namespace faults {

using setka::Queue;

/// What the pieces of work share: a scene with mirrors and glass, on the device in every form.
struct World {
    setka::Scene scene = support::mirror_and_glass();
    setka::DeviceScene on_device;
    setka::Grid grid;
    setka::BruteForce brute_force;
    setka::Buffer<setka::Ray> rays;
    std::vector<setka::Ray> host_rays;
    std::vector<setka::Primitive> skip;  ///< for every other ray the first that it hits
    std::vector<std::byte> saved;        ///< the grid

    explicit World(Queue& queue)
        : on_device(queue, scene),
          grid(setka::make_grid_builder()->build(queue, on_device)),
          brute_force(setka::BruteForce::build(queue, on_device)),
          rays(setka::camera_rays(queue, *scene.camera, 32, 24)),
          host_rays(queue.download(rays)),
          saved(setka::serialize(queue, grid)) {
        for (const setka::Hit& hit : setka::Tracer().closest_hit(queue, grid, std::span(host_rays)))
            skip.push_back(skip.size() % 2 == 0 ? setka::Primitive{hit.primitive, hit.instance}
                                                : setka::Primitive{SETKA_NO_HIT, SETKA_NO_HIT});
    }
};

struct Work {
    std::string name;
    std::function<std::string(Queue&, const World&)> run;
    /// Work that makes do with less memory: an allocation may fail without an error.
    enum class OnOutOfMemory { Fails, MayRecover } on_out_of_memory = OnOutOfMemory::Fails;
};

[[nodiscard]] const std::vector<Work>& all_work();
[[nodiscard]] std::vector<std::string> work_names();
[[nodiscard]] const Work& find_work(const std::string& name);

}  // namespace faults
