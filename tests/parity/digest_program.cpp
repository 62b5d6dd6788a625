// SPDX-License-Identifier: MIT
/// What are the digests of some grids, on every device? Prints one line a device, scene and density, and the
/// digest of some hits; started with different driver settings, it has to print the same.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"

namespace {

/// FNV-1a over the hits' bytes.
std::uint64_t hash(const std::vector<setka::Hit>& hits) {
    std::uint64_t value = 0xcbf29ce484222325u;
    const auto* bytes = reinterpret_cast<const unsigned char*>(hits.data());
    for (std::size_t i = 0; i < hits.size() * sizeof(setka::Hit); ++i)
        value = (value ^ bytes[i]) * 0x100000001b3u;
    return value;
}

void print_digests(const std::string& id) {
    const setka::Device device = setka::Device::open(id);
    setka::Queue queue = device.make_queue();
    const auto print = [&](const std::string& name, const setka::Scene& scene) {
        const setka::DeviceScene on_device(queue, scene);
        const auto rays = support::adversarial_rays(oracle::make_world(scene), 20000, 5);
        for (const float density : {0.5f, 4.0f, 16.0f}) {
            const auto builder = setka::make_grid_builder({.density = density});
            const setka::Grid grid = builder->build(queue, on_device);
            const auto hits = setka::Tracer().closest_hit(queue, grid, rays);
            std::printf("%s %s %g %s %016llx\n", id.c_str(), name.c_str(), double(density),
                        grid.digest(queue).to_string().c_str(), static_cast<unsigned long long>(hash(hits)));
        }
    };
    for (const char* name : {"slivers", "giant", "placed", "on_cell_planes"})
        print(name, support::find_scene(name).make());
    print("ball", support::ball(200000));
}

}  // namespace

int main() {
    try {
        const auto ids = support::device_ids();
        if (ids.front() == "none") {
            const auto why = support::no_device();
            std::fprintf(stderr, "%s: %s\n", why.is_failure ? "FAILED" : "SKIPPED", why.message.c_str());
            return why.is_failure ? 1 : 0;
        }
        std::for_each(ids.begin(), ids.end(), print_digests);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
