// SPDX-License-Identifier: MIT
/// What is in a PLY file? Vertices with normals and colours, polygons, triangle strips. Read here because
/// assimp 5.2 ends with a segmentation fault on malformed headers and reads the first triangle of a strip
/// only.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/exact_math.hpp"
#include "io/file.hpp"
#include "io/ply_header.hpp"
#include "io/readers.hpp"
#include "io/text.hpp"

namespace setka::io::detail {

namespace {

/// Reads one number after the other, whatever the format.
class PlyNumbers {
  public:
    PlyNumbers(const std::filesystem::path& file, const PlyHeader& header, std::string_view bytes)
        : file_(file), format_(header.format), data_(bytes.substr(header.size_bytes)), text_(data_) {}

    void enter(const PlyElement& element) { element_ = &element; }

    [[nodiscard]] double real(PlyType type) {
        if (format_ != PlyFormat::Ascii) return binary(type);
        const std::string_view word = text_.word();
        if (word.empty()) truncated();
        const std::optional<float> value = parse_float(word);
        if (!value)
            fail_read(file_, in_quotes(word, 40) + " where element '" + element_name() + "' needs a number");
        return *value;
    }

    [[nodiscard]] std::int64_t integer(PlyType type) {
        if (format_ == PlyFormat::Ascii && type != PlyType::Float32 && type != PlyType::Float64) {
            const std::string_view word = text_.word();
            if (word.empty()) truncated();
            const std::optional<std::int64_t> value = parse_integer(word);
            if (!value)
                fail_read(file_,
                          in_quotes(word, 40) + " where element '" + element_name() + "' needs an integer");
            return *value;
        }
        const double value = real(type);
        if (!(std::abs(value) < 9e15) || value != std::floor(value))
            fail_read(file_, "a number in element '" + element_name() + "' that must be an integer is none");
        return static_cast<std::int64_t>(value);
    }

    /// The length of a list whose items follow; never more than what is left of the file.
    [[nodiscard]] std::uint64_t list_length(const PlyProperty& list) {
        const std::int64_t count = integer(*list.count_type);
        const std::size_t left = format_ == PlyFormat::Ascii ? text_.rest().size() : data_.size() - at_;
        const std::size_t item = format_ == PlyFormat::Ascii ? 2 : size_of(list.type);
        if (count < 0 || static_cast<std::uint64_t>(count) > (left + 1) / item)
            fail_read(file_, "a list of " + std::to_string(count) + " numbers in element '" + element_name() +
                                 "', but only " + std::to_string(left) +
                                 " bytes follow: the file is truncated or malformed");
        return static_cast<std::uint64_t>(count);
    }

    void skip(const PlyProperty& property) {
        std::uint64_t count = property.count_type ? list_length(property) : 1;
        while (count--) (void)real(property.type);
    }

  private:
    [[nodiscard]] std::string element_name() const { return one_line(element_->name, 40); }
    [[noreturn]] void truncated() const {
        fail_read(file_, "the file is truncated: it ends inside element '" + element_name() + "'");
    }

    template <typename T, typename Bits>
    [[nodiscard]] double take() {
        if (data_.size() - at_ < sizeof(T)) truncated();
        Bits bits = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            const std::size_t byte = format_ == PlyFormat::LittleEndian ? sizeof(T) - 1 - i : i;
            bits = static_cast<Bits>(static_cast<std::uint64_t>(bits) << 8 |
                                     static_cast<unsigned char>(data_[at_ + byte]));
        }
        at_ += sizeof(T);
        return static_cast<double>(std::bit_cast<T>(bits));
    }

    [[nodiscard]] double binary(PlyType type) {
        switch (type) {
            case PlyType::Int8:
                return take<std::int8_t, std::uint8_t>();
            case PlyType::Uint8:
                return take<std::uint8_t, std::uint8_t>();
            case PlyType::Int16:
                return take<std::int16_t, std::uint16_t>();
            case PlyType::Uint16:
                return take<std::uint16_t, std::uint16_t>();
            case PlyType::Int32:
                return take<std::int32_t, std::uint32_t>();
            case PlyType::Uint32:
                return take<std::uint32_t, std::uint32_t>();
            case PlyType::Float32:
                return take<float, std::uint32_t>();
            case PlyType::Float64:
                return take<double, std::uint64_t>();
        }
        return 0;
    }

