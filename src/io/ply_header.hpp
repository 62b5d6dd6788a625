// SPDX-License-Identifier: MIT
/// What does a PLY file say it holds? Its elements and their properties.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace setka::io::detail {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

[[nodiscard]] std::size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    std::optional<PlyType> count_type;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    /// The number of the property with one of these names, or -1.
    [[nodiscard]] int find(std::initializer_list<std::string_view> names) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
    std::size_t size_bytes = 0;  ///< where the data starts
};

/// Throws InvalidData for a header that is malformed, or that counts more than the rest of the file can hold.
[[nodiscard]] PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view bytes);

}  // namespace setka::io::detail
