// SPDX-License-Identifier: MIT
/// How do rays come from NumPy and hits go back? The NPY format (NumPy Enhancement Proposal 1): a magic word,
/// a version, a Python dictionary that describes one array, then its bytes.
#include <bit>
#include <cstring>
#include <optional>

#include "io/file.hpp"
#include "io/text.hpp"
#include "setka/io.hpp"

namespace setka::io {

namespace {

using detail::fail_read;

static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 20, "rows of the arrays");
static_assert(std::endian::native == std::endian::little, "records are copied as they are");

/// What the header says of the array.
struct NpyHeader {
    std::string_view dtype;  ///< as spelled: '<f4', or a list for records
    std::string_view fortran_order;
    std::string_view shape;  ///< between its parentheses
    std::size_t data_at = 0;
};

/// The text of the value of `key` in a flat Python dictionary: a string without its quotes, a word, or a
/// bracket's inside.
std::string_view value_of(std::string_view dictionary, std::string_view key) {
    std::size_t at = dictionary.npos;
    for (const char quote : {'\'', '"'})
        if (at == dictionary.npos) at = dictionary.find(std::string(1, quote).append(key).append(1, quote));
    if (at == dictionary.npos) return {};
    at = dictionary.find(':', at);
    if (at == dictionary.npos) return {};
    at = dictionary.find_first_not_of(" \t\n", at + 1);
    if (at == dictionary.npos) return {};
    const char opening = dictionary[at];
    if (opening == '[')
        return dictionary.substr(
            at, dictionary.rfind(']') == dictionary.npos ? 0 : dictionary.rfind(']') - at + 1);
    const char closing = opening == '(' ? ')' : opening == '\'' || opening == '"' ? opening : 0;
    const std::size_t begin = closing ? at + 1 : at;
    const std::size_t end =
        closing ? dictionary.find(closing, begin) : dictionary.find_first_of(",} \t\n", begin);
    return end == dictionary.npos ? std::string_view() : dictionary.substr(begin, end - begin);
}

NpyHeader read_header(const std::filesystem::path& file, std::string_view bytes) {
    if (!bytes.starts_with("\x93NUMPY")) fail_read(file, "it does not start like a NumPy file (.npy)");
    if (bytes.size() < 12) fail_read(file, "the file is truncated: its NumPy header ends early");
    const auto byte = [&](std::size_t at) { return std::size_t(static_cast<unsigned char>(bytes[at])); };
    const std::size_t version = byte(6);
    if (version < 1 || version > 3)
        fail_read(file, "NumPy file version " + std::to_string(version) + "; versions 1, 2 and 3 are read");
    const std::size_t begin = version == 1 ? 10 : 12;
    const std::size_t length =
        version == 1 ? byte(8) | byte(9) << 8 : byte(8) | byte(9) << 8 | byte(10) << 16 | byte(11) << 24;
    if (length > bytes.size() - begin) fail_read(file, "the file is truncated: its NumPy header ends early");
    const std::string_view dictionary = bytes.substr(begin, length);
    NpyHeader header{value_of(dictionary, "descr"), value_of(dictionary, "fortran_order"),
                     value_of(dictionary, "shape"), begin + length};
    if (header.dtype.empty() || header.fortran_order.empty() || dictionary.find("shape") == dictionary.npos)
        fail_read(file, "its NumPy header is malformed: " + detail::in_quotes(dictionary, 80));
    return header;
}

/// n of the shape (n, 8).
std::optional<std::uint64_t> row_count(std::string_view shape) {
    const std::size_t comma = shape.find(',');
    if (comma == shape.npos) return std::nullopt;
    const auto number = [](std::string_view text) {
        detail::TextCursor words(text);
        const auto value = detail::parse_integer(words.word());
        return words.word().empty() ? value : std::nullopt;
    };
    std::string_view columns = shape.substr(comma + 1);
    if (const std::size_t more = columns.find(','); more != columns.npos) {
        if (columns.find_first_not_of(" \t", more + 1) != columns.npos) return std::nullopt;
        columns = columns.substr(0, more);
    }
    const auto rows = number(shape.substr(0, comma)), width = number(columns);
    if (!rows || *rows < 0 || width != 8) return std::nullopt;
    return static_cast<std::uint64_t>(*rows);
}

/// Magic, version 1.0 and the dictionary, padded so that the data starts at a multiple of 64 bytes.
void write_header(detail::PendingStream& stream, const std::string& dtype, std::size_t count) {
    std::string dictionary =
        "{'descr': " + dtype + ", 'fortran_order': False, 'shape': (" + std::to_string(count) + ",), }";
    dictionary.resize((10 + dictionary.size() + 1 + 63) / 64 * 64 - 11, ' ');
    dictionary += '\n';
    std::string start("\x93NUMPY\x01\x00", 8);
    start += static_cast<char>(dictionary.size() & 0xff);
    start += static_cast<char>(dictionary.size() >> 8);
    start += dictionary;
    stream.write(start.data(), start.size());
}

}  // namespace

std::vector<Ray> read_rays(const std::filesystem::path& file) {
    const std::string bytes = detail::read_file(file);
    const NpyHeader header = read_header(file, bytes);
    const std::string wanted =
        "; rays are little-endian float32 ('<f4') of shape (n, 8) in C order: origin, tmin, direction, tmax";
    if (header.dtype != "<f4")
        fail_read(file, "its dtype is " + detail::in_quotes(header.dtype, 60) + wanted);
    const std::optional<std::uint64_t> count = row_count(header.shape);
    if (!count) fail_read(file, "its shape is (" + detail::one_line(header.shape, 60) + ")" + wanted);
    // Fortran order of one row, or of none, has the same bytes.
    if (header.fortran_order != "False" && *count > 1) fail_read(file, "it is in Fortran order" + wanted);
    const std::size_t available = bytes.size() - header.data_at;
    if (*count > available / sizeof(Ray))
        fail_read(file, "the file is truncated: " + std::to_string(*count) +
                            " rays take 32 bytes each, but only " + std::to_string(available) +
                            " bytes follow the header");
    std::vector<Ray> rays(*count);
    if (!rays.empty()) std::memcpy(rays.data(), bytes.data() + header.data_at, rays.size() * sizeof(Ray));
    return rays;
}

void write_hits(const std::filesystem::path& file, std::span<const Hit> hits) {
    detail::PendingStream stream(file);
    write_header(stream,
                 "[('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('primitive', '<u4'), ('instance', '<u4')]",
                 hits.size());
    stream.write(hits.data(), hits.size_bytes());
    stream.finish();
}

void write_occlusion(const std::filesystem::path& file, std::span<const std::uint32_t> occluded) {
    detail::PendingStream stream(file);
    write_header(stream, "'|u1'", occluded.size());
    const std::string bytes = [&] {
        std::string values(occluded.size(), '\0');
        for (std::size_t i = 0; i < occluded.size(); ++i) values[i] = occluded[i] ? 1 : 0;
        return values;
    }();
    stream.write(bytes.data(), bytes.size());
    stream.finish();
}

void write_numbers(const std::filesystem::path& file, std::span<const std::uint32_t> numbers) {
    detail::PendingStream stream(file);
    write_header(stream, "'<u4'", numbers.size());
    stream.write(numbers.data(), numbers.size_bytes());
    stream.finish();
}

}  // namespace setka::io
