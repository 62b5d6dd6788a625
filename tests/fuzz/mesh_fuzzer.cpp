// SPDX-License-Identifier: MIT
/// Which mesh file breaks a reader, or what comes after it? A byte for the format, then the file; what
/// follows a line
/// "%%" is a second file, as materials or a glTF buffer: refused as InvalidData, or else a scene that is
/// built and traced.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string_view>

#include "fuzz/check.hpp"
#include "fuzz/host_device.hpp"
#include "fuzz/queries.hpp"
#include "fuzz/scene_input.hpp"
#include "setka/io.hpp"
#include "setka/save.hpp"

namespace {

using setka::ErrorCategory;

/// A folder of this process, in memory where the system has such a place.
const std::filesystem::path& folder() {
    static const struct Folder {
        Folder() {
            const bool has_memory = std::filesystem::is_directory("/dev/shm");
            path = (has_memory ? "/dev/shm" : std::filesystem::temp_directory_path()) /
                   ("setka-fuzz-" + std::to_string(::getpid()));
            std::filesystem::create_directory(path);
        }
        ~Folder() { std::filesystem::remove_all(path); }
        std::filesystem::path path;
    } folder;
    return folder.path;
}

void write(const std::filesystem::path& file, std::string_view bytes) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << bytes;
    fuzz::check(stream.good(), "the file is written");
}

void check_scene(const setka::Scene& scene) {
    setka::Queue& queue = fuzz::queue();
    (void)fuzz::succeeds({ErrorCategory::InvalidData, ErrorCategory::OutOfMemory}, [&] {
        const setka::DeviceScene device_scene(queue, scene);
        const setka::Grid grid = setka::make_grid_builder()->build(queue, device_scene);
        const oracle::World world = oracle::make_world(scene);
        fuzz::Queries queries;
        const auto& box = world.bounds;
        for (const oracle::WorldTriangle& t :
             std::span(world.triangles).first(std::min<std::size_t>(world.triangles.size(), 8)))
            queries.rays.push_back({{box.upper[0], box.upper[1], box.upper[2]},
                                    0,
                                    {t.vertex[0][0] - box.upper[0], t.vertex[1][1] - box.upper[1],
                                     t.vertex[2][2] - box.upper[2]},
                                    std::numeric_limits<float>::infinity()});
        fuzz::check_queries(queue, grid, queries, fuzz::right_hits(world, queries));
    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static constexpr std::string_view extensions[] = {"obj", "ply", "stl", "off", "gltf", "glb"};
    if (size == 0) return 0;
    std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
    constexpr std::string_view divider = "\n%%\n";
    if (const std::size_t at = bytes.rfind(divider); at != bytes.npos) {
        write(folder() / "b", bytes.substr(at + divider.size()));
        bytes = bytes.substr(0, at);
    }
    const std::filesystem::path file =
        folder() / ("a." + std::string(extensions[data[0] % std::size(extensions)]));
    write(file, bytes);
    setka::Scene scene;
    const bool loads =
        fuzz::succeeds({ErrorCategory::InvalidData}, [&] { scene = setka::io::load_scene(file); });
    std::filesystem::remove(file);
    std::filesystem::remove(folder() / "b");
    if (loads && scene.triangle_count() <= 200) check_scene(scene);
    return 0;
}
