// SPDX-License-Identifier: MIT
#include "fuzz/seal.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>

#include "setka/file_format.h"

namespace fuzz {

namespace {

using Bytes = std::vector<std::byte>;

/// What of [offset, offset + size) lies in the file.
std::span<const std::byte> part(const Bytes& file, std::uint64_t offset, std::uint64_t size) {
    if (offset > file.size()) return {};
    return std::span(file).subspan(offset, std::min<std::uint64_t>(size, file.size() - offset));
}

std::uint64_t hash(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

}  // namespace

void seal(Bytes& file) {
    SetkaFileHeader header;
    if (file.size() < sizeof header) return;
    std::memcpy(&header, file.data(), sizeof header);
    const std::uint64_t entries = std::min<std::uint64_t>(
        header.section_count, (file.size() - sizeof header) / sizeof(SetkaFileSection));
    Bytes tables;
    for (std::uint64_t i = 0; i < entries; ++i) {
        SetkaFileSection section;
        std::byte* place = file.data() + sizeof header + i * sizeof section;
        std::memcpy(&section, place, sizeof section);
        const auto bytes = part(file, section.offset, section.size_bytes);
        section.checksum = hash(bytes);
        std::memcpy(place, &section, sizeof section);
        if (i == 0 || (i >= 2 && i <= 4)) tables.insert(tables.end(), bytes.begin(), bytes.end());
    }
    const XXH128_hash_t digest = XXH3_128bits(tables.data(), tables.size());
    header.digest_high = digest.high64;
    header.digest_low = digest.low64;
    std::memcpy(file.data(), &header, sizeof header);
    Bytes head(file.begin(), file.begin() + 56);
    const auto table = part(file, sizeof header, entries * sizeof(SetkaFileSection));
    head.insert(head.end(), table.begin(), table.end());
    header.checksum = hash(head);
    std::memcpy(file.data(), &header, sizeof header);
}

}  // namespace fuzz
