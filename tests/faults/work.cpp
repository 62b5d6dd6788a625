// SPDX-License-Identifier: MIT
/// What does the library do on a queue? See the header.
#include "faults/work.hpp"

#include <span>
#include <stdexcept>

namespace faults {

namespace {

/// The bytes of a result.
class Bytes {
  public:
    template <typename T>
    Bytes& add(const std::vector<T>& values) {
        const auto* data = reinterpret_cast<const char*>(values.data());
        bytes_.append(data, values.size() * sizeof(T));
        return *this;
    }
    [[nodiscard]] const std::string& get() const { return bytes_; }

  private:
    std::string bytes_;
};

std::string grid_bytes(Queue& queue, const setka::Grid& grid) {
    const setka::GridTables tables = grid.tables(queue);
    return Bytes()
        .add(queue.download(tables.offsets))
        .add(queue.download(tables.counts))
        .add(queue.download(tables.references))
        .add(queue.download(grid.geometry().triangles))
        .get();
}

Work building(const std::string& name, setka::CellTables tables) {
    return {name, [tables](Queue& queue, const World& world) {
                const auto builder = setka::make_grid_builder({.density = 2, .cell_tables = tables});
                return grid_bytes(queue, builder->build(queue, world.on_device));
            }};
}

/// Of a sheet, whose cells are one thick but whose blocks are not: counted again when the host has seen the bounds.
Work building_flat(const std::string& name, setka::CellTables tables) {
    return {name, [tables](Queue& queue, const World&) {
                const setka::DeviceScene sheet(queue, support::sheet(16));
                const auto builder = setka::make_grid_builder({.density = 16, .cell_tables = tables});
                return grid_bytes(queue, builder->build(queue, sheet));
            }};
}

Work rendering(const std::string& name, setka::View view) {
    return {name,
            [view](Queue& queue, const World& world) {
                setka::Renderer renderer(
                    {.width = 12, .height = 8, .max_depth = 3, .view = view, .trace = {}, .pixels = {}, .progress = {}});
                const auto image = renderer.render(queue, world.on_device, world.grid, *world.scene.camera);
                return Bytes().add(image.linear).add(image.srgb).get();
            },
            Work::OnOutOfMemory::MayRecover};
}

Work rendering_in_passes() {
    return {"render_passes",
            [](Queue& queue, const World& world) {
                setka::RenderOptions options;
                options.width = 12;
                options.height = 8;
                options.samples_per_axis = 2;
                setka::ProgressiveRender picture(queue, world.on_device, world.grid, *world.scene.camera, options);
                Bytes bytes;
                while (picture.passes_done() < picture.passes()) {
                    picture.add_pass();
                    bytes.add(picture.image().linear);
                }
                return bytes.get();
            },
            Work::OnOutOfMemory::MayRecover};
}

template <typename Result>
Work tracing(const std::string& name,
             void (setka::Tracer::*query)(Queue&, const setka::Structure&, const setka::RayBatch&,
                                          const setka::Buffer<Result>&) const) {
    return {name, [query](Queue& queue, const World& world) {
                Bytes bytes;
                for (const setka::Structure* structure :
                     {static_cast<const setka::Structure*>(&world.grid),
                      static_cast<const setka::Structure*>(&world.brute_force)}) {
                    const auto results = queue.make_buffer<Result>(world.rays.size(), "results");
                    (setka::Tracer().*query)(queue, *structure, world.rays, results);
                    bytes.add(queue.download(results));
                }
                return bytes.get();
            }};
}

/// Every hit of rays on the device, of which some skip what they hit first.
Work finding_all(const std::string& name) {
    return {name, [](Queue& queue, const World& world) {
                Bytes bytes;
                for (const setka::Structure* structure :
                     {static_cast<const setka::Structure*>(&world.grid),
                      static_cast<const setka::Structure*>(&world.brute_force)}) {
                    const setka::RayBatch batch(world.rays, queue.upload(std::span(world.skip), "skipped"));
                    const auto counts = queue.make_buffer<std::uint32_t>(world.rays.size(), "counts");
                    setka::Tracer().count_hits(queue, *structure, batch, counts, {.max_hits = 2});
                    const auto all = setka::Tracer().all_hits(queue, *structure, batch);
                    bytes.add(queue.download(counts))
                        .add(queue.download(all.offsets))
                        .add(queue.download(all.hits));
                }
                return bytes.get();
            }};
}

/// Meshes and instances come, go and move, and a structure that was built before holds the old table.
Work editing(const std::string& name) {
    return {name, [](Queue& queue, const World& world) {
                setka::DeviceScene scene(queue, world.scene);
                const auto builder = setka::make_grid_builder({.density = 2});
                const setka::Grid before = builder->build(queue, scene);
                setka::Mesh mesh = world.scene.meshes.front();
                mesh.colors.assign(mesh.positions.size(), setka::Float3{1, 0.5f, 0});
                const std::uint32_t added = scene.add_mesh(queue, mesh);
                (void)scene.add_instance({.mesh = added, .transform = {}});
                scene.commit(queue);
                scene.set_vertices(queue, 0, mesh.positions, mesh.normals);
                scene.replace_mesh(queue, added, world.scene.meshes.back());
                scene.set_transform(0, {{2, 0, 0, 1, 0, 2, 0, 0, 0, 0, 2, 0}});
                scene.commit(queue);
                return Bytes()
                    .add(queue.download(scene.instances()))
                    .add(queue.download(scene.instance_starts()))
                    .add(queue.download(before.geometry().instances))
                    .add(queue.download(builder->build(queue, scene).geometry().triangles))
                    .get();
            },
            Work::OnOutOfMemory::MayRecover};  // a table that cannot grow by half grows by what is needed
}

/// Two frames in flight: the second is edited and built while the picture of the first is on its way.
Work rendering_frames(const std::string& name) {
    return {name,
            [](Queue& queue, const World& world) {
                setka::DeviceScene scene(queue, world.scene);
                setka::RenderOptions options;
                options.width = 12;
                options.height = 8;
                options.max_depth = 0;
                const setka::Renderer renderer(options);
                std::vector<setka::PendingImage> pictures;
                for (const float shift : {0.0f, 0.5f}) {
                    scene.set_transform(0, {{1, 0, 0, shift, 0, 1, 0, 0, 0, 0, 1, 0}});
                    scene.commit(queue);
                    const setka::Grid grid = setka::make_grid_builder({.density = 2})->build(queue, scene);
                    pictures.push_back(renderer.render_later(queue, scene, grid, *world.scene.camera));
                }
                Bytes bytes;
                for (setka::PendingImage& picture : pictures) {
                    const setka::Image image = picture.get();
                    bytes.add(image.linear).add(image.srgb);
                }
                return bytes.get();
            },
            Work::OnOutOfMemory::MayRecover};
}

Work tracing_from_host(const std::string& name) {
    return {name, [](Queue& queue, const World& world) {
                const setka::Tracer tracer;
                const std::span<const setka::Ray> rays(world.host_rays);
                const std::span<const setka::Primitive> skip(world.skip);
                const auto lists = tracer.all_hits(queue, world.grid, rays, {}, skip);
                return Bytes()
                    .add(tracer.closest_hit(queue, world.grid, rays))
                    .add(tracer.any_hit(queue, world.brute_force, rays, skip))
                    .add(tracer.count_hits(queue, world.grid, rays, {.max_hits = 2}, skip))
                    .add(lists.offsets)
                    .add(lists.hits)
                    .get();
            }};
}

}  // namespace

const std::vector<Work>& all_work() {
    static const std::vector<Work> all{
        {"upload",
         [](Queue& queue, const World& world) {
             const setka::DeviceScene scene(queue, world.scene);
             return Bytes()
                 .add(queue.download(scene.positions()))
                 .add(queue.download(scene.normals()))
                 .add(queue.download(scene.instances()))
                 .get();
         }},
        editing("edit"),
        {"plan",
         [](Queue& queue, const World& world) {
             const auto plan = setka::make_grid_builder()->plan(queue, world.on_device);
             return Bytes()
                 .add(std::vector{plan.header()})
                 .add(std::vector{plan.pair_count(), plan.row_count(), plan.table_bytes()})
                 .get();
         }},
        building("build_bins", setka::CellTables::Bins),
        building("build_scatter", setka::CellTables::Scatter),
        building_flat("build_flat", setka::CellTables::Scatter),
        building_flat("build_flat_bins", setka::CellTables::Bins),
        building("build_run_boundaries", setka::CellTables::RunBoundaries),
        building("build_binary_search", setka::CellTables::BinarySearch),
        {"brute_force",
         [](Queue& queue, const World& world) {
             return Bytes()
                 .add(queue.download(setka::BruteForce::build(queue, world.on_device).packets()))
                 .get();
         }},
        tracing<setka::Hit>("closest_hit", &setka::Tracer::closest_hit),
        tracing<std::uint32_t>("any_hit", &setka::Tracer::any_hit),
        tracing<setka::TraceCost>("cost", &setka::Tracer::closest_hit_cost),
        finding_all("all_hits"),
        tracing_from_host("trace_from_host"),
        {"save",
         [](Queue& queue, const World& world) {
             const setka::Grid loaded = setka::deserialize_grid(queue, world.saved);
             return Bytes().add(setka::serialize(queue, loaded)).get();
         }},
        {"load",
         [](Queue& queue, const World& world) {
             return grid_bytes(queue, setka::deserialize_grid(queue, world.saved));
         }},
        {"validate",
         [](Queue& queue, const World& world) {
             const setka::Grid loaded = setka::deserialize_grid(queue, world.saved);
             return loaded.digest(queue).to_string() + std::to_string(setka::validate(queue, loaded).size());
         }},
        {"camera_rays",
         [](Queue& queue, const World& world) {
             return Bytes()
                 .add(queue.download(setka::camera_rays(queue, *world.scene.camera, 9, 7, 2)))
                 .get();
         }},
        rendering("render_shaded", setka::View::Shaded),
        rendering("render_normals", setka::View::Normals),
        rendering("render_depth", setka::View::Depth),
        rendering("render_tests", setka::View::Tests),
        rendering_in_passes(),
        rendering_frames("render_frames"),
    };
    return all;
}

std::vector<std::string> work_names() {
    std::vector<std::string> names;
    for (const Work& work : all_work()) names.push_back(work.name);
    return names;
}

const Work& find_work(const std::string& name) {
    for (const Work& work : all_work())
        if (work.name == name) return work;
    throw std::invalid_argument("no work is called " + name);
}

}  // namespace faults
