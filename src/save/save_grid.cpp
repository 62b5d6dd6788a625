// SPDX-License-Identifier: MIT
/// What of a grid goes into a file, and what has to hold before it comes out again?
#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include "accel/grid_violations.hpp"
#include "backend/device.hpp"
#include "core/digest.hpp"
#include "core/file.hpp"
#include "save/section_file.hpp"
#include "setka/error.hpp"
#include "setka/save.hpp"

namespace setka {

namespace {

/// Sections in the order of the file.
enum Place : std::size_t {
    header,
    bounds,
    offsets,
    counts,
    references,
    triangles,
    instance_starts,
    instances,
    place_count
};

constexpr const char* names[place_count] = {"header",     "bounds",    "offsets",         "counts",
                                            "references", "triangles", "instance starts", "instances"};
constexpr std::size_t element_bytes[place_count] = {sizeof(::SetkaGridHeader), sizeof(Bounds), 4, 4, 4, 36, 4,
                                                    sizeof(::SetkaInstance)};

Digest digest_of(const HostTables& tables) {
    Digester digester;
    digester.add(std::as_bytes(std::span(&tables.header, 1)));
    digester.add(std::as_bytes(tables.offsets));
    digester.add(std::as_bytes(tables.counts));
    digester.add(std::as_bytes(tables.references));
    return digester.digest();
}

/// Of the instances that have triangles.
std::uint32_t common_mask_of(const HostTables& tables) {
    std::uint32_t mask = ~0u;
    const std::size_t count = std::min(tables.instances.size() + 1, tables.instance_starts.size());
    for (std::size_t i = 0; i + 1 < count; ++i)
        if (tables.instance_starts[i] != tables.instance_starts[i + 1]) mask &= tables.instances[i].mask;
    return mask;
}

/// What is wrong with the counts that WorldGeometry keeps beside its tables.
std::vector<std::string> geometry_violations(const WorldGeometry& geometry, const HostTables& tables) {
    std::vector<std::string> list;
    const auto require = [&](const char* member, std::uint32_t is, std::uint32_t should_be) {
        if (is != should_be)
            list.push_back(std::string("geometry: ") + member + " is " + std::to_string(is) +
                           "; the tables say " + std::to_string(should_be));
    };
    require("triangle_count", geometry.triangle_count, tables.header.triangle_count);
    require("instance_count", geometry.instance_count, tables.header.instance_count);
    require("common_mask", geometry.common_mask, common_mask_of(tables));
    return list;
}

/// A grid's tables inside the bytes of its file.
struct HostGrid {
    SectionWriter writer;
    HostTables tables;
};

HostGrid download(Queue& queue, const Grid& grid) {
    const WorldGeometry& geometry = grid.geometry();
    const GridTables flat = grid.tables(queue);
    const std::uint64_t sizes[place_count] = {sizeof(::SetkaGridHeader),
                                              sizeof(Bounds),
                                              flat.offsets.size_bytes(),
                                              flat.counts.size_bytes(),
                                              flat.references.size_bytes(),
                                              geometry.triangles.size_bytes(),
                                              geometry.instance_starts.size_bytes(),
                                              geometry.instances.size_bytes()};
    std::vector<Section> sections;
    for (std::size_t i = 0; i < place_count; ++i) sections.push_back({names[i], sizes[i]});
    HostGrid host{SectionWriter(SETKA_FILE_UNIFORM_GRID, sections), {}};
    const auto fetch = [&]<typename T>(Place place, const Buffer<T>& buffer) {
        const auto target = host.writer.section<T>(place);
        queue.download(buffer, target);
        return std::span<const T>(target);
    };
    host.writer.section<::SetkaGridHeader>(header)[0] = host.tables.header = grid.header();
    host.writer.section<Bounds>(bounds)[0] = host.tables.bounds = geometry.bounds;
    host.tables.offsets = fetch(offsets, flat.offsets);
    host.tables.counts = fetch(counts, flat.counts);
    host.tables.references = fetch(references, flat.references);
    host.tables.triangles = fetch(triangles, geometry.triangles);
    host.tables.instance_starts = fetch(instance_starts, geometry.instance_starts);
    host.tables.instances = fetch(instances, geometry.instances);
    return host;
}

std::vector<std::string> violations_of(const Grid& grid, const HostTables& tables) {
    auto list = violations_of(tables);
    for (std::string& text : geometry_violations(grid.geometry(), tables)) list.push_back(std::move(text));
    return list;
}

/// Bytes at an address where tables can be read in place.
class AlignedBytes {
  public:
    explicit AlignedBytes(std::span<const std::byte> bytes) : bytes_(bytes) {
        if (std::bit_cast<std::uintptr_t>(bytes.data()) % alignof(std::uint32_t) == 0) return;
        copy_.assign(bytes.begin(), bytes.end());
        bytes_ = copy_;
    }
    AlignedBytes(const AlignedBytes&) = delete;
    AlignedBytes& operator=(const AlignedBytes&) = delete;
    [[nodiscard]] std::span<const std::byte> get() const { return bytes_; }

