// SPDX-License-Identifier: MIT
/// Which scenes are measured, and which one is in the host's memory? One at a time: some have ten million
/// triangles.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/options.hpp"
#include "setka/scene.hpp"
#include "workload/golden.hpp"
#include "workload/named_scene.hpp"
#include "workload/standard_view.hpp"

namespace setka::bench {

/// A scene seen from a viewpoint: "arch/sponza.obj@inside", or without a suffix from outside.
struct SceneCase {
    workload::NamedScene scene;
    workload::Viewpoint viewpoint = workload::Viewpoint::Outside;
    friend bool operator==(const SceneCase& a, const SceneCase& b) {
        return a.scene.name == b.scene.name && a.viewpoint == b.viewpoint;
    }

    [[nodiscard]] std::string to_string() const;
};

/// The scenes that were named; else those of the golden file that can be loaded, with a line on standard
/// error about the others; else two procedural ones. Throws InvalidArgument for a named scene that is not
/// there.
[[nodiscard]] std::vector<SceneCase> choose_scenes(const Options& options,
                                                   const std::vector<workload::GoldenRow>& golden);

struct LoadedScene {
    Scene scene;  ///< with lights
    workload::StandardView view;
};

/// The scene asked for last.
class SceneLoader {
  public:
    explicit SceneLoader(std::filesystem::path folder) : folder_(std::move(folder)) {}
    [[nodiscard]] const LoadedScene& load(const SceneCase& wanted);

  private:
    std::filesystem::path folder_;
    SceneCase current_;
    std::optional<LoadedScene> loaded_;
};

}  // namespace setka::bench
