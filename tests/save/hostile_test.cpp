// SPDX-License-Identifier: MIT
/// What if somebody writes a file on purpose? Right checksums over wrong tables: each invariant broken once,
/// and tables of sections that reach outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "save/file_maker.hpp"
#include "save/largest_allocation.hpp"
#include "setka/error.hpp"
#include "setka/save.hpp"

namespace {

using namespace save_test;
using ::testing::HasSubstr;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::uint64_t huge = ~std::uint64_t{0};

std::vector<std::string> violations(const Bytes& file) {
    try {
        return setka::inspect(file).violations;
    } catch (const setka::Error& error) {
        return {error.what()};
    }
}

/// Refused in these words, without an allocation that the file's size does not justify.
void expect_refused(const Bytes& file, const std::string& words) {
    reset_largest_allocation();
    const auto found = violations(file);
    const std::size_t largest = largest_allocation();
    EXPECT_THAT(found, ::testing::Contains(HasSubstr(words)));
    EXPECT_GT(largest, 0u);
    EXPECT_LE(largest, 4 * file.size() + 4096);
}

struct Spoiled {
    std::string name;
    std::function<void(Model&)> spoil;
    std::string words;
};
void PrintTo(const Spoiled& spoiled, std::ostream* out) { *out << spoiled.name; }

class HostileTables : public ::testing::TestWithParam<Spoiled> {};

TEST_P(HostileTables, AreRefusedByTheInvariant) {
    Model model = model_of(small_scene());
    ASSERT_TRUE(violations(file_of(model)).empty());
    ASSERT_GT(model.counts.size(), 8u);
    GetParam().spoil(model);
    expect_refused(file_of(model), GetParam().words);
}

/// The first cell with at least this many references.
std::size_t cell_with(const Model& model, std::uint32_t count) {
    std::size_t cell = 0;
    while (model.counts.at(cell) < count) ++cell;
    return cell;
}
std::size_t empty_cell(const Model& model) {
    std::size_t cell = 0;
    while (model.counts.at(cell) != 0) ++cell;
    return cell;
}

const std::vector<Spoiled> spoiled_tables{
    {"origin_nan", [](Model& m) { m.header.origin[1] = std::nanf(""); }, "origin[1] is nan"},
    {"origin_infinite", [](Model& m) { m.header.origin[0] = INFINITY; }, "origin[0] is inf"},
    {"origin_moved", [](Model& m) { m.header.origin[2] -= 1; }, "origin[2] is -1; bounds.lower is 0"},
    {"cell_size_0", [](Model& m) { m.header.cell_size = 0; }, "header: cell_size is 0"},
    {"cell_size_negative", [](Model& m) { scale_cells(m, -1); }, "header: cell_size is -"},
    {"cell_size_nan", [](Model& m) { m.header.cell_size = m.header.inverse_cell_size = std::nanf(""); },
     "header: cell_size is nan"},
    {"cell_size_tiny", [](Model& m) { scale_cells(m, 0x1p-90f); }, "header: cell_size is "},
    {"cell_size_huge", [](Model& m) { scale_cells(m, 1e25f); }, "header: cell_size is "},
    {"cells_too_small", [](Model& m) { scale_cells(m, 0.5f); }, "do not just cover"},
    {"cells_too_large", [](Model& m) { scale_cells(m, 4); }, "do not just cover"},
    {"inverse", [](Model& m) { m.header.inverse_cell_size *= 1.0000002f; }, "inverse_cell_size"},
    {"inverse_infinite", [](Model& m) { m.header.inverse_cell_size = infinity; }, "inverse_cell_size is inf"},
    {"tolerance", [](Model& m) { m.header.tolerance *= 2; }, "tolerance"},
    {"tolerance_nan", [](Model& m) { m.header.tolerance = std::nanf(""); }, "tolerance is nan"},
    {"dims_0",
     [](Model& m) {
         m.header.dims[0] = 0;
         m.header.cell_count = 0;
     },
     "dims[0] is 0; 1 to 4096"},
    {"dims_above", [](Model& m) { m.header.dims[1] = 4097; }, "dims[1] is 4097"},
    {"dims_overflow",
     [](Model& m) {
         for (auto& dim : m.header.dims) dim = 0x80000000u;
         m.header.cell_count = 0;
     },
     "dims[0] is"},
    {"cells_wrap",
     [](Model& m) {
         for (auto& dim : m.header.dims) dim = 4096;
         m.header.cell_count = 0;
     },
     "product of dims is 68719476736"},
    {"dims_swapped", [](Model& m) { std::swap(m.header.dims[0], m.header.dims[1]); }, "do not just cover"},
    {"cell_count_above",
     [](Model& m) {
         for (auto& dim : m.header.dims) dim = 2048;
         m.header.dims[2] = 512;
         m.header.cell_count = 0x80000000u;
     },
     "cell_count is 2147483648"},
    {"counts_short", [](Model& m) { m.counts.pop_back(); }, "counts has"},
    {"instances_short", [](Model& m) { m.instances.pop_back(); }, "instances has 1 elements"},
    {"cell_count", [](Model& m) { ++m.header.cell_count; }, "cell_count"},
    {"cells_without_tables",
     [](Model& m) {
         for (auto& dim : m.header.dims) dim = 1024;
         m.header.cell_count = 1u << 30;
         m.header.tolerance = 0x1p-7f;
     },
     "offsets has"},
    {"reference_count", [](Model& m) { m.header.reference_count = 0x7fffffff; }, "references has"},
    {"reference_count_above", [](Model& m) { m.header.reference_count = 0x80000000u; },
     "reference_count is 2147483648"},
    {"triangle_count_0",
     [](Model& m) {
         m.header.triangle_count = 0;
         m.triangles.clear();
     },
     "triangle_count is 0"},
    {"triangle_count_above", [](Model& m) { m.header.triangle_count = 1u << 29; },
     "triangle_count is 536870912"},
    {"triangle_count", [](Model& m) { ++m.header.triangle_count; }, "triangles has"},
    {"instance_count_0", [](Model& m) { m.header.instance_count = 0; }, "instance_count is 0"},
    {"instance_count", [](Model& m) { m.header.instance_count = 3; }, "instance starts has 3 elements"},
    {"instance_count_above", [](Model& m) { m.header.instance_count = 0xffffffffu; },
     "instance_count is 4294967295"},
    {"extent", [](Model& m) { m.header.extent += 1; }, "extent is"},
    {"extent_negative", [](Model& m) { m.header.extent = -1; }, "extent is -1"},
    {"extent_nan", [](Model& m) { m.header.extent = std::nanf(""); }, "extent is nan"},
    {"reserved", [](Model& m) { m.header.reserved[1] = 1; }, "reserved"},
    {"lower",
     [](Model& m) {
         m.bounds.lower[0] -= 1;
         m.header.origin[0] -= 1;
     },
     "lower[0] is -1; the triangles' smallest is 0"},
    {"upper", [](Model& m) { m.bounds.upper[2] = infinity; }, "upper[2] is inf"},
    {"lower_negative_zero", [](Model& m) { m.bounds.lower[0] = -0.0f; }, "lower[0] is -0"},
    {"triangle_nan", [](Model& m) { m.triangles[13] = std::nanf(""); },
     "triangle 1 has a coordinate that is not finite: nan"},
    {"triangle_infinite", [](Model& m) { m.triangles[35] = -infinity; },
     "triangle 3 has a coordinate that is not finite"},
    {"triangle_negative_zero", [](Model& m) { m.triangles[1] = -0.0f; },
     "triangle 0 has a coordinate that is -0"},
    {"triangle_outside", [](Model& m) { m.triangles[0] = 1000; }, "the triangles' largest is 1000"},
    {"scene_too_large",
     [](Model& m) {
         m.triangles[0] = m.bounds.upper[0] = 3e38f;
         m.header.extent = 3e38f;
     },
     "e+20 are accepted"},
    {"starts_from_1", [](Model& m) { m.instance_starts[0] = 1; }, "the first is 1"},
    {"starts_beyond", [](Model& m) { m.instance_starts[2] = 5; }, "the last is 5"},
    {"starts_descending", [](Model& m) { m.instance_starts[1] = 5; }, "4 follows 5"},
    {"first_triangle", [](Model& m) { m.instances[1].first_triangle = 3; },
     "instance 1: first_triangle is 3; its start is 2"},
    {"matrix", [](Model& m) { m.instances[1].matrix[7] = infinity; }, "instance 1: its matrix"},
    {"empty_with_offset", [](Model& m) { m.offsets[empty_cell(m)] = 0; }, "an empty cell has -1 and 0"},
    {"empty_with_count", [](Model& m) { m.counts[empty_cell(m)] = 1; }, "an empty cell has -1 and 0"},
    {"full_without_offset", [](Model& m) { m.offsets[cell_with(m, 1)] = -1; }, "an empty cell has -1 and 0"},
    {"offset_negative", [](Model& m) { m.offsets[cell_with(m, 1)] = -2; }, "has offset -2"},
    {"offset_least", [](Model& m) { m.offsets[cell_with(m, 1)] = std::numeric_limits<std::int32_t>::min(); },
     "has offset -2147483648"},
    {"offset_shifted", [](Model& m) { ++m.offsets[cell_with(m, 2)]; }, "the lists before it end at"},
    {"offset_beyond", [](Model& m) { m.offsets[cell_with(m, 1)] = 0x7fffffff; }, "beyond the"},
    {"count_beyond", [](Model& m) { m.counts[cell_with(m, 1)] = 0xffffffffu; }, "beyond the"},
    {"count_short", [](Model& m) { --m.counts[cell_with(m, 2)]; }, "counts add up to"},
    {"references_left_over",
     [](Model& m) {
         m.references.push_back(0);
         ++m.header.reference_count;
     },
     "counts add up to"},
    {"reference_beyond", [](Model& m) { m.references.back() = 4; }, "is triangle 4; there are 4"},
    {"reference_huge", [](Model& m) { m.references.front() = 0xffffffffu; },
     "reference 0 is triangle 4294967295"},
    {"list_repeats",
     [](Model& m) {
         const int at = m.offsets[cell_with(m, 2)];
         m.references[std::size_t(at) + 1] = m.references[std::size_t(at)];
     },
     "lists have to ascend"},
    {"list_descends",
     [](Model& m) {
         const int at = m.offsets[cell_with(m, 2)];
         std::swap(m.references[std::size_t(at) + 1], m.references[std::size_t(at)]);
     },
     "lists have to ascend"},
};
INSTANTIATE_TEST_SUITE_P(Invariants, HostileTables, ::testing::ValuesIn(spoiled_tables),
                         [](const auto& test) { return test.param.name; });

struct SpoiledFile {
    std::string name;
    std::function<void(Bytes&)> spoil;
    std::string words;
};
void PrintTo(const SpoiledFile& spoiled, std::ostream* out) { *out << spoiled.name; }

class HostileSections : public ::testing::TestWithParam<SpoiledFile> {};

TEST_P(HostileSections, AreRefused) {
    Bytes file = file_of(model_of(small_scene()));
    GetParam().spoil(file);
    seal_head(file);
    expect_refused(file, GetParam().words);
}

auto in_header(std::function<void(SetkaFileHeader&)> change) {
    return [change](Bytes& file) {
        SetkaFileHeader header = header_of(file);
        change(header);
        set_header(file, header);
    };
}
auto in_section(std::size_t index, std::function<void(SetkaFileSection&)> change) {
    return [index, change](Bytes& file) {
        SetkaFileSection section = section_of(file, index);
        change(section);
        set_section(file, index, section);
    };
}

const std::vector<SpoiledFile> spoiled_files{
    {"no_sections", in_header([](auto& h) { h.section_count = 0; }), "sections end at byte 64"},
    {"nothing_but_a_header",
     [](Bytes& file) {
         file.resize(64);
         in_header([](auto& h) {
             h.section_count = 0;
             h.size_bytes = 64;
         })(file);
     },
     "it has 0 sections; a uniform grid has 8"},
    {"fewer_sections", in_header([](auto& h) { h.section_count = 7; }), "asks for 512"},
    {"more_sections", in_header([](auto& h) { h.section_count = 9; }), "section 0"},
    {"many_sections", in_header([](auto& h) { h.section_count = 0xffffffffu; }),
     "table of 4294967295 sections"},
    {"size_larger", in_header([](auto& h) { h.size_bytes += 1; }), "truncated"},
    {"size_huge", in_header([](auto& h) { h.size_bytes = huge; }), "truncated"},
    {"size_smaller", in_header([](auto& h) { h.size_bytes -= 1; }), "something was added"},
    {"reserved", in_header([](auto& h) { h.reserved = 1; }), "reserved"},
    {"reserved_too", in_header([](auto& h) { h.reserved_too = 1; }), "reserved"},
    {"digest", in_header([](auto& h) { h.digest_low ^= 1; }), "its digest is"},
    {"overlap", in_section(3, [](auto& s) { s.offset -= 64; }), "section 3 'counts' lies at byte"},
    {"gap", in_section(3, [](auto& s) { s.offset += 64; }), "section 3 'counts' lies at byte"},
    {"unaligned", in_section(3, [](auto& s) { s.offset += 4; }), "section 3 'counts' lies at byte"},
    {"before_the_file", in_section(3, [](auto& s) { s.offset = 0; }), "section 3 'counts' lies at byte 0"},
    {"beyond_the_file", in_section(3, [](auto& s) { s.offset = huge - 63; }),
     "section 3 'counts' lies at byte"},
    {"last_too_large", in_section(7, [](auto& s) { s.size_bytes += 1; }), "beyond the file's"},
    {"first_huge", in_section(0, [](auto& s) { s.size_bytes = huge; }), "beyond the file's"},
    {"size_wraps", in_section(4, [](auto& s) { s.size_bytes = huge - s.offset + 1 + 576; }),
     "beyond the file's"},
    {"size_wraps_to_0", in_section(4, [](auto& s) { s.size_bytes = huge - s.offset + 1; }),
     "beyond the file's"},
    {"last_too_small", in_section(7, [](auto& s) { s.size_bytes -= 1; }), "sections end at byte"},
    {"checksum", in_section(2, [](auto& s) { s.checksum ^= 1; }), "section 'offsets' is damaged"},
    {"section_reserved", in_section(2, [](auto& s) { s.reserved = 1; }), "reserved"},
    {"name_other", in_section(2, [](auto& s) { s.name[0] = 'O'; }), "section 2 is 'Offsets'"},
    {"name_empty", in_section(2, [](auto& s) { s.name[0] = 0; }), "no name"},
    {"name_endless",
     in_section(2, [](auto& s) { std::fill(std::begin(s.name), std::end(s.name), std::uint8_t('a')); }),
     "no name"},
    {"name_with_control", in_section(2, [](auto& s) { s.name[1] = 27; }), "no name"},
    {"name_with_tail", in_section(2, [](auto& s) { s.name[30] = 'x'; }), "no name"},
    {"swapped",
     [](Bytes& file) {
         SetkaFileSection a = section_of(file, 2), b = section_of(file, 3);
         std::swap(a.name, b.name);
         set_section(file, 2, a);
         set_section(file, 3, b);
     },
     "section 2 is 'counts'"},
    {"element_cut",
     [](Bytes& file) {
         SetkaFileSection last = section_of(file, 7);
         last.size_bytes -= 4;
         file.resize(file.size() - 4);
         set_section(file, 7, last);
         SetkaFileHeader header = header_of(file);
         header.size_bytes -= 4;
         set_header(file, header);
         seal(file);
     },
     "a multiple of 72 is needed"},
    {"header_cut",
     [](Bytes& file) {
         SetkaFileSection first = section_of(file, 0);
         first.size_bytes -= 4;
         set_section(file, 0, first);
         std::fill_n(file.begin() + 576 + 60, 4, std::byte{0});
         seal(file);
     },
     "section 'header' has 60 bytes; 64 is needed"},
};
INSTANTIATE_TEST_SUITE_P(Tables, HostileSections, ::testing::ValuesIn(spoiled_files),
                         [](const auto& test) { return test.param.name; });

}  // namespace
