// SPDX-License-Identifier: MIT
/// What is the right file of a grid? See the header.
#include "save/file_maker.hpp"

#include <algorithm>
#include <cstring>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "support/scenes.hpp"

namespace save_test {

namespace {

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}
template <typename T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

std::uint64_t hash(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

struct Part {
    const char* name;
    std::span<const std::byte> bytes;
};

XXH128_hash_t digest(const Bytes& file) {
    Bytes tables;
    for (const std::size_t part : {0, 2, 3, 4}) {
        const SetkaFileSection section = section_of(file, part);
        const auto* from = file.data() + section.offset;
        tables.insert(tables.end(), from, from + section.size_bytes);
    }
    return XXH3_128bits(tables.data(), tables.size());
}

}  // namespace

Model model_of(const oracle::Scene& scene, const oracle::GridOptions& options) {
    const oracle::World world = oracle::make_world(scene);
    const oracle::Tables tables = oracle::make_tables(world, options);
    Model model{tables.header, world.bounds, tables.offsets, tables.counts, tables.references, {}, {0}, {}};
    for (const oracle::WorldTriangle& triangle : world.triangles)
        for (const oracle::Vec3& vertex : triangle.vertex)
            model.triangles.insert(model.triangles.end(), vertex.at, vertex.at + 3);
    for (const setka::Instance& placed : scene.instances) {
        SetkaInstance instance{};
        std::ranges::copy(placed.transform.rows, instance.matrix);
        instance.first_triangle = model.instance_starts.back();
        for (std::uint32_t before = 0; before < placed.mesh; ++before) {
            instance.first_index += static_cast<std::uint32_t>(scene.meshes[before].triangles.size());
            instance.first_vertex += static_cast<std::uint32_t>(scene.meshes[before].positions.size());
        }
        instance.material = placed.material;
        const bool is_opaque = scene.materials[placed.material].transparency == 0;
        instance.mask = placed.mask & ~SETKA_MASK_OPAQUE;
        if (instance.mask != 0 && is_opaque) instance.mask |= SETKA_MASK_OPAQUE;
        instance.flags = scene.meshes[placed.mesh].normals.empty() ? 0 : SETKA_INSTANCE_HAS_NORMALS;
        model.instances.push_back(instance);
        model.instance_starts.push_back(
            instance.first_triangle + static_cast<std::uint32_t>(scene.meshes[placed.mesh].triangles.size()));
    }
    return model;
}

void scale_cells(Model& model, float factor) {
    model.header.cell_size *= factor;
    model.header.inverse_cell_size = 1.0f / model.header.cell_size;
}

Bytes file_of(const Model& model) {
    const Part parts[] = {{"header", bytes_of(model.header)},
                          {"bounds", bytes_of(model.bounds)},
                          {"offsets", bytes_of(model.offsets)},
                          {"counts", bytes_of(model.counts)},
                          {"references", bytes_of(model.references)},
                          {"triangles", bytes_of(model.triangles)},
                          {"instance starts", bytes_of(model.instance_starts)},
                          {"instances", bytes_of(model.instances)}};
    Bytes file(64 + 64 * std::size(parts));
    SetkaFileHeader header{};
    std::copy_n("SETKA\r\n\x1a", 8, header.magic);
    header.version = 1;
    header.kind = 1;
    header.section_count = std::size(parts);
    for (std::size_t i = 0; i < std::size(parts); ++i) {
        file.resize((file.size() + 63) & ~std::size_t(63));
        SetkaFileSection section{};
        std::strncpy(reinterpret_cast<char*>(section.name), parts[i].name, sizeof section.name - 1);
        section.offset = file.size();
        section.size_bytes = parts[i].bytes.size();
        file.insert(file.end(), parts[i].bytes.begin(), parts[i].bytes.end());
        set_section(file, i, section);
    }
    header.size_bytes = file.size();
    set_header(file, header);
    seal(file);
    return file;
}

SetkaFileHeader header_of(const Bytes& file) {
    SetkaFileHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    return header;
}

SetkaFileSection section_of(const Bytes& file, std::size_t index) {
    SetkaFileSection section;
    std::memcpy(&section, file.data() + 64 + 64 * index, sizeof section);
    return section;
}

void set_header(Bytes& file, const SetkaFileHeader& header) { std::memcpy(file.data(), &header, 64); }

void set_section(Bytes& file, std::size_t index, const SetkaFileSection& section) {
    std::memcpy(file.data() + 64 + 64 * index, &section, 64);
}

void seal_head(Bytes& file) {
    SetkaFileHeader header = header_of(file);
    Bytes covered(file.begin(), file.begin() + 56);
    const std::size_t table = std::min<std::size_t>(64 * std::size_t(header.section_count), file.size() - 64);
    covered.insert(covered.end(), file.begin() + 64, file.begin() + 64 + static_cast<std::ptrdiff_t>(table));
    header.checksum = hash(covered);
    set_header(file, header);
}

void seal(Bytes& file) {
    SetkaFileHeader header = header_of(file);
    for (std::size_t i = 0; i < header.section_count; ++i) {
        SetkaFileSection section = section_of(file, i);
        section.checksum = hash(std::span(file).subspan(section.offset, section.size_bytes));
        set_section(file, i, section);
    }
    const XXH128_hash_t tables = digest(file);
    header.digest_high = tables.high64;
    header.digest_low = tables.low64;
    set_header(file, header);
    seal_head(file);
}

oracle::Scene small_scene() {
    using setka::Float3;
    oracle::Scene scene = support::from_triangles({{Float3{0, 0, 0}, Float3{1, 0, 0}, Float3{0, 1, 0}},
                                                   {Float3{4, 4, 4}, Float3{3, 4, 4}, Float3{4, 3, 3}}});
    scene.instances.push_back(scene.instances.front());
    scene.instances.back().transform.rows[3] = 2;
    scene.instances.back().mask = 5;
    return scene;
}

}  // namespace save_test
