// SPDX-License-Identifier: MIT
/// What are rays traced against? --structure and its options.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "cli/options.hpp"
#include "setka/grid.hpp"

namespace setka::cli {

struct StructureChoice {
    StructureKind kind = StructureKind::UniformGrid;
    GridOptions grid;

    void add_to(CLI::App& app) {
        add_choice<StructureKind>(
            app, "--structure", kind,
            {{"grid", StructureKind::UniformGrid}, {"brute-force", StructureKind::BruteForce}},
            "what to trace; the result is the same");
        add_grid_options(app, grid);
    }
    [[nodiscard]] std::unique_ptr<Structure> build(Queue& queue, const DeviceScene& scene) const {
        if (kind == StructureKind::BruteForce)
            return std::make_unique<BruteForce>(BruteForce::build(queue, scene));
        return std::make_unique<Grid>(make_grid_builder(grid)->build(queue, scene));
    }
};

}  // namespace setka::cli
