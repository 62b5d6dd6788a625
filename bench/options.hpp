// SPDX-License-Identifier: MIT
/// What is to be measured? setka's own options, taken from the command line before Google Benchmark's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "setka/grid.hpp"
#include "setka/tracer.hpp"

namespace setka::bench {

struct Options {
    std::vector<std::string> scenes;     ///< as written; empty: see choose_scenes
    std::filesystem::path scene_folder;  ///< where scene files are
    std::filesystem::path golden;        ///< the file of golden digests
    bool golden_was_named = false;       ///< then the file has to be there
    std::vector<std::string> devices;    ///< "id" or "id/shape"; empty: every device
    std::vector<float> densities{GridOptions{}.density};  ///< of the grids that are timed
    std::uint32_t size = 1024;           ///< rays along each side of the square picture
    std::uint32_t picture_width = 1920, picture_height = 1080;  ///< of moving scenes
    std::vector<GridStep> steps{GridStep::Dda, GridStep::BranchFree};
    std::vector<std::uint32_t> elements{1u << 16, 1u << 20, 1u << 24};  ///< sizes of scan and sort
};

/// Takes setka's options out of the arguments and leaves the others. Throws InvalidArgument for a value out
/// of range.
[[nodiscard]] Options take_options(int& argc, char** argv);

/// As short as it can be without loss: "4", "0.5".
[[nodiscard]] std::string to_string(float density);

/// setka's options, then Google Benchmark's, on standard output.
void print_help();

[[nodiscard]] const char* to_string(GridStep step) noexcept;

}  // namespace setka::bench
