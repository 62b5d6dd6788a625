// SPDX-License-Identifier: MIT
/// How do named sections become the bytes of a file, and which bytes are such a file? The container of
/// setka/file_format.h, whatever the structure in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "setka/file_format.h"
#include "setka/save.hpp"

namespace setka {

/// Lays out a file, lets its sections be filled in place, and seals it.
class SectionWriter {
  public:
    SectionWriter(std::uint32_t kind, std::span<const Section> sections);

    /// The bytes of section i as elements, to be written.
    template <typename T>
    [[nodiscard]] std::span<T> section(std::size_t i) {
        const SavedSection& place = places_[i];
        return {reinterpret_cast<T*>(bytes_.data() + place.offset_bytes), place.size_bytes / sizeof(T)};
    }
    /// Writes header and table, with checksums.
    [[nodiscard]] std::vector<std::byte> finish(const Digest& digest) &&;

  private:
    std::uint32_t kind_;
    std::vector<SavedSection> places_;
    std::vector<std::byte> bytes_;
};

/// The sections of a file, as far as they can be told.
struct SectionFile {
    ::SetkaFileHeader header{};
    std::vector<SavedSection> sections;  ///< empty unless the table holds
    std::vector<std::string>
        violations;  ///< in sentences; without any, all of the file is in place and undamaged
};

/// Throws InvalidData if bytes that begin like this are no file of setka, Unsupported if their format is not
/// this build's.
void check_beginning(std::span<const std::byte> bytes);

/// Examines bytes. Throws what check_beginning() throws.
[[nodiscard]] SectionFile read_sections(std::span<const std::byte> bytes);

}  // namespace setka
