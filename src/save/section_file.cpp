// SPDX-License-Identifier: MIT
/// How do named sections become the bytes of a file, and which bytes are such a file? See the header.
#include "save/section_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/digest.hpp"
#include "setka/error.hpp"
#include "setka/version.hpp"

namespace setka {

static_assert(std::endian::native == std::endian::little, "files are written as they lie in memory");
static_assert(sizeof(::SetkaFileHeader) == 64 && sizeof(::SetkaFileSection) == 64);

namespace {

constexpr std::size_t magic_bytes = sizeof(::SetkaFileHeader::magic);
constexpr std::size_t prefix_bytes = magic_bytes + sizeof(::SetkaFileHeader::version);

std::uint64_t aligned(std::uint64_t offset) {
    return (offset + SETKA_FILE_ALIGNMENT - 1) / SETKA_FILE_ALIGNMENT * SETKA_FILE_ALIGNMENT;
}

std::uint64_t table_end(std::uint64_t sections) {
    return sizeof(::SetkaFileHeader) + sections * sizeof(::SetkaFileSection);
}

/// Of the header before its checksum and of the table.
std::uint64_t head_checksum(std::span<const std::byte> bytes, std::uint64_t sections) {
    return checksum({bytes.first(offsetof(::SetkaFileHeader, checksum)),
                     bytes.subspan(sizeof(::SetkaFileHeader), sections * sizeof(::SetkaFileSection))});
}

/// ASCII letters, digits and blanks, then zeros; else nothing.
std::string name_of(const ::SetkaFileSection& entry) {
    const auto* end = std::find(std::begin(entry.name), std::end(entry.name), 0);
    const auto is_word = [](std::uint8_t c) {
        return c == ' ' || (c >= '0' && c <= '9') || ((c | 32) >= 'a' && (c | 32) <= 'z');
    };
    const bool is_name = end != std::end(entry.name) && std::all_of(std::begin(entry.name), end, is_word) &&
                         std::all_of(end, std::end(entry.name), [](std::uint8_t c) { return c == 0; });
    return is_name ? std::string(std::begin(entry.name), end) : std::string();
}

std::string in_bytes(std::uint64_t size) { return std::to_string(size) + " bytes"; }

/// Is the whole file here, with its head undamaged?
void check_head(std::span<const std::byte> bytes, SectionFile& file) {
    const std::uint64_t size = bytes.size();
    if (size < sizeof(file.header)) {
        file.violations.push_back("it is truncated: " + in_bytes(size) + " are no whole header");
        return;
    }
    std::memcpy(&file.header, bytes.data(), sizeof(file.header));
    const ::SetkaFileHeader& header = file.header;
    const std::uint64_t end = table_end(header.section_count);
    if (end > size)
        file.violations.push_back("it is truncated or its header is damaged: it has " + in_bytes(size) +
                                  ", a table of " + std::to_string(header.section_count) +
                                  " sections ends at " + std::to_string(end));
    else if (head_checksum(bytes, header.section_count) != header.checksum)
        file.violations.push_back(
            "its header or its table of sections is damaged: their checksum does not hold");
    else if (size < header.size_bytes)
        file.violations.push_back("it is truncated: it has " + in_bytes(size) + " of " +
                                  std::to_string(header.size_bytes));
    else if (size > header.size_bytes)
        file.violations.push_back("it has " + in_bytes(size) + " where its header says " +
                                  std::to_string(header.size_bytes) + ": something was added");
    else if (header.reserved != 0 || header.reserved_too != 0)
        file.violations.push_back("its header's reserved fields are not 0");
}

/// Sections lie one behind the other, from the table's end to the file's: none can overlap or reach outside.
void read_table(std::span<const std::byte> bytes, SectionFile& file) {
    std::uint64_t end = table_end(file.header.section_count);
    for (std::uint32_t i = 0; i < file.header.section_count; ++i) {
        ::SetkaFileSection entry;
        std::memcpy(&entry, bytes.data() + table_end(i), sizeof entry);
        const SavedSection section{name_of(entry), entry.offset, entry.size_bytes, entry.checksum};
        const std::uint64_t start = aligned(end);
        std::string wrong;
        if (section.name.empty()) wrong = "has no name of letters, digits and blanks";
        else if (entry.reserved != 0) wrong = "has a reserved field that is not 0";
        else if (entry.offset != start)
            wrong = "lies at byte " + std::to_string(entry.offset) + "; what precedes it asks for " +
                    std::to_string(start);
        else if (start > bytes.size() || entry.size_bytes > bytes.size() - start)
            wrong = "has " + in_bytes(entry.size_bytes) + " from byte " + std::to_string(start) +
                    ", beyond the file's " + in_bytes(bytes.size());
        if (!wrong.empty()) {
            file.violations.push_back("section " + std::to_string(i) + " '" + section.name + "' " + wrong);
            return;
        }
        end = start + entry.size_bytes;
        file.sections.push_back(section);
    }
    if (end != bytes.size())
        file.violations.push_back("its sections end at byte " + std::to_string(end) + " of " +
                                  std::to_string(bytes.size()));
}

/// Every byte that is not in the head is under a section's checksum or has to be 0.
void check_contents(std::span<const std::byte> bytes, SectionFile& file) {
    std::uint64_t end = table_end(file.header.section_count);
    for (const SavedSection& section : file.sections) {
        const auto padding = bytes.subspan(end, section.offset_bytes - end);
        if (!std::ranges::all_of(padding, [](std::byte b) { return b == std::byte{0}; }))
            file.violations.push_back("the padding before section '" + section.name +
                                      "' is damaged: it is not 0");
        if (checksum({bytes.subspan(section.offset_bytes, section.size_bytes)}) != section.checksum)
            file.violations.push_back("section '" + section.name +
                                      "' is damaged: its checksum does not hold");
        end = section.offset_bytes + section.size_bytes;
    }
}

}  // namespace

SectionWriter::SectionWriter(std::uint32_t kind, std::span<const Section> sections) : kind_(kind) {
    std::uint64_t end = table_end(sections.size());
    for (const Section& section : sections) {
        places_.push_back({section.name, aligned(end), section.size_bytes, 0});
        end = aligned(end) + section.size_bytes;
    }
    bytes_.resize(end);
}

std::vector<std::byte> SectionWriter::finish(const Digest& digest) && {
    std::byte* entry_at = bytes_.data() + sizeof(::SetkaFileHeader);
    for (const SavedSection& place : places_) {
        ::SetkaFileSection entry{};
        std::memcpy(entry.name, place.name.data(), std::min(place.name.size(), sizeof(entry.name) - 1));
        entry.offset = place.offset_bytes;
        entry.size_bytes = place.size_bytes;
        entry.checksum = checksum({std::span(bytes_).subspan(place.offset_bytes, place.size_bytes)});
        std::memcpy(entry_at, &entry, sizeof entry);
        entry_at += sizeof entry;
    }
    ::SetkaFileHeader header{};
    std::memcpy(header.magic, SETKA_FILE_MAGIC, magic_bytes);
    header.version = SETKA_FILE_VERSION;
    header.kind = kind_;
    header.size_bytes = bytes_.size();
    header.section_count = static_cast<std::uint32_t>(places_.size());
    header.digest_high = digest.high;
    header.digest_low = digest.low;
    std::memcpy(bytes_.data(), &header, sizeof header);
    header.checksum = head_checksum(bytes_, places_.size());
    std::memcpy(bytes_.data(), &header, sizeof header);
    return std::move(bytes_);
}

void check_beginning(std::span<const std::byte> bytes) {
    if (bytes.empty() ||
        std::memcmp(bytes.data(), SETKA_FILE_MAGIC, std::min(bytes.size(), magic_bytes)) != 0)
        throw Error(ErrorCategory::InvalidData,
                    "it is not a file that setka saved: it does not begin with SETKA");
    if (bytes.size() < prefix_bytes) return;  // truncated
    std::uint32_t format = 0;
    std::memcpy(&format, bytes.data() + magic_bytes, sizeof format);
    if (format != SETKA_FILE_VERSION)
        throw Error(ErrorCategory::Unsupported,
                    "it has version " + std::to_string(format) + " of the file format; setka " + version() +
                        " reads version " + std::to_string(SETKA_FILE_VERSION) +
                        (format > SETKA_FILE_VERSION ? ": a newer setka is needed" : ""));
}

SectionFile read_sections(std::span<const std::byte> bytes) {
    check_beginning(bytes);
    SectionFile file;
    check_head(bytes, file);
    if (file.violations.empty()) read_table(bytes, file);
    if (file.violations.empty()) check_contents(bytes, file);
    else file.sections.clear();
    return file;
}

}  // namespace setka
