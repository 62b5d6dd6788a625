// SPDX-License-Identifier: MIT
/// What is in an OFF file? Vertices and polygons in text. Read here because assimp 5.2 skips faces in files
/// that it takes for longer-lined ones, and asks for as much memory as the header says.
#include "io/file.hpp"
#include "io/readers.hpp"
#include "io/text.hpp"

namespace setka::io::detail {

namespace {

class OffReader {
  public:
    OffReader(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), bytes_(bytes), text_(bytes, '#') {}

    [[nodiscard]] RawMesh read() {
        read_keyword();
        const std::uint64_t vertex_count = count("vertices"), face_count = count("faces");
        (void)text_.word_of_line();  // edges: often wrong, never needed
        text_.line();
        // "0 0 0" and "1 0" with their line ends: the least that a vertex and a face take.
        const std::uint64_t left = text_.rest().size() + 1;
        if (vertex_count > left / 6 || face_count > (left - vertex_count * 6) / 2)
            fail_read(file_, "the header promises " + std::to_string(vertex_count) + " vertices and " +
                                 std::to_string(face_count) + " faces, but only " + std::to_string(left - 1) +
                                 " bytes follow: the file is truncated or malformed");
        RawMesh mesh;
        mesh.positions.reserve(vertex_count);
        for (std::uint64_t v = 0; v < vertex_count; ++v) {
            mesh.positions.push_back(read_vector());
            if (has_normals_) mesh.normals.push_back(read_vector());
            text_.line();  // a colour, texture coordinates
        }
        for (std::uint64_t f = 0; f < face_count; ++f) read_face(mesh);
        return mesh;
    }

  private:
    /// [ST][C][N][4][n]OFF, in that order. Some files leave no space before the first count.
    void read_keyword() {
        std::string_view word = text_.word();
        const std::size_t end = word.find("OFF");
        if (end == word.npos) fail_read(file_, "it does not start with 'OFF', so it is no OFF file");
        const std::string_view prefix = word.substr(0, end);
        if (prefix.find_first_of("4n") != prefix.npos)
            fail_read(file_,
                      "vertices of other than three dimensions (" + in_quotes(word, 20) + ") are not read");
        if (prefix.find_first_not_of("STCN") != prefix.npos)
            fail_read(file_, "it does not start with 'OFF', so it is no OFF file");
        has_normals_ = prefix.find('N') != prefix.npos;
        const auto used = static_cast<std::size_t>(word.data() + end + 3 - bytes_.data());
        text_ = TextCursor(bytes_.substr(used), '#');
        TextCursor ahead = text_;
        if (ahead.word() == "BINARY") fail_read(file_, "binary OFF is not read; ASCII OFF is");
    }

    [[nodiscard]] std::uint64_t count(const char* what) {
        const std::string_view word = text_.word();
        if (word.empty()) truncated();
        const std::optional<std::int64_t> value = parse_integer(word);
        if (!value || *value < 0)
            fail_read(file_, in_quotes(word, 40) + " where the number of " + what + " should stand");
        return static_cast<std::uint64_t>(*value);
    }

    [[nodiscard]] Float3 read_vector() {
        const auto number = [this] {
            const std::string_view word = text_.word();
            if (word.empty()) truncated();
            const std::optional<float> value = parse_float(word);
            if (!value) fail_read(file_, in_quotes(word, 40) + " where a coordinate should stand");
            return *value;
        };
        const float x = number(), y = number(), z = number();
        return {x, y, z};
    }

    void read_face(RawMesh& mesh) {
        const std::uint64_t corner_count = count("corners of a face");
        if (corner_count > text_.rest().size())
            fail_read(file_, "a face of " + std::to_string(corner_count) + " corners, but only " +
                                 std::to_string(text_.rest().size()) + " bytes follow");
        for (std::uint64_t i = 0; i < corner_count; ++i) {
            const std::uint64_t index = count("vertex indices, 0 or more,");
            if (index >= mesh.positions.size())
                fail_read(file_, "face " + std::to_string(mesh.face_ends.size()) + " uses vertex " +
                                     std::to_string(index) + ", but there are only " +
                                     std::to_string(mesh.positions.size()) + " (numbered from 0)");
            mesh.corners.push_back(static_cast<std::uint32_t>(index));
        }
        mesh.end_face();
        text_.line();  // a colour
    }

    [[noreturn]] void truncated() const {
        fail_read(file_, "the file is truncated: it ends before the last face");
    }

    const std::filesystem::path& file_;
    std::string_view bytes_;
    TextCursor text_;
    bool has_normals_ = false;
};

}  // namespace

std::vector<RawMesh> read_off(const std::filesystem::path& file, std::string_view bytes) {
    std::vector<RawMesh> meshes;
    meshes.push_back(OffReader(file, bytes).read());
    return meshes;
}

}  // namespace setka::io::detail
