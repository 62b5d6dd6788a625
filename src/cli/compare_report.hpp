// SPDX-License-Identifier: MIT
/// How does a comparison of devices read? As a table for people, or as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/compare_run.hpp"

namespace setka::cli {

/// What became of one device.
struct CompareRow {
    std::string label;  ///< "opencl:0/serial", or what was asked for if that is all there is
    DeviceInfo device;  ///< empty if it could not be opened
    std::string primitives;
    std::string error;  ///< why there are no figures; then nothing below holds
    workload::Measurement build;
    std::vector<StepFigures> steps;
    std::optional<workload::Difference>
        difference;  ///< from the reference; of the reference: between its steps

    [[nodiscard]] bool is_equal() const { return error.empty() && !difference; }
};

struct CompareReport {
    std::string scene;
    std::uint64_t triangles = 0;
    SetkaGridHeader grid{};                ///< the reference's
    std::optional<std::size_t> reference;  ///< the first row without an error
    std::vector<CompareRow> rows;
    double wall_ms = 0;

    [[nodiscard]] bool is_equal() const;
};

void print_text(const CompareReport& report, const CompareWork& work);
void print_json(const CompareReport& report, const CompareWork& work);

}  // namespace setka::cli
