// SPDX-License-Identifier: MIT
/// What must every device compute? See the header.
#include "workload/golden.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/digest.hpp"
#include "setka/error.hpp"

namespace setka::workload {

namespace {

[[nodiscard]] GoldenRow parse_row(const std::string& line) {
    std::istringstream words(line);
    GoldenRow row;
    std::string viewpoint, digests[5], surplus;
    words >> row.what.scene >> viewpoint >> row.what.density;
    for (std::string& digest : digests) words >> digest;
    if (!words || !(row.what.density > 0) || (viewpoint != "inside" && viewpoint != "outside") || words >> surplus)
        throw Error(ErrorCategory::InvalidData,
                    "'" + line + "' is not a row: scene, inside or outside, density and five digests");
    if (viewpoint == "inside") row.what.viewpoint = Viewpoint::Inside;
    row.fingerprint = {parse_digest(digests[0]), parse_digest(digests[1]), parse_digest(digests[2]),
                       parse_digest(digests[3]), parse_digest(digests[4])};
    return row;
}

}  // namespace

std::string GoldenCase::to_string() const {
    std::ostringstream text;
    text << scene << ' ' << workload::to_string(viewpoint) << ' ' << density;
    return text.str();
}

std::vector<GoldenRow> read_golden(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) throw Error(ErrorCategory::InvalidData, file.string() + ": cannot be opened");
    std::vector<GoldenRow> rows;
    std::size_t number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        line.resize(std::min(line.find('#'), line.size()));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        try {
            rows.push_back(parse_row(line));
        } catch (const Error& error) {
            throw Error(error.category(), file.string() + ":" + std::to_string(number) + ": " + error.what());
        }
    }
    return rows;
}

std::string to_line(const GoldenRow& row) {
    std::string line = row.what.to_string();
    for (const auto& [name, digest] : row.fingerprint.parts()) line += ' ' + digest.to_string();
    return line;
}

const GoldenRow* find_golden(const std::vector<GoldenRow>& rows, const GoldenCase& what) {
    const auto it = std::ranges::find(rows, what, &GoldenRow::what);
    return it == rows.end() ? nullptr : &*it;
}

}  // namespace setka::workload
