// SPDX-License-Identifier: MIT
/// Which scenes are measured, and which one is in the host's memory? See the header.
#include "bench/scenes.hpp"

#include <algorithm>
#include <cstdio>

#include "setka/error.hpp"

namespace setka::bench {

namespace {

[[nodiscard]] Error not_there(const std::string& name, const std::filesystem::path& folder) {
    return Error(ErrorCategory::InvalidArgument,
                 "scene '" + name + "' is neither built in nor in the scene folder '" + folder.string() +
                     "'; accepted: NAME:TRIANGLES, a file, or without setka::io the file's .snapshot");
}

[[nodiscard]] SceneCase parse_scene(const std::string& text) {
    const std::size_t at = text.rfind('@');
    if (at == std::string::npos) return {{text}};
    const std::string viewpoint = text.substr(at + 1);
    for (const auto candidate : {workload::Viewpoint::Outside, workload::Viewpoint::Inside})
        if (viewpoint == workload::to_string(candidate)) return {{text.substr(0, at)}, candidate};
    throw Error(ErrorCategory::InvalidArgument,
                "scene '" + text + "' has the viewpoint '" + viewpoint + "'; accepted: inside, outside");
}

[[nodiscard]] std::vector<SceneCase> golden_scenes(const std::filesystem::path& folder,
                                                   const std::vector<workload::GoldenRow>& golden) {
    std::vector<SceneCase> scenes;
    std::string left_out;
    for (const workload::GoldenRow& row : golden) {
        const SceneCase scene{{row.what.scene}, row.what.viewpoint};
        if (std::ranges::find(scenes, scene) != scenes.end()) continue;
        if (scene.scene.exists(folder)) scenes.push_back(scene);
        else left_out += ' ' + scene.to_string();
    }
    if (!left_out.empty())
        std::fprintf(stderr, "setka_bench: left out, not in the scene folder '%s':%s\n", folder.c_str(),
                     left_out.c_str());
    return scenes;
}

}  // namespace

std::string SceneCase::to_string() const {
    if (viewpoint == workload::Viewpoint::Outside) return scene.name;
    return scene.name + '@' + workload::to_string(viewpoint);
}

std::vector<SceneCase> choose_scenes(const Options& options, const std::vector<workload::GoldenRow>& golden) {
    std::vector<SceneCase> scenes;
    for (const std::string& name : options.scenes) {
        scenes.push_back(parse_scene(name));
        if (!scenes.back().scene.exists(options.scene_folder))
            throw not_there(scenes.back().scene.name, options.scene_folder);
    }
    if (scenes.empty()) scenes = golden_scenes(options.scene_folder, golden);
    if (scenes.empty()) scenes = {{{"spheres:100000"}}, {{"terrain:100000"}}};
    return scenes;
}

const LoadedScene& SceneLoader::load(const SceneCase& wanted) {
    if (loaded_ && current_ == wanted) return *loaded_;
    loaded_.reset();  // before the next one is read
    std::optional<Scene> scene = wanted.scene.load(folder_);
    if (!scene) throw not_there(wanted.scene.name, folder_);
    const workload::StandardView view = workload::standard_view(scene->bounds(), wanted.viewpoint);
    if (scene->point_lights.empty() && scene->directional_lights.empty())
        add_default_lights(*scene, view.camera);
    current_ = wanted;
    loaded_ = LoadedScene{std::move(*scene), view};
    return *loaded_;
}

}  // namespace setka::bench
