// SPDX-License-Identifier: MIT
/// Do saved grids work from an installed package? Saves one into the folder given, loads it again and compares.
#include <cstdio>
#include <filesystem>
#include <setka/setka.hpp>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::filesystem::path file = std::filesystem::path(argv[1]) / "torus.setka";
    setka::Queue queue = setka::Device::open().make_queue();
    const setka::DeviceScene scene(queue, setka::make_scene("torus"));
    const setka::Grid grid = setka::make_grid_builder()->build(queue, scene);
    setka::save(queue, grid, file);
    const setka::SavedStructure saved = setka::inspect(file);
    for (const std::string& violation : saved.violations) std::printf("%s\n", violation.c_str());
    const setka::Grid loaded = setka::load_grid(queue, file);
    const std::string digest = loaded.digest(queue).to_string();
    std::printf("format %u, digest %s\n", SETKA_FILE_VERSION, digest.c_str());
    return saved.violations.empty() && loaded.digest(queue) == grid.digest(queue) ? 0 : 1;
}