    const std::filesystem::path& file_;
    PlyFormat format_;
    std::string_view data_;
    TextCursor text_;
    std::size_t at_ = 0;
    const PlyElement* element_ = nullptr;
};

/// A channel of a colour, from 0 to 1: floats are linear, integers sRGB, of 8 bits if they are not of 16.
float linear_channel(double value, PlyType type) {
    const bool is_linear = type == PlyType::Float32 || type == PlyType::Float64;
    if (!is_linear) value /= type == PlyType::Uint16 ? 65535 : 255;
    value = value > 0 ? std::min(value, 1.0) : 0;
    if (!is_linear) value = exact::srgb_to_linear(std::floor(value * 255 + 0.5) / 255);
    return static_cast<float>(value);
}

void read_vertices(const std::filesystem::path& file, const PlyElement& element, PlyNumbers& numbers,
                   RawMesh& mesh) {
    const int places[] = {element.find({"x"}),
                          element.find({"y"}),
                          element.find({"z"}),
                          element.find({"nx"}),
                          element.find({"ny"}),
                          element.find({"nz"}),
                          element.find({"red", "r", "diffuse_red"}),
                          element.find({"green", "g", "diffuse_green"}),
                          element.find({"blue", "b", "diffuse_blue"})};
    const bool has_normals = places[3] >= 0 && places[4] >= 0 && places[5] >= 0;
    const bool has_colours = places[6] >= 0 && places[7] >= 0 && places[8] >= 0;
    if (places[0] < 0 || places[1] < 0 || places[2] < 0) fail_read(file, "its vertices have no x, y and z");
    std::vector<int> role(element.properties.size(), -1);
    for (int i = 0; i < 9; ++i)
        if (places[i] >= 0) role[static_cast<std::size_t>(places[i])] = i;
    for (std::size_t i = 0; i < role.size(); ++i)
        if (role[i] >= 0 && element.properties[i].count_type)
            fail_read(file,
                      "vertex property " + in_quotes(element.properties[i].name, 40) + " must not be a list");

    mesh.positions.resize(element.count);
    if (has_normals) mesh.normals.resize(element.count);
    if (has_colours) mesh.colors.resize(element.count);
    std::array<float, 9> values{};
    for (std::uint64_t v = 0; v < element.count; ++v) {
        for (std::size_t i = 0; i < role.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (role[i] < 0) {
                numbers.skip(property);
            } else {
                const double value = numbers.real(property.type);
                values[static_cast<std::size_t>(role[i])] =
                    role[i] < 6 ? static_cast<float>(value) : linear_channel(value, property.type);
            }
        }
        mesh.positions[v] = {values[0], values[1], values[2]};
        if (has_normals) mesh.normals[v] = {values[3], values[4], values[5]};
        if (has_colours) mesh.colors[v] = {values[6], values[7], values[8]};
    }
}

std::uint32_t vertex_index(const std::filesystem::path& file, std::int64_t index) {
    if (index < 0 || index > 0xfffffffeLL)
        fail_read(file, "vertex index " + std::to_string(index) + " of a face is out of range");
    return static_cast<std::uint32_t>(index);
}

/// A strip (a, b, c, d, …) is the triangles (a, b, c), (c, b, d), …; −1 starts a new one.
void read_strip(const std::filesystem::path& file, PlyNumbers& numbers, const PlyProperty& list,
                RawMesh& mesh) {
    std::array<std::uint32_t, 2> last{};
    std::uint64_t length = 0;
    for (std::uint64_t count = numbers.list_length(list); count; --count) {
        const std::int64_t index = numbers.integer(list.type);
        if (index == -1) {
            length = 0;
            continue;
        }
        const std::uint32_t vertex = vertex_index(file, index);
        if (++length > 2) {
            const bool flipped = length % 2 == 0;
            mesh.corners.insert(mesh.corners.end(), {last[flipped], last[!flipped], vertex});
            mesh.end_face();
        }
        last = {last[1], vertex};
    }
}

void read_faces(const std::filesystem::path& file, const PlyElement& element, PlyNumbers& numbers,
                RawMesh& mesh) {
    const int place = element.find({"vertex_indices", "vertex_index"});
    if (place < 0 || !element.properties[static_cast<std::size_t>(place)].count_type)
        fail_read(file, "its element '" + element.name + "' has no list named vertex_indices");
    for (std::uint64_t row = 0; row < element.count; ++row) {
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (static_cast<int>(i) != place) {
                numbers.skip(property);
            } else if (element.name == "tristrips") {
                read_strip(file, numbers, property, mesh);
            } else {
                for (std::uint64_t count = numbers.list_length(property); count; --count)
                    mesh.corners.push_back(vertex_index(file, numbers.integer(property.type)));
                mesh.end_face();
            }
        }
    }
}

}  // namespace

std::vector<RawMesh> read_ply(const std::filesystem::path& file, std::string_view bytes) {
    const PlyHeader header = read_ply_header(file, bytes);
    PlyNumbers numbers(file, header, bytes);
    RawMesh mesh;
    bool has_vertices = false, has_faces = false;
    for (const PlyElement& element : header.elements) {
        has_vertices |= element.name == "vertex";
        has_faces |= element.name == "face" || element.name == "tristrips";
    }
    if (!has_vertices || !has_faces)
        fail_read(
            file,
            "it has no triangle: the PLY header has no element 'vertex', or none of 'face' and 'tristrips'");
    for (const PlyElement& element : header.elements) {
        numbers.enter(element);
        if (element.name == "vertex") {
            if (!mesh.positions.empty()) fail_read(file, "the PLY header has two elements 'vertex'");
            read_vertices(file, element, numbers, mesh);
        } else if (element.name == "face" || element.name == "tristrips") {
            read_faces(file, element, numbers, mesh);
        } else if (!element.properties
                        .empty()) {  // a row of nothing takes no space, so its count proves nothing
            for (std::uint64_t row = 0; row < element.count; ++row)
                for (const PlyProperty& property : element.properties) numbers.skip(property);
        }
    }
    std::vector<RawMesh> meshes;
    meshes.push_back(std::move(mesh));
    return meshes;
}

}  // namespace setka::io::detail
