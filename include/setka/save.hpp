// SPDX-License-Identifier: MIT
/// How does a built structure outlive the process? Saved as a file or as bytes to embed, and loaded on any
/// device, bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "setka/grid.hpp"

namespace setka {

// The format is specified in setka/file_format.h: every byte is determined by the structure and is under a
// checksum.
//
// Loading trusts nothing. A file that is damaged, truncated, of another program or of a newer setka is
// refused before anything is allocated on the device, and so is one whose tables break what traversal relies
// on, whatever its checksums say: no file makes a kernel read beyond a table. What a list should hold is not
// checked, since only a build knows.

/// Writes a grid. The file appears complete or not at all, also where it is cancelled, and replaces an older
/// one in one step. Waits and downloads. Throws InvalidArgument if the file cannot be written, with the reason, or if the grid itself
/// breaks an invariant; OutOfMemory if the device has no room for Grid::tables().
void save(Queue& queue, const Grid& grid, const std::filesystem::path& file);

/// The bytes that save() writes.
[[nodiscard]] std::vector<std::byte> serialize(Queue& queue, const Grid& grid);

/// Loads what save() wrote, on this or any other device: the same tables, digest and hits. The scene is not
/// needed for tracing; to render, upload the scene that the grid was built of. Throws InvalidData for a file
/// that cannot be read, is no file of setka, or is damaged, Unsupported for one of a newer format,
/// OutOfMemory if the tables do not fit the device's budget.
[[nodiscard]] Grid load_grid(Queue& queue, const std::filesystem::path& file);

/// The same from bytes in memory, at any alignment.
[[nodiscard]] Grid deserialize_grid(Queue& queue, std::span<const std::byte> bytes);

/// What a grid on a device violates of what traversal relies on, in sentences; empty for every grid that a
/// builder made. Each invariant is named once, with the first place. Waits and downloads.
[[nodiscard]] std::vector<std::string> validate(Queue& queue, const Grid& grid);

/// A section of a saved structure.
struct SavedSection {
    std::string name;
    std::uint64_t offset_bytes = 0;  ///< in the file
    std::uint64_t size_bytes = 0;
    std::uint64_t checksum = 0;  ///< XXH3-64
};

/// What a saved structure says of itself, and what is wrong with it.
struct SavedStructure {
    std::uint32_t format_version = 0;
    StructureKind kind = StructureKind::UniformGrid;
    std::uint64_t size_bytes = 0;        ///< of the file or the bytes, as found
    Digest digest;                       ///< as stated
    std::vector<SavedSection> sections;  ///< empty if the table of sections is damaged
    ::SetkaGridHeader grid{};            ///< zeros if the section is damaged
    /// Damage and broken invariants in sentences, for people; empty if it loads. Later stages of the
    /// examination are left out where an earlier one found something.
    std::vector<std::string> violations;
};

/// Examines a saved structure on the host, as loading does. Throws InvalidData if it cannot be read or is no
/// file of setka, Unsupported for a newer format or a kind that this build does not know; everything else is
/// a violation.
[[nodiscard]] SavedStructure inspect(const std::filesystem::path& file);
[[nodiscard]] SavedStructure inspect(std::span<const std::byte> bytes);

}  // namespace setka
