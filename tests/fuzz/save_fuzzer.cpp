// SPDX-License-Identifier: MIT
/// Which saved file does what it should not? Any bytes, bytes under right checksums, and sound tables with a
/// few changes: refused, or else a grid that is saved again as the same bytes and whose walks end inside its
/// tables.
#include <optional>

#include "fuzz/check.hpp"
#include "fuzz/host_device.hpp"
#include "fuzz/queries.hpp"
#include "fuzz/scene_input.hpp"
#include "fuzz/seal.hpp"
#include "save/file_maker.hpp"
#include "setka/save.hpp"
#include "support/scenes.hpp"

namespace {

using save_test::Bytes;
using save_test::Model;
using setka::ErrorCategory;

const Model& sound_model(std::uint32_t number) {
    static const Model models[] = {
        save_test::model_of(save_test::small_scene()), save_test::model_of(support::ball(40), {.density = 8}),
        save_test::model_of(support::from_triangles({{setka::Float3{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}})),
        save_test::model_of(save_test::small_scene(), {.density = 1e-6f})};
    return models[number % std::size(models)];
}

/// One changed element: any bits, a little more or less, or another element's.
template <typename T>
void change(fuzz::Input& input, std::vector<T>& table) {
    static_assert(sizeof(T) == 4);
    if (table.empty()) return;
    const auto place = [&] { return input.raw<std::uint16_t>() % table.size(); };
    T& value = table[place()];
    const std::uint8_t kind = input.byte();
    if (kind < 64) value = std::bit_cast<T>(input.raw<std::uint32_t>());
    else if (kind < 128) value = std::bit_cast<T>(std::bit_cast<std::uint32_t>(value) + kind - 96u);
    else if (kind < 192) value = table[place()];
    else value = static_cast<T>(fuzz::Floats::mixed(input) > 0 ? 1 : 0);
}

void change_words(fuzz::Input& input, void* record, std::size_t size) {
    std::vector<std::uint32_t> words(size / 4);
    std::memcpy(words.data(), record, size);
    change(input, words);
    std::memcpy(record, words.data(), size);
}

/// What follows from the triangles and the size of a cell, made right again.
void complete(Model& model) {
    for (int axis = 0; axis < 3; ++axis) {
        model.bounds.lower[axis] = std::numeric_limits<float>::infinity();
        model.bounds.upper[axis] = -std::numeric_limits<float>::infinity();
    }
    for (std::size_t i = 0; i < model.triangles.size(); ++i) {
        float& lower = model.bounds.lower[i % 3];
        float& upper = model.bounds.upper[i % 3];
        lower = std::min(lower, model.triangles[i]);
        upper = std::max(upper, model.triangles[i]);
    }
    SetkaGridHeader& header = model.header;
    header.extent = 0;
    std::uint32_t most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        header.origin[axis] = model.bounds.lower[axis];
        header.extent = std::max(header.extent, model.bounds.upper[axis] - model.bounds.lower[axis]);
        most = std::max(most, header.dims[axis]);
    }
    header.inverse_cell_size = 1.0f / header.cell_size;
    header.tolerance = static_cast<float>(most) * 0x1p-17f;
    header.cell_count = header.dims[0] * header.dims[1] * header.dims[2];
    header.reference_count = static_cast<std::uint32_t>(model.references.size());
}

/// One cell, whose list is every triangle: any size of cells that covers the bounds will do.
void flatten(Model& model) {
    model.offsets = {0};
    model.references.clear();
    for (std::uint32_t i = 0; i < model.triangles.size() / 9; ++i) model.references.push_back(i);
    model.counts = {static_cast<std::uint32_t>(model.references.size())};
    for (std::uint32_t& dim : model.header.dims) dim = 1;
    complete(model);
    model.header.cell_size = std::max(model.header.extent, 0x1p-80f);
}

void edit(fuzz::Input& input, Model& model) {
    switch (const std::uint8_t kind = input.byte(); kind % 13) {
        case 0:
            return change(input, model.offsets);
        case 1:
            return change(input, model.counts);
        case 2:
            return change(input, model.references);
        case 3:
            return change(input, model.triangles);
        case 4:
            return change(input, model.instance_starts);
        case 5:
            return change_words(input, &model.header, sizeof model.header);
        case 6:
            return change_words(input, &model.bounds, sizeof model.bounds);
        case 7:
            return change_words(input, &model.instances[kind / 13u % model.instances.size()],
                                sizeof(SetkaInstance));
        case 8:
            model.header.cell_size = fuzz::Floats::mixed(input);
            return;
        case 9: {
            const float factor = fuzz::Floats::mixed(input);
            for (float& value : model.triangles) value = value * factor + 0.0f;
            model.header.cell_size = std::fabs(model.header.cell_size * factor);
            return;
        }
        case 10:
            return flatten(model);
        case 11:
            if (!model.references.empty()) model.references.pop_back();
            return;
        case 12:
            model.triangles[input.raw<std::uint16_t>() % model.triangles.size()] = fuzz::Floats::mixed(input);
            return;
    }
}

/// The first byte says how the rest makes a file.
Bytes read_file(fuzz::Input& input) {
    const std::uint8_t kind = input.byte();
    if (kind % 4 < 2) {
        const auto rest = std::as_bytes(input.rest());
        Bytes file(rest.begin(), rest.end());
        if (kind % 4 == 1) fuzz::seal(file);
        return file;
    }
    Model model = sound_model(kind / 8);
    for (std::uint32_t edits = input.below(8); edits > 0; --edits) edit(input, model);
    if (kind & 4) complete(model);
    Bytes file = save_test::file_of(model);
    if (kind % 4 == 3) {
        for (std::uint32_t edits = input.below(4); edits > 0; --edits)
            file[input.raw<std::uint16_t>() % std::min<std::size_t>(file.size(), 64 + 8 * 64)] ^=
                std::byte{input.byte()};
        if (input.byte() & 1) file.resize(file.size() + input.byte() - 128u % file.size());
        fuzz::seal(file);
    }
    return file;
}

void check_loaded(setka::Queue& queue, const setka::Grid& grid, const Bytes& file, fuzz::Input& input) {
    for (const std::string& violation : setka::validate(queue, grid))
        fuzz::fail("a loaded grid violates: " + violation);
    fuzz::check(setka::serialize(queue, grid) == file,
                "a loaded grid is saved as the bytes that it came from");
    fuzz::Queries queries;
    queries.rays = fuzz::read_rays(input, 12, queue.download(grid.geometry().triangles));
    queries.skip = fuzz::read_skip(input, queries.rays.size());
    if (input.byte() & 1) queries.mask = input.raw<std::uint32_t>();
    queries.max_hits = input.byte();
    fuzz::check_queries_end(queue, grid, queries);
    queries.max_hits = ~0u;
    fuzz::check_queries_end(queue, grid, queries);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Input input({data, size});
    setka::Queue& queue = fuzz::queue();
    const Bytes file = read_file(input);
    const auto refusals = {ErrorCategory::InvalidData, ErrorCategory::Unsupported};
    bool is_sound = false;
    (void)fuzz::succeeds(refusals, [&] { is_sound = setka::inspect(file).violations.empty(); });
    std::optional<setka::Grid> grid;
    bool fits = true;
    const bool loads = fuzz::succeeds(
        {ErrorCategory::InvalidData, ErrorCategory::Unsupported, ErrorCategory::OutOfMemory}, [&] {
            try {
                grid = setka::deserialize_grid(queue, file);
            } catch (const setka::Error& error) {
                fits = error.category() != ErrorCategory::OutOfMemory;
                throw;
            }
        });
    fuzz::check(loads == (is_sound && fits), "inspect and load agree");
    if (grid) check_loaded(queue, *grid, file, input);
    return 0;
}
