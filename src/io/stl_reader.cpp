// SPDX-License-Identifier: MIT
/// What is in an STL file? Triangles without shared vertices, in text or in records of 50 bytes. Read here
/// because the two kinds are told apart by size, which also shows a truncated file.
#include <bit>

#include "io/file.hpp"
#include "io/readers.hpp"
#include "io/text.hpp"

namespace setka::io::detail {

namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t facet_bytes = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

bool starts_with_solid(std::string_view bytes) {
    return equal_ignoring_case(TextCursor(bytes).word(), "solid");
}

/// Binary files start with 80 free bytes, "solid" now and then; so an exact size decides first.
bool is_binary(std::string_view bytes) {
    if (bytes.size() >= header_bytes &&
        bytes.size() == header_bytes + facet_bytes * std::uint64_t(little_endian(bytes, 80)))
        return true;
    // Text holds no zero bytes; a truncated or extended binary file with a text header does, in its counts or
    // floats.
    return !starts_with_solid(bytes) || bytes.find('\0') != bytes.npos;
}

RawMesh read_binary(const std::filesystem::path& file, std::string_view bytes) {
    if (bytes.size() < header_bytes)
        fail_read(file, "neither 'solid' nor " + std::to_string(header_bytes) +
                            " bytes of binary header: no STL file, or a truncated one");
    const std::uint32_t count = little_endian(bytes, 80);
    if (header_bytes + facet_bytes * std::uint64_t(count) > bytes.size())
        fail_read(file, "the header promises " + std::to_string(count) + " triangles (" +
                            std::to_string(header_bytes + facet_bytes * std::uint64_t(count)) +
                            " bytes), but the file has " + std::to_string(bytes.size()) +
                            " bytes: it is truncated or malformed");
    RawMesh mesh;
    mesh.sharing = Sharing::ByPosition;
    mesh.positions.reserve(std::size_t(count) * 3);
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t at = header_bytes + facet_bytes * i + 12 * (corner + 1);
            const auto number = [&](std::size_t axis) {
                return std::bit_cast<float>(little_endian(bytes, at + 4 * axis));
            };
            mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back({number(0), number(1), number(2)});
        }
        mesh.end_face();
    }
    return mesh;
}

class AsciiStl {
  public:
    AsciiStl(const std::filesystem::path& file, std::string_view bytes) : file_(file), text_(bytes) {}

    [[nodiscard]] std::vector<RawMesh> read() {
        std::vector<RawMesh> meshes;
        for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
            if (!equal_ignoring_case(word, "solid")) unexpected(word, "'solid'");
            meshes.push_back(read_solid());
        }
        return meshes;
    }

  private:
    [[nodiscard]] RawMesh read_solid() {
        RawMesh mesh;
        mesh.sharing = Sharing::ByPosition;
        mesh.name = one_line(text_.line());
        while (!mesh.name.empty() && mesh.name.front() == ' ') mesh.name.erase(0, 1);
        for (;;) {
            const std::string_view word = next();
            if (equal_ignoring_case(word, "endsolid")) break;
            if (!equal_ignoring_case(word, "facet")) unexpected(word, "'facet' or 'endsolid'");
            text_.line();  // the normal
            read_facet(mesh);
        }
        text_.line();  // the name again
        return mesh;
    }

    void read_facet(RawMesh& mesh) {
        expect("outer");
        expect("loop");
        for (;;) {
            const std::string_view word = next();
            if (equal_ignoring_case(word, "endloop")) break;
            if (!equal_ignoring_case(word, "vertex")) unexpected(word, "'vertex' or 'endloop'");
            const float x = number(), y = number(), z = number();
            mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back({x, y, z});
        }
        expect("endfacet");
        mesh.end_face();
    }

    [[nodiscard]] float number() {
        const std::string_view word = next();
        const std::optional<float> value = parse_float(word);
        if (!value) unexpected(word, "a coordinate");
        return *value;
    }

    [[nodiscard]] std::string_view next() {
        const std::string_view word = text_.word();
        if (word.empty())
            fail_read(file_, "the file is truncated: it ends inside a solid, without 'endsolid'");
        return word;
    }

    void expect(std::string_view keyword) {
        const std::string_view word = next();
        if (!equal_ignoring_case(word, keyword)) unexpected(word, in_quotes(keyword));
    }

    [[noreturn]] void unexpected(std::string_view word, std::string_view wanted) const {
        fail_read(file_,
                  in_quotes(word, 40) + " where " + std::string(wanted) + " should stand: malformed STL");
    }

    const std::filesystem::path& file_;
    TextCursor text_;
};

}  // namespace

std::vector<RawMesh> read_stl(const std::filesystem::path& file, std::string_view bytes) {
    if (!is_binary(bytes)) return AsciiStl(file, bytes).read();
    std::vector<RawMesh> meshes;
    meshes.push_back(read_binary(file, bytes));
    return meshes;
}

}  // namespace setka::io::detail
