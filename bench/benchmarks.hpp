// SPDX-License-Identifier: MIT
/// Which benchmarks are there? Those of scenes and those of primitives, registered when scenes and devices
/// are known.
#pragma once

#include <vector>

#include "bench/embree.hpp"
#include "bench/fixture.hpp"
#include "bench/options.hpp"
#include "bench/scenes.hpp"
#include "bench/target.hpp"
#include "bench/validation.hpp"

namespace setka::bench {

/// What all benchmarks share. Their order, all of a fixture one after the other, lets each fixture be made
/// once.
struct Bench {
    const Options& options;
    std::vector<Target> targets;
    std::vector<EmbreeQuality> embree;
    std::vector<SceneCase> scenes;
    Validator& validator;
    SceneLoader loader;
    FixtureSlot slot;
};

/// scan/ELEMENTS/TARGET and sort/…. The bench has to outlive the run.
void register_primitives(Bench& bench);

/// build/TARGET/SCENE, trace/KIND/STEP/DEVICE/SCENE, frame/TARGET/SCENE, by scene, then by device, then by
/// density, which ends the name if there are several. Embree follows the devices, under a name of its own in
/// TARGET's place.
void register_scenes(Bench& bench);

}  // namespace setka::bench
