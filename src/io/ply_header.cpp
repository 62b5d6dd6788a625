// SPDX-License-Identifier: MIT
/// What does a PLY file say it holds? The header, checked against the size of the file before anything is
/// allocated.
#include "io/ply_header.hpp"

#include <algorithm>

#include "io/file.hpp"
#include "io/text.hpp"

namespace setka::io::detail {

namespace {

/// More than this is no mesh but garbage.
constexpr std::size_t max_properties = 1000;

std::optional<PlyType> type_named(std::string_view name) {
    static constexpr std::pair<std::string_view, PlyType> names[] = {
        {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::Uint8},
        {"uint8", PlyType::Uint8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
        {"ushort", PlyType::Uint16},  {"uint16", PlyType::Uint16},   {"int", PlyType::Int32},
        {"int32", PlyType::Int32},    {"uint", PlyType::Uint32},     {"uint32", PlyType::Uint32},
        {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
        {"float64", PlyType::Float64}};
    for (const auto& [known, type] : names)
        if (name == known) return type;
    return std::nullopt;
}

PlyFormat read_format(const std::filesystem::path& file, TextCursor& words) {
    const std::string_view format = words.word_of_line();
    if (format == "ascii") return PlyFormat::Ascii;
    if (format == "binary_little_endian") return PlyFormat::LittleEndian;
    if (format == "binary_big_endian") return PlyFormat::BigEndian;
    fail_read(file, "PLY format " + in_quotes(format, 40) +
                        "; known are ascii, binary_little_endian and binary_big_endian");
}

PlyProperty read_property(const std::filesystem::path& file, TextCursor& words) {
    const auto type = [&](std::string_view name) {
        const std::optional<PlyType> known = type_named(name);
        if (!known)
            fail_read(file, "unknown type " + in_quotes(name, 40) + " of a property in the PLY header");
        return *known;
    };
    PlyProperty property;
    std::string_view name = words.word_of_line();
    if (name == "list") {
        property.count_type = type(words.word_of_line());
        if (*property.count_type == PlyType::Float32 || *property.count_type == PlyType::Float64)
            fail_read(file, "a list in the PLY header has a count that is not an integer");
        name = words.word_of_line();
    }
    property.type = type(name);
    property.name = words.word_of_line();
    return property;
}

/// The fewest bytes that a row of this element takes.
std::uint64_t min_row_bytes(const PlyElement& element, PlyFormat format) {
    std::uint64_t size_bytes = 0;
    for (const PlyProperty& property : element.properties)
        size_bytes += format == PlyFormat::Ascii ? 2 : size_of(property.count_type.value_or(property.type));
    return size_bytes;
}

void check_counts(const std::filesystem::path& file, const PlyHeader& header, std::uint64_t file_bytes) {
    // One more: the last number of a text needs no line end.
    std::uint64_t left = file_bytes - header.size_bytes + (header.format == PlyFormat::Ascii ? 1 : 0);
    for (const PlyElement& element : header.elements) {
        const std::uint64_t row = min_row_bytes(element, header.format);
        if (row && element.count > left / row)
            fail_read(file, "the header promises " + std::to_string(element.count) + " of element " +
                                in_quotes(element.name, 40) + ", which take at least " + std::to_string(row) +
                                " bytes each, but only " + std::to_string(left) +
                                " bytes follow: the file is truncated or malformed");
        left -= row * element.count;
    }
}

}  // namespace

std::size_t size_of(PlyType type) {
    static constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

int PlyElement::find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view wanted : names)
        for (std::size_t i = 0; i < properties.size(); ++i)
            if (properties[i].name == wanted) return static_cast<int>(i);
    return -1;
}

PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes) {
    TextCursor lines(bytes);
    if (TextCursor(lines.line()).word() != "ply")
        fail_read(file, "it does not start with 'ply', so it is no PLY file");
    PlyHeader header;
    bool format_seen = false;
    for (std::size_t properties = 0;;) {
        if (lines.at_end())
            fail_read(file, "the PLY header has no end_header line: the file is truncated or malformed");
        const std::string_view line = lines.line();
        TextCursor words(line);
        const std::string_view keyword = words.word_of_line();
        if (keyword == "end_header") break;
        if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
        if (keyword == "format") {
            header.format = read_format(file, words);
            format_seen = true;
        } else if (keyword == "element") {
            PlyElement element;
            element.name = words.word_of_line();
            const std::optional<std::int64_t> count = parse_integer(words.word_of_line());
            if (!count || *count < 0)
                fail_read(file, "a bad count in the PLY header: " + in_quotes(line, 60));
            element.count = static_cast<std::uint64_t>(*count);
            header.elements.push_back(std::move(element));
        } else if (keyword == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(read_property(file, words));
            if (++properties > max_properties) fail_read(file, "more than 1000 properties in the PLY header");
        } else {
            fail_read(file, "cannot understand " + in_quotes(line, 60) + " in the PLY header");
        }
    }
    if (!format_seen) fail_read(file, "the PLY header has no format line");
    header.size_bytes = bytes.size() - lines.rest().size();
    check_counts(file, header, bytes.size());
    return header;
}

}  // namespace setka::io::detail
