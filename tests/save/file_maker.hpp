// SPDX-License-Identifier: MIT
/// What is the right file of a grid, and how is a wrong one made? A second writer of the format, from the
/// oracle's tables, which shares only plain structs with the library. No device is needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "oracle/oracle.hpp"
#include "setka/file_format.h"

namespace save_test {

using Bytes = std::vector<std::byte>;

/// A grid's tables, to be spoiled one by one.
struct Model {
    SetkaGridHeader header{};
    SetkaBounds bounds{};
    std::vector<std::int32_t> offsets;
    std::vector<std::uint32_t> counts, references;
    std::vector<float> triangles;
    std::vector<std::uint32_t> instance_starts;
    std::vector<SetkaInstance> instances;
};

/// By default so coarse that some cells have several triangles.
[[nodiscard]] Model model_of(const oracle::Scene& scene, const oracle::GridOptions& options = {.density = 4});

/// Another size of cells, with what follows from it.
void scale_cells(Model& model, float factor);

/// Its file, with right checksums whatever the tables hold.
[[nodiscard]] Bytes file_of(const Model& model);

[[nodiscard]] SetkaFileHeader header_of(const Bytes& file);
[[nodiscard]] SetkaFileSection section_of(const Bytes& file, std::size_t index);
void set_header(Bytes& file, const SetkaFileHeader& header);
void set_section(Bytes& file, std::size_t index, const SetkaFileSection& section);

/// Makes the checksum of header and table right again; the table may be the header's or another size.
void seal_head(Bytes& file);
/// Makes every checksum and the digest right again, of a file whose table is intact.
void seal(Bytes& file);

/// A scene of four small triangles in opposite corners, in two instances: most of its cells are empty.
[[nodiscard]] oracle::Scene small_scene();

}  // namespace save_test
