// SPDX-License-Identifier: MIT
/// Which scene is meant by a name? A built-in scene with its size, or a file in a folder of scenes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "setka/scene.hpp"

namespace setka::workload {

/// "spheres:1000000", or a path in the folder: of a file, "scan/dragon.obj", or of a folder, all of whose OBJ files are one
/// scene. What moves has a moment, "gltf/CesiumMilkTruck.glb+0.5": seconds of an animation, the number of a sequence's frame.
/// A build without setka::io reads the snapshot "scan/dragon.obj.snapshot" instead.
struct NamedScene {
    std::string name;

    /// Whether load() would find something to read.
    [[nodiscard]] bool exists(const std::filesystem::path& folder) const;
    /// Nothing if the name is no built-in scene and the folder has no such file. Throws what reading it throws.
    [[nodiscard]] std::optional<Scene> load(const std::filesystem::path& folder) const;
};

/// The names of all scenes in a part of the folder, "scan", in order. A folder below it that holds OBJ files is one scene; of any
/// other, every file that this build reads is one. Empty if there is no such part.
[[nodiscard]] std::vector<std::string> names_of_scenes(const std::filesystem::path& folder, const std::string& part);

}  // namespace setka::workload
