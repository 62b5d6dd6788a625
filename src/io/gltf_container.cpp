// SPDX-License-Identifier: MIT
/// How do JSON and bytes lie in a GLB file? See the header.
#include "io/gltf_container.hpp"

#include <cstdint>

#include "io/file.hpp"

namespace setka::io::detail {

namespace {

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
    return value;
}

}  // namespace

GltfContainer open_container(const std::filesystem::path& file, const std::string& bytes) {
    if (bytes.compare(0, 4, "glTF") != 0) return {bytes, std::nullopt, false};
    if (bytes.size() < 20) fail_read(file, "the GLB header is truncated");
    if (const std::uint32_t version = little_endian(bytes, 4); version != 2)
        fail_read(file, "GLB version " + std::to_string(version) + "; version 2 is read");
    const std::uint64_t length = little_endian(bytes, 8);
    if (length > bytes.size())
        fail_read(file, "the GLB header promises " + std::to_string(length) + " bytes, but the file has " +
                            std::to_string(bytes.size()) + ": it is truncated or malformed");
    GltfContainer container;
    container.is_glb = true;
    for (std::uint64_t at = 12; at + 8 <= length;) {
        const std::uint64_t size_bytes = little_endian(bytes, at);
        const std::uint32_t kind = little_endian(bytes, at + 4);
        at += 8;
        if (size_bytes > length - at) fail_read(file, "a GLB chunk reaches past the end of the file");
        if (kind == 0x4e4f534a && container.json.empty()) container.json = bytes.substr(at, size_bytes);
        if (kind == 0x004e4942 && !container.binary) container.binary = bytes.substr(at, size_bytes);
        at += (size_bytes + 3) / 4 * 4;
    }
    if (container.json.empty()) fail_read(file, "the GLB file has no JSON chunk");
    return container;
}

std::string close_container(std::string text, const GltfContainer& container) {
    if (!container.is_glb) return text;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string glb = "glTF";
    const auto append = [&glb](std::uint64_t value) {
        for (int i = 0; i < 4; ++i) glb += static_cast<char>(value >> (8 * i) & 0xff);
    };
    std::string binary = container.binary.value_or(std::string());
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    append(2);
    append(20 + text.size() + (container.binary ? 8 + binary.size() : 0));
    append(text.size());
    append(0x4e4f534a);
    glb += text;
    if (container.binary) {
        append(binary.size());
        append(0x004e4942);
        glb += binary;
    }
    return glb;
}

}  // namespace setka::io::detail
