// SPDX-License-Identifier: MIT
/// What must every device compute? A table of fingerprints that one device made once, in a text file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "workload/fingerprint.hpp"

namespace setka::workload {

/// What is computed: a named scene, seen from a viewpoint, in a grid of a density.
struct GoldenCase {
    std::string scene;
    Viewpoint viewpoint = Viewpoint::Outside;
    float density = 4;
    friend bool operator==(const GoldenCase&, const GoldenCase&) = default;

    [[nodiscard]] std::string to_string() const;  ///< "spheres:1000000 outside 4"
};

struct GoldenRow {
    GoldenCase what;
    Fingerprint fingerprint;
};

/// Lines "scene viewpoint density tables primary shadow diffuse picture"; '#' starts a comment, which says who made them.
/// Throws InvalidData with the file and line of what is not such a row.
[[nodiscard]] std::vector<GoldenRow> read_golden(const std::filesystem::path& file);

/// One line of the file.
[[nodiscard]] std::string to_line(const GoldenRow& row);

/// The row of a case, or nullptr.
[[nodiscard]] const GoldenRow* find_golden(const std::vector<GoldenRow>& rows, const GoldenCase& what);

}  // namespace setka::workload
