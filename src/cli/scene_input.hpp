// SPDX-License-Identifier: MIT
/// Which scene does a command work on? One or several mesh files, or one built-in scene.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "setka/scene.hpp"

namespace setka::cli {

/// FILES and --triangles.
struct SceneInput {
    std::vector<std::string> files;
    std::uint64_t triangles = 0;

    void add_to(CLI::App& app);
    /// The same with another description of what files may be.
    void add_to(CLI::App& app, const std::string& description);
    /// Reads or makes the scene. Throws what io::load_scene and make_scene throw.
    [[nodiscard]] Scene load() const;
    /// True if it is one built-in scene.
    [[nodiscard]] bool is_built_in() const;
    /// The names as given, for reports.
    [[nodiscard]] std::string name() const;
};

/// The names of the built-in scenes, "showcase, terrain, …".
[[nodiscard]] std::string built_in_names();

/// Turns the whole scene, lights and camera included, so that its direction `up` becomes +y.
void turn_up(Scene& scene, const Float3& up);
/// The same turn for what moved in the scene.
void turn_up(SceneUpdate& update, const Float3& up);
/// The same turn for a point.
[[nodiscard]] Float3 turn_up(const Float3& point, const Float3& up);

/// Throws InvalidArgument if `file` cannot be written: its folder is missing or read-only, or it is a folder
/// itself.
void check_writable(const std::filesystem::path& file);

}  // namespace setka::cli