  private:
    std::vector<std::byte> copy_;
    std::span<const std::byte> bytes_;
};

/// Whether the sections are a grid's, by number, names and sizes of their elements.
void check_names(SavedStructure& saved) {
    if (saved.sections.size() != place_count) {
        saved.violations.push_back("it has " + std::to_string(saved.sections.size()) +
                                   " sections; a uniform grid has " + std::to_string(place_count));
        return;
    }
    for (std::size_t i = 0; i < place_count; ++i) {
        const std::uint64_t size = saved.sections[i].size_bytes;
        if (saved.sections[i].name != names[i])
            saved.violations.push_back("section " + std::to_string(i) + " is '" + saved.sections[i].name +
                                       "'; that of a uniform grid is '" + names[i] + "'");
        const bool is_single = i == header || i == bounds;
        if (is_single ? size != element_bytes[i] : size % element_bytes[i] != 0)
            saved.violations.push_back(
                "section '" + saved.sections[i].name + "' has " + std::to_string(size) + " bytes; " +
                (is_single ? "" : "a multiple of ") + std::to_string(element_bytes[i]) + " is needed");
    }
}

/// Tables in place; check_names() found nothing.
HostTables tables_in(std::span<const std::byte> bytes, const SavedStructure& saved) {
    const auto view = [&]<typename T>(Place place, std::span<const T>& target) {
        const SavedSection& section = saved.sections[place];
        target = {reinterpret_cast<const T*>(bytes.data() + section.offset_bytes),
                  section.size_bytes / sizeof(T)};
    };
    HostTables tables;
    std::memcpy(&tables.header, bytes.data() + saved.sections[header].offset_bytes, sizeof tables.header);
    std::memcpy(&tables.bounds, bytes.data() + saved.sections[bounds].offset_bytes, sizeof tables.bounds);
    view(offsets, tables.offsets);
    view(counts, tables.counts);
    view(references, tables.references);
    view(triangles, tables.triangles);
    view(instance_starts, tables.instance_starts);
    view(instances, tables.instances);
    return tables;
}

/// What inspect() tells, and the tables unless there are violations.
struct Examined {
    SavedStructure saved;
    std::optional<HostTables> tables;
};

Examined examine(std::span<const std::byte> bytes) {
    SectionFile file = read_sections(bytes);
    Examined result;
    SavedStructure& saved = result.saved;
    saved.format_version = SETKA_FILE_VERSION;
    saved.size_bytes = bytes.size();
    saved.digest = {file.header.digest_high, file.header.digest_low};
    saved.sections = std::move(file.sections);
    saved.violations = std::move(file.violations);
    if (!saved.violations.empty()) return result;
    if (file.header.kind != SETKA_FILE_UNIFORM_GRID)
        throw Error(ErrorCategory::Unsupported, "it holds a structure of kind " +
                                                    std::to_string(file.header.kind) +
                                                    "; this build reads kind 1, the uniform grid");
    check_names(saved);
    if (!saved.violations.empty()) return result;
    const HostTables tables = tables_in(bytes, saved);
    saved.grid = tables.header;
    if (digest_of(tables) != saved.digest)
        saved.violations.push_back("its digest is " + digest_of(tables).to_string() + "; its header says " +
                                   saved.digest.to_string());
    else saved.violations = violations_of(tables);
    if (saved.violations.empty()) result.tables = tables;
    return result;
}

Grid upload(Queue& queue, const Examined& examined) {
    if (!examined.tables) {
        const auto& violations = examined.saved.violations;
        const std::size_t others = violations.size() - 1;
        throw Error(ErrorCategory::InvalidData,
                    violations.front() + (others > 0 ? " (and " + std::to_string(others) + " more)" : ""));
    }
    const HostTables& tables = *examined.tables;
    WorldGeometry geometry;
    geometry.bounds = tables.bounds;
    geometry.triangle_count = tables.header.triangle_count;
    geometry.instance_count = tables.header.instance_count;
    geometry.common_mask = common_mask_of(tables);
    geometry.triangles = queue.upload(tables.triangles, "world triangles");
    geometry.instance_starts = queue.upload(tables.instance_starts, "instance starts");
    geometry.instances = queue.upload(tables.instances, "instances");
    const GridTables flat{queue.upload(tables.offsets, "offsets"), queue.upload(tables.counts, "counts"),
                          queue.upload(tables.references, "references")};
    return Grid(queue, std::move(geometry), tables.header, flat);
}

/// work(bytes of the file), with the file's name in what it throws. A foreign file is refused by its first
/// bytes.
template <typename Work>
auto with_file(const std::filesystem::path& path, const Work& work) {
    detail::InputFile input(path);
    try {
        const std::size_t first = std::min<std::uint64_t>(input.size_bytes(), sizeof(::SetkaFileHeader));
        std::vector<std::byte> bytes(first);
        input.read(bytes.data(), first);
        check_beginning(bytes);
        bytes.resize(input.size_bytes());
        input.read(bytes.data() + first, bytes.size() - first);
        return work(bytes);
    } catch (const Error& error) {
        throw Error(error.category(),
                    "cannot load " + detail::in_quotes(path.string(), 1000) + ": " + error.what(),
                    error.where());
    }
}

}  // namespace

std::vector<std::string> validate(Queue& queue, const Grid& grid) {
    return violations_of(grid, download(queue, grid).tables);
}

std::vector<std::byte> serialize(Queue& queue, const Grid& grid) {
    HostGrid host = download(queue, grid);
    if (const auto violations = violations_of(grid, host.tables); !violations.empty())
        throw Error(ErrorCategory::InvalidArgument, "this grid would not load: " + violations.front());
    return std::move(host.writer).finish(digest_of(host.tables));
}

void save(Queue& queue, const Grid& grid, const std::filesystem::path& file) {
    detail::PendingStream stream(file);  // what cannot be written is refused before the work
    const std::vector<std::byte> bytes = serialize(queue, grid);
    constexpr std::size_t block = std::size_t(64) << 20;
    for (std::size_t first = 0; first < bytes.size(); first += block) {
        queue.impl().check_stop("writing to " + detail::in_quotes(file.string(), 1000));
        stream.write(bytes.data() + first, std::min(block, bytes.size() - first));
    }
    stream.finish();
}

Grid deserialize_grid(Queue& queue, std::span<const std::byte> bytes) {
    const AlignedBytes aligned(bytes);
    try {
        return upload(queue, examine(aligned.get()));
    } catch (const Error& error) {
        throw Error(error.category(), std::string("cannot load these bytes: ") + error.what(), error.where());
    }
}

Grid load_grid(Queue& queue, const std::filesystem::path& file) {
    return with_file(file, [&](std::span<const std::byte> bytes) { return upload(queue, examine(bytes)); });
}

SavedStructure inspect(std::span<const std::byte> bytes) {
    const AlignedBytes aligned(bytes);
    return examine(aligned.get()).saved;
}

SavedStructure inspect(const std::filesystem::path& file) {
    return with_file(file, [](std::span<const std::byte> bytes) { return examine(bytes).saved; });
}

}  // namespace setka
