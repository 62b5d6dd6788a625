// SPDX-License-Identifier: MIT
/// How are tables, hits and images compared and printed?
#include "support/compare.hpp"

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "support/rays.hpp"

namespace support {

using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;

namespace {

std::string list_of(const oracle::Tables& tables, std::size_t cell) {
    std::ostringstream out;
    out << "offset " << tables.offsets[cell] << ", count " << tables.counts[cell] << ":";
    const std::size_t shown = std::min<std::size_t>(tables.counts[cell], 40);
    for (std::size_t k = 0; k < shown; ++k) {
        const std::size_t at = static_cast<std::size_t>(tables.offsets[cell]) + k;
        if (at < tables.references.size()) out << ' ' << tables.references[at];
    }
    if (shown < tables.counts[cell]) out << " …";
    return out.str();
}

bool same_list(const oracle::Tables& a, const oracle::Tables& b, std::size_t cell) {
    if (a.offsets[cell] != b.offsets[cell] || a.counts[cell] != b.counts[cell]) return false;
    const auto begin = static_cast<std::size_t>(std::max(a.offsets[cell], 0));
    const std::size_t end = begin + a.counts[cell];
    if (end > a.references.size() || end > b.references.size()) return false;
    return std::equal(a.references.begin() + static_cast<std::ptrdiff_t>(begin),
                      a.references.begin() + static_cast<std::ptrdiff_t>(end),
                      b.references.begin() + static_cast<std::ptrdiff_t>(begin));
}

std::string describe(const SetkaGridHeader& h) {
    std::ostringstream out;
    out << std::hexfloat << "origin (" << h.origin[0] << ", " << h.origin[1] << ", " << h.origin[2]
        << "), cell_size " << h.cell_size << ", inverse " << h.inverse_cell_size << ", tolerance "
        << h.tolerance << ", extent " << h.extent << ", dims " << h.dims[0] << " x " << h.dims[1] << " x "
        << h.dims[2] << ", cells " << h.cell_count << ", references " << h.reference_count << ", triangles "
        << h.triangle_count << ", instances " << h.instance_count << ", reserved " << h.reserved[0] << ' '
        << h.reserved[1];
    return out.str();
}

std::string cell_name(const SetkaGridHeader& header, std::uint64_t cell) {
    std::ostringstream out;
    out << "cell " << cell << " (" << cell % header.dims[0] << ", " << cell / header.dims[0] % header.dims[1]
        << ", " << cell / header.dims[0] / header.dims[1] << ")";
    return out.str();
}

std::string describe(const oracle::Hit& hit) {
    std::ostringstream out;
    if (hit.primitive == SETKA_NO_HIT) out << "miss; ";
    out << std::setprecision(9) << "t " << hit.t << " (" << std::hexfloat << hit.t << "), u " << hit.u
        << ", v " << hit.v << ", primitive " << hit.primitive << ", instance " << hit.instance;
    return out.str();
}

std::string describe(const oracle::Ray& r) {
    std::ostringstream out;
    const auto list = [&] {
        out << "origin " << r.origin[0] << ' ' << r.origin[1] << ' ' << r.origin[2] << ", direction "
            << r.direction[0] << ' ' << r.direction[1] << ' ' << r.direction[2] << ", t " << r.tmin << " to "
            << r.tmax;
    };
    out << std::setprecision(9);
    list();
    out << " = " << std::hexfloat;
    list();
    return out.str();
}

std::string ray_name(std::size_t index) {
    const auto& kinds = ray_kinds();
    return "ray " + std::to_string(index) + " (" + kinds[index % kinds.size()] +
           ", if the rays are adversarial)";
}

}  // namespace

namespace {

bool same_pixel(const setka::Image& a, const setka::Image& b, std::size_t pixel) {
    return std::memcmp(&a.linear[pixel], &b.linear[pixel], sizeof(setka::Float3)) == 0 &&
           std::equal(&a.srgb[3 * pixel], &a.srgb[3 * pixel] + 3, &b.srgb[3 * pixel]);
}

std::string describe_pixel(const setka::Image& image, std::size_t pixel) {
    const setka::Float3& c = image.linear[pixel];
    std::ostringstream out;
    out << std::setprecision(9) << "linear " << c.x << ' ' << c.y << ' ' << c.z << " (" << std::hexfloat
        << c.x << ' ' << c.y << ' ' << c.z << "), sRGB";
    for (std::size_t k = 0; k < 3; ++k) out << ' ' << static_cast<unsigned>(image.srgb[3 * pixel + k]);
    return out.str();
}

}  // namespace

AssertionResult same_image(const setka::Image& expected, const setka::Image& actual) {
    const std::size_t pixels = std::size_t(expected.width) * expected.height;
    for (const setka::Image* image : {&expected, &actual})
        if (image->width != expected.width || image->height != expected.height ||
            image->linear.size() != pixels || image->srgb.size() != 3 * pixels)
            return AssertionFailure()
                   << "sizes differ: expected " << expected.width << " x " << expected.height << ", actual "
                   << actual.width << " x " << actual.height << ", with " << image->linear.size()
                   << " linear pixels and " << image->srgb.size() << " 8-bit channels";
    std::size_t count = 0, first = 0;
    for (std::size_t pixel = pixels; pixel-- > 0;)
        if (!same_pixel(expected, actual, pixel)) {
            ++count;
            first = pixel;
        }
    if (count == 0) return AssertionSuccess();
    return AssertionFailure() << count << " of " << pixels << " pixels differ; first: pixel ("
                              << first % expected.width << ", " << first / expected.width << ")\n  expected "
                              << describe_pixel(expected, first) << "\n  actual   "
                              << describe_pixel(actual, first);
}

oracle::Tables download(setka::Queue& queue, const setka::Grid& grid) {
    oracle::Tables tables;
    tables.header = grid.header();
    const setka::GridTables flat = grid.tables(queue);
    tables.offsets = queue.download(flat.offsets);
    tables.counts = queue.download(flat.counts);
    tables.references = queue.download(flat.references);
    return tables;
}

AssertionResult same_tables(const oracle::Tables& expected, const oracle::Tables& actual) {
    static_assert(sizeof(SetkaGridHeader) == 64);
    const SetkaGridHeader &a = expected.header, &b = actual.header;
    const bool same_cells = std::equal(a.dims, a.dims + 3, b.dims) &&
                            expected.counts.size() == actual.counts.size() &&
                            expected.offsets.size() == actual.offsets.size();
    if (same_cells) {
        for (std::size_t cell = 0; cell < expected.counts.size(); ++cell)
            if (!same_list(expected, actual, cell))
                return AssertionFailure()
                       << "first difference in " << cell_name(a, cell) << " of dims " << a.dims[0] << " x "
                       << a.dims[1] << " x " << a.dims[2] << "\n  expected " << list_of(expected, cell)
                       << "\n  actual   " << list_of(actual, cell);
    }
    if (std::memcmp(&a, &b, sizeof a) != 0)
        return AssertionFailure() << "headers differ\n  expected " << describe(a) << "\n  actual   "
                                  << describe(b);
    if (!same_cells) return AssertionFailure() << "tables have other sizes than their header says";
    if (expected.references != actual.references)
        return AssertionFailure() << "references differ: expected " << expected.references.size()
                                  << ", actual " << actual.references.size();
    return AssertionSuccess();
}

AssertionResult contains_all(std::span<const oracle::Pair> listed, std::span<const oracle::Pair> needed,
                             const oracle::World& world, const SetkaGridHeader& header) {
    std::vector<oracle::Pair> missing;
    std::set_difference(needed.begin(), needed.end(), listed.begin(), listed.end(),
                        std::back_inserter(missing));
    if (missing.empty()) return AssertionSuccess();
    const auto triangle = static_cast<std::uint32_t>(missing.front());
    std::ostringstream out;
    out << std::setprecision(9) << missing.size() << " of " << needed.size()
        << " overlapping pairs are not listed; first: triangle " << triangle << " in "
        << cell_name(header, missing.front() >> 32) << ", in cells";
    for (const oracle::Vec3& p : world.triangles[triangle].vertex) {
        out << " (";
        for (int axis = 0; axis < 3; ++axis)
            out << (axis ? ", " : "") << (p[axis] - header.origin[axis]) * header.inverse_cell_size;
        out << ")";
    }
    return AssertionFailure() << out.str();
}

AssertionResult same_hits(std::span<const oracle::Ray> rays, std::span<const oracle::Hit> expected,
                          std::span<const oracle::Hit> actual) {
    if (expected.size() != rays.size() || actual.size() != rays.size())
        return AssertionFailure() << rays.size() << " rays, " << expected.size() << " and " << actual.size()
                                  << " hits";
    std::size_t count = 0, first = 0;
    for (std::size_t i = rays.size(); i-- > 0;)
        if (std::memcmp(&expected[i], &actual[i], sizeof(oracle::Hit)) != 0) {
            ++count;
            first = i;
        }
    if (count == 0) return AssertionSuccess();
    return AssertionFailure() << count << " of " << rays.size() << " hits differ; first: " << ray_name(first)
                              << "\n  " << describe(rays[first]) << "\n  expected "
                              << describe(expected[first]) << "\n  actual   " << describe(actual[first]);
}

setka::HitLists as_lists(const std::vector<std::vector<oracle::Hit>>& hits, std::size_t most) {
    setka::HitLists lists;
    for (const auto& list : hits) {
        lists.hits.insert(lists.hits.end(), list.begin(),
                          list.begin() + static_cast<std::ptrdiff_t>(std::min(most, list.size())));
        lists.offsets.push_back(static_cast<std::uint32_t>(lists.hits.size()));
    }
    return lists;
}

AssertionResult same_lists(std::span<const oracle::Ray> rays, const setka::HitLists& expected,
                           const setka::HitLists& actual) {
    for (const setka::HitLists* lists : {&expected, &actual}) {
        if (lists->ray_count() != rays.size() || lists->offsets.front() != 0 ||
            lists->offsets.back() != lists->hits.size() || !std::ranges::is_sorted(lists->offsets))
            return AssertionFailure() << rays.size() << " rays; " << (lists == &actual ? "actual" : "expected")
                                      << " lists of " << lists->ray_count() << " rays, " << lists->hits.size()
                                      << " hits, offsets " << lists->offsets.front() << " to "
                                      << lists->offsets.back();
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto a = expected[i], b = actual[i];
        if (a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0)) continue;
        std::size_t k = 0;
        while (k < std::min(a.size(), b.size()) && std::memcmp(&a[k], &b[k], sizeof(oracle::Hit)) == 0) ++k;
        const auto hit_of = [&](std::span<const oracle::Hit> hits) {
            return k < hits.size() ? describe(hits[k]) : std::string("none");
        };
        return AssertionFailure() << "hits of " << ray_name(i) << ": expected " << a.size() << ", actual "
                                  << b.size() << "; hit " << k << " differs\n  " << describe(rays[i])
                                  << "\n  expected " << hit_of(a) << "\n  actual   " << hit_of(b);
    }
    return AssertionSuccess();
}

AssertionResult same_occlusion(std::span<const oracle::Ray> rays, std::span<const oracle::Hit> hits,
                               std::span<const std::uint32_t> occluded) {
    if (hits.size() != rays.size() || occluded.size() != rays.size())
        return AssertionFailure() << rays.size() << " rays, " << hits.size() << " hits, " << occluded.size()
                                  << " answers";
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (occluded[i] != (hits[i].primitive != SETKA_NO_HIT ? 1u : 0u))
            return AssertionFailure() << "any hit of " << ray_name(i) << " is " << occluded[i] << "\n  "
                                      << describe(rays[i]) << "\n  closest hit: " << describe(hits[i]);
    return AssertionSuccess();
}

}  // namespace support
