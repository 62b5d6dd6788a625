// SPDX-License-Identifier: MIT
/// What do the golden digests have to be? Computes them on one device and prints the file
/// tests/golden/digests.txt; or writes snapshots of the scene files for a machine whose build cannot read
/// them.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <span>

#include "golden/cases.hpp"
#include "setka/error.hpp"
#include "setka/version.hpp"
#include "workload/named_scene.hpp"
#include "workload/snapshot.hpp"

namespace {

namespace fs = std::filesystem;
using namespace setka;

constexpr const char* usage =
    "usage: setka_golden digests SCENES [DEVICE [SCENE...]]\n"
    "                                              prints the digests that DEVICE computes, of all cases or of these scenes\n"
    "       setka_golden snapshots SCENES FOLDER [PART...]\n"
    "                                              writes a snapshot of each scene file that has digests, or "
    "else of every one\n"
    "                                              in these parts of SCENES, as scan, or of one scene, as "
    "gltf/Duck.glb\n";

[[nodiscard]] Scene load(const std::string& name, const fs::path& scenes) {
    if (auto scene = workload::NamedScene{name}.load(scenes)) return std::move(*scene);
    throw Error(ErrorCategory::InvalidData,
                "there is no " + (scenes / name).string() + " and no snapshot of it");
}

[[nodiscard]] std::vector<workload::GoldenCase> cases_of(std::span<char* const> names) {
    if (names.empty()) return golden::cases();
    std::vector<workload::GoldenCase> cases;
    for (const std::string name : names) {
        const std::size_t before = cases.size();
        for (const workload::GoldenCase& what : golden::cases())
            if (what.scene == name) cases.push_back(what);
        if (cases.size() == before) cases.push_back({name});
    }
    return cases;
}

void print_digests(const fs::path& scenes, const std::string& selector, std::span<char* const> names) {
    const Device device = Device::open(selector);
    Queue queue = device.make_queue();
    const DeviceInfo& info = device.info();
    std::printf("# Made by setka %s on %s: %s (%s), driver %s.\n", version(), to_string(info.backend),
                info.name.c_str(), info.platform.c_str(), info.driver.c_str());
    std::printf("# %u x %u rays, picture %u x %u. Remake with scripts/golden.\n",
                workload::fingerprint_rays_size, workload::fingerprint_rays_size, workload::fingerprint_width,
                workload::fingerprint_height);
    std::printf("# scene viewpoint density tables primary shadow diffuse picture\n");
    for (const workload::GoldenCase& what : cases_of(names)) {
        const Scene scene = load(what.scene, scenes);
        const GridOptions options{.density = what.density};
        const auto take = [&](GridStep step) {
            return workload::take_fingerprint(queue, scene, what.viewpoint, options, step);
        };
        const workload::Fingerprint fingerprint = take(GridStep::Dda);
        if (take(GridStep::BranchFree) != fingerprint)
            throw Error(ErrorCategory::Internal, "the two steps differ on " + what.to_string());
        std::printf("%s\n", workload::to_line({what, fingerprint}).c_str());
        std::fflush(stdout);
    }
}

[[nodiscard]] std::vector<std::string> scene_files(const fs::path& scenes, std::span<char* const> parts) {
    std::vector<std::string> names;
    if (parts.empty())
        for (const workload::GoldenCase& what : golden::cases())
            if (what.scene.find('/') != std::string::npos)
                names.push_back(what.scene);  // the others are built in
    for (const char* part : parts) {
        if (std::strchr(part, '/') && workload::NamedScene{part}.exists(scenes) && !fs::is_directory(scenes / part)) {
            names.emplace_back(part);
            continue;
        }
        const auto more = workload::names_of_scenes(scenes, part);
        if (more.empty())
            throw Error(ErrorCategory::InvalidArgument, "there is no scene in " + (scenes / part).string());
        names.insert(names.end(), more.begin(), more.end());
    }
    return names;
}

void write_snapshots(const fs::path& scenes, const fs::path& folder, std::span<char* const> parts) {
    for (const std::string& name : scene_files(scenes, parts)) {
        const fs::path file = folder / (name + ".snapshot");
        if (fs::exists(file)) continue;
        fs::create_directories(file.parent_path());
        workload::write_snapshot(file, load(name, scenes));
        std::printf("%s\n", file.c_str());
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string verb = argc > 1 ? argv[1] : "";
        const std::span<char* const> rest(argv + std::min(argc, 4), argv + argc);
        if (verb == "digests" && argc >= 3) print_digests(argv[2], argc > 3 ? argv[3] : "", rest);
        else if (verb == "snapshots" && argc > 3) write_snapshots(argv[2], argv[3], rest);
        else return std::fputs(usage, stderr), 2;
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "setka_golden: %s\n", error.what());
        return 1;
    }
}
