// SPDX-License-Identifier: MIT
/// What are the digests of some grids, hits and pictures, on every device? One line each; started with other
/// driver settings, or on another driver, the program has to print the same.
///
///   setka_digest           grids and hits at ordinary sizes, in each device's own launch shape
///   setka_digest small     every kernel, in two launch shapes, at sizes that take any driver seconds
///   setka_digest tiny      the same, at sizes that an interpreter gets through
///   setka_digest devices   the devices: id, name and platform
#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/handmade.hpp"
#include "support/rays.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

namespace {

/// FNV-1a over the bytes.
template <typename T>
std::uint64_t hash(const std::vector<T>& values, std::uint64_t value = 0xcbf29ce484222325u) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (std::size_t i = 0; i < values.size() * sizeof(T); ++i) value = (value ^ bytes[i]) * 0x100000001b3u;
    return value;
}

void print_ordinary(const std::string& id) {
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

/// How much of everything a mode does.
struct Sizes {
    std::vector<std::string> scenes;
    std::uint32_t ball = 0;  ///< triangles of one more scene
    std::size_t rays = 0;
    std::uint32_t width = 0, height = 0;
    int rings = 0;
};
const Sizes small{{"slivers", "giant", "placed", "on_cell_planes", "negative_zero"}, 300, 100, 16, 12, 8};
const Sizes tiny{{"negative_zero"}, 20, 20, 8, 6, 2};

/// Everything in one launch shape.
class AllKernels {
  public:
    AllKernels(const std::string& id, const std::string& shape, const Sizes& sizes)
        : start_(id + " " + shape),
          sizes_(sizes),
          queue_(setka::Device::open(id, support::launch_shape(shape)).make_queue()) {}

    void print() {
        for (const std::string& name : sizes_.scenes) print_scene(name, support::find_scene(name).make());
        print_scene("ball", support::ball(sizes_.ball));
        print_pile();
        print_bounds();
        print_pictures();
    }

  private:
    void print_line(const std::string& what, const std::string& value) const {
        std::printf("%s %s %s\n", start_.c_str(), what.c_str(), value.c_str());
        std::fflush(stdout);
    }
    void print_line(const std::string& what, std::uint64_t value) const {
        char text[17];
        std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
        print_line(what, std::string(text));
    }

    void print_scene(const std::string& name, const setka::Scene& scene) {
        const setka::DeviceScene on_device(queue_, scene);
        const auto rays = support::adversarial_rays(oracle::make_world(scene), sizes_.rays, 5);
        const auto brute = setka::BruteForce::build(queue_, on_device);
        print_line(name + " brute_force hits", hash(setka::Tracer().closest_hit(queue_, brute, rays)));
        print_line(name + " brute_force any", hash(setka::Tracer().any_hit(queue_, brute, rays)));
        print_all_hits(name + " brute_force", brute, rays);
        const auto build = [&](setka::CellTables tables) {
            return setka::make_grid_builder({.density = 2, .cell_tables = tables})->build(queue_, on_device);
        };
        const setka::Grid grid = build(setka::CellTables::Scatter);
        print_line(name + " scatter", grid.digest(queue_).to_string());
        print_all_hits(name + " grid", grid, rays);
        for (const auto tables : {setka::CellTables::Bins, setka::CellTables::RunBoundaries, setka::CellTables::BinarySearch})
            print_line(name + " " + to_string(tables), build(tables).digest(queue_).to_string());
        for (const auto step : {setka::GridStep::Dda, setka::GridStep::BranchFree})
            print_rays(name + (step == setka::GridStep::Dda ? " dda" : " branch_free"), grid,
                       setka::Tracer({.step = step}), rays);
        print_bundles(name, grid, support::bundled_rays(oracle::make_world(scene), 4 * 128, 7));
    }

    /// Rays of a picture, of which a block is a bundle.
    void print_bundles(const std::string& name, const setka::Grid& grid, const std::vector<setka::Ray>& rays) {
        const setka::RayBatch batch(queue_.upload(std::span(rays), "rays"), {}, 16);
        const auto hits = queue_.make_buffer<setka::Hit>(rays.size(), "hits");
        const auto flags = queue_.make_buffer<std::uint32_t>(rays.size(), "flags");
        setka::Tracer().closest_hit(queue_, grid, batch, hits);
        setka::Tracer().any_hit(queue_, grid, batch, flags);
        print_line(name + " bundles hits", hash(queue_.download(hits)));
        print_line(name + " bundles any", hash(queue_.download(flags)));
    }

    /// A list so long that more than one work-item sorts and moves it.
    void print_pile() {
        const setka::DeviceScene on_device(queue_, support::ball(1100));
        for (const setka::CellTables tables : support::all_cell_tables) {
            const auto builder = setka::make_grid_builder({.max_cells_per_axis = 1, .cell_tables = tables});
            print_line("pile " + std::string(to_string(tables)),
                       builder->build(queue_, on_device).digest(queue_).to_string());
        }
    }

    void print_all_hits(const std::string& name, const setka::Structure& structure,
                        const std::vector<setka::Ray>& rays) {
        const setka::HitLists lists = setka::Tracer().all_hits(queue_, structure, rays);
        print_line(name + " all hits", hash(lists.hits, hash(lists.offsets)));
        print_line(name + " counts",
                   hash(setka::Tracer().count_hits(queue_, structure, rays, {.max_hits = 2})));
    }

    void print_rays(const std::string& name, const setka::Grid& grid, const setka::Tracer& tracer,
                    const std::vector<setka::Ray>& rays) {
        print_line(name + " hits", hash(tracer.closest_hit(queue_, grid, rays)));
        print_line(name + " any", hash(tracer.any_hit(queue_, grid, rays)));
        const auto costs = queue_.make_buffer<setka::TraceCost>(rays.size(), "costs");
        tracer.closest_hit_cost(queue_, grid, queue_.upload(std::span(rays), "rays"), costs);
        print_line(name + " costs", hash(queue_.download(costs)));
    }

    /// More triangles than one group of 32 finds the bounds of.
    void print_bounds() {
        const setka::Scene scene = support::ball(600);
        const auto rays = support::adversarial_rays(oracle::make_world(scene), 5, 6);
        const auto brute = setka::BruteForce::build(queue_, setka::DeviceScene(queue_, scene));
        print_line("bounds", hash(setka::Tracer().closest_hit(queue_, brute, rays)));
    }

    void print_pictures() {
        const setka::Scene scene = support::mirror_and_glass(sizes_.rings);
        const setka::DeviceScene on_device(queue_, scene);
        const auto grid = setka::make_grid_builder()->build(queue_, on_device);
        const auto print = [&](const char* name, setka::View view) {
            setka::RenderOptions options;
            options.width = sizes_.width;
            options.height = sizes_.height;
            options.view = view;
            const setka::Image image =
                setka::Renderer(options).render(queue_, on_device, grid, *scene.camera);
            print_line(std::string("picture ") + name, hash(image.srgb, hash(image.linear)));
        };
        print("shaded", setka::View::Shaded);
        print("normals", setka::View::Normals);
        print("depth", setka::View::Depth);
        print("steps", setka::View::Steps);
        print("tests", setka::View::Tests);
    }

    std::string start_;
    Sizes sizes_;
    setka::Queue queue_;
};

void print_devices() {
    for (const setka::DeviceInfo& info : setka::enumerate_devices())
        std::printf("%s %s | %s | driver %s\n", info.id.c_str(), info.name.c_str(), info.platform.c_str(),
                    info.driver.c_str());
}

void run(const std::string& mode, const std::string& id) {
    if (mode == "ordinary") return print_ordinary(id);
    if (mode != "small" && mode != "tiny")
        throw std::invalid_argument("mode is '" + mode + "'; ordinary, small, tiny and devices are accepted");
    // Their queues live to the end: Oclgrind confuses a buffer with an earlier one.
    std::vector<AllKernels> shapes;
    for (const char* shape : {"defaults", "Group_32"})
        shapes.emplace_back(id, shape, mode == "tiny" ? tiny : small).print();
}

}  // namespace

int main(int argument_count, char** arguments) {
    try {
        const std::string mode = argument_count > 1 ? arguments[1] : "ordinary";
        const auto ids = support::device_ids();
        if (ids.front() == "none") {
            const auto why = support::no_device();
            std::fprintf(stderr, "%s: %s\n", why.is_failure ? "FAILED" : "SKIPPED", why.message.c_str());
            return why.is_failure ? 1 : 0;
        }
        if (mode == "devices") print_devices();
        else
            for (const std::string& id : ids) run(mode, id);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
