// SPDX-License-Identifier: MIT
/// What is setka compared with? Intel's Embree on the host's cores, where this build has it.
#pragma once

#include <string>
#include <vector>

#include "bench/scenes.hpp"

namespace setka::bench {

struct Bench;

enum class EmbreeQuality {
    Low,     ///< the fastest build, in a dynamic scene: for what moves
    Medium,  ///< the default build, in a static scene: for what stays
};

/// Whether a name of --devices means Embree and no device of setka: "embree", "embree/low".
[[nodiscard]] inline bool is_embree(const std::string& name) {
    return name == "embree" || name.starts_with("embree/");
}

/// What the names stand for that mean Embree; all there is for an empty list. Throws InvalidArgument for one
/// that stands for nothing, Unsupported for any in a build without Embree.
[[nodiscard]] std::vector<EmbreeQuality> find_embree(const std::vector<std::string>& names);

/// Says in the report's "context" what those are.
void add_embree_context(const std::vector<EmbreeQuality>& qualities);

/// build/embree/QUALITY/SCENE, frame/embree/QUALITY/SCENE, trace/KIND/COHERENCE/embree-QUALITY/SCENE.
void register_embree(Bench& bench, const SceneCase& scene);

}  // namespace setka::bench
