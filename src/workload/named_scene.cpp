// SPDX-License-Identifier: MIT
/// Which scene is meant by a name? See the header.
#include "workload/named_scene.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "setka/error.hpp"
#include "setka/scenes.hpp"
#include "workload/snapshot.hpp"
#ifdef SETKA_HAS_IO
#include "setka/animation.hpp"
#include "setka/io.hpp"
#endif

namespace setka::workload {

namespace {

[[nodiscard]] bool is_built_in(const std::string& name) {
    return std::ranges::find(built_in_scenes(), name, &BuiltInScene::name) != built_in_scenes().end();
}

[[nodiscard]] std::filesystem::path snapshot_of(const std::filesystem::path& folder,
                                                const std::string& name) {
    return folder / (name + ".snapshot");
}

#ifdef SETKA_HAS_IO
/// What moves, at a moment.
struct Pose {
    std::filesystem::path source;
    double moment = 0;

    [[nodiscard]] Scene load() const {
        const io::Animation animation(source);
        Scene scene = animation.scene();
        if (animation.kind() != io::MotionKind::Sequence) apply(scene, animation.at(moment));
        else if (moment == std::floor(moment)) apply(scene, animation.frame(static_cast<std::uint32_t>(moment)));
        else throw Error(ErrorCategory::InvalidArgument, "frames have whole numbers, not " + std::to_string(moment));
        return scene;
    }
};

/// Nothing if the name has no moment, or if there is nothing of that name.
[[nodiscard]] std::optional<Pose> find_pose(const std::filesystem::path& folder, const std::string& name) {
    const std::size_t plus = name.rfind('+');
    if (plus == std::string::npos || plus == 0 || !std::filesystem::exists(folder / name.substr(0, plus))) return {};
    double moment = 0;
    const char* const end = name.data() + name.size();
    const auto read = std::from_chars(name.data() + plus + 1, end, moment);
    if (read.ptr != end || read.ec != std::errc{} || !(moment >= 0 && moment < 1e9))
        throw Error(ErrorCategory::InvalidArgument, "'" + name + "' has no moment after the plus");
    return Pose{folder / name.substr(0, plus), moment};
}

/// The file itself, or the OBJ files of a folder in the order of their names.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path))
        if (entry.path().extension() == ".obj") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

[[nodiscard]] bool is_mesh_file(const std::filesystem::path& file) {
    static constexpr std::array extensions{".obj", ".ply", ".stl", ".off", ".gltf", ".glb"};
    std::string extension = file.extension().string();
    for (char& c : extension) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return std::ranges::find(extensions, extension) != extensions.end();
}

[[nodiscard]] bool is_one_scene(const std::filesystem::path& directory) {
    return !files_of(directory).empty();
}
#else
[[nodiscard]] bool is_mesh_file(const std::filesystem::path&) { return false; }
[[nodiscard]] bool is_one_scene(const std::filesystem::path&) { return false; }
#endif

void add_names(const std::filesystem::path& folder, const std::filesystem::path& part,
               std::vector<std::string>& names) {
    for (const auto& entry : std::filesystem::directory_iterator(folder / part)) {
        const std::filesystem::path path = part / entry.path().filename();
        if (entry.is_directory() && !is_one_scene(entry.path())) add_names(folder, path, names);
        else if (entry.is_directory() || is_mesh_file(path)) names.push_back(path.generic_string());
        else if (path.extension() == ".snapshot") names.push_back((part / path.stem()).generic_string());
    }
}

}  // namespace

bool NamedScene::exists(const std::filesystem::path& folder) const {
#ifdef SETKA_HAS_IO
    if (std::filesystem::exists(folder / name) || find_pose(folder, name)) return true;
#endif
    return is_built_in(name.substr(0, name.find(':'))) || std::filesystem::exists(snapshot_of(folder, name));
}

std::optional<Scene> NamedScene::load(const std::filesystem::path& folder) const {
    const std::size_t colon = name.find(':');
    const std::string first = name.substr(0, colon);
    if (is_built_in(first)) {
        std::uint64_t triangles = 0;
        const char* const end = name.data() + name.size();
        if (colon != std::string::npos && std::from_chars(name.data() + colon + 1, end, triangles).ptr != end)
            throw Error(ErrorCategory::InvalidArgument, "'" + name + "' has no size after the colon");
        return make_scene(first, triangles);
    }
#ifdef SETKA_HAS_IO
    if (std::filesystem::exists(folder / name)) return io::load_scene(files_of(folder / name));
    if (const auto pose = find_pose(folder, name)) return pose->load();
#endif
    const std::filesystem::path snapshot = snapshot_of(folder, name);
    if (std::filesystem::exists(snapshot)) return read_snapshot(snapshot);
    return std::nullopt;
}

std::vector<std::string> names_of_scenes(const std::filesystem::path& folder, const std::string& part) {
    std::vector<std::string> names;
    if (std::filesystem::is_directory(folder / part)) add_names(folder, part, names);
    std::ranges::sort(names);
    const auto repeated = std::ranges::unique(names);  // a file beside its own snapshot
    names.erase(repeated.begin(), repeated.end());
    return names;
}

}  // namespace setka::workload
