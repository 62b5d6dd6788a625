// SPDX-License-Identifier: MIT
/// Where do two devices first differ? See the header.
#include "workload/difference.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <span>

#include "trace/names.hpp"

namespace setka::workload {

namespace {

using std::to_string;
using MaybeDifference = std::optional<Difference>;

[[nodiscard]] std::string text_of(float value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.9g (%a)", double(value), double(value));
    return text;
}

[[nodiscard]] std::string text_of(std::uint32_t value) { return to_string(value); }

[[nodiscard]] std::string text_of(const float (&point)[3]) {
    return text_of(point[0]) + ", " + text_of(point[1]) + ", " + text_of(point[2]);
}

[[nodiscard]] std::string text_of(const Ray& ray) {
    return "origin " + text_of(ray.origin) + "; direction " + text_of(ray.direction) + "; t " +
           text_of(ray.tmin) + " to " + text_of(ray.tmax);
}

[[nodiscard]] std::string text_of(const Hit& hit) {
    return (hit.primitive == SETKA_NO_HIT ? "no hit: t " : "t ") + text_of(hit.t) + ", u " + text_of(hit.u) +
           ", v " + text_of(hit.v) + ", primitive " + to_string(hit.primitive) + ", instance " +
           to_string(hit.instance);
}

/// Bytes, not values: a NaN equals itself, and -0 is not 0.
template <typename T>
[[nodiscard]] bool is_same(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

template <typename T>
[[nodiscard]] bool is_same(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

// ---- tables

/// A header in words of four bytes.
constexpr std::array<const char*, 16> header_words{
    "origin x",       "origin y", "origin z",   "cell size",  "inverse cell size", "tolerance",
    "dims x",         "dims y",   "dims z",     "cell count", "reference count",   "triangle count",
    "instance count", "extent",   "reserved 0", "reserved 1"};
static_assert(sizeof(SetkaGridHeader) == 4 * header_words.size());

[[nodiscard]] std::string header_word(std::uint32_t word, std::size_t index) {
    const bool is_float =
        index < offsetof(SetkaGridHeader, dims) / 4 || index == offsetof(SetkaGridHeader, extent) / 4;
    return is_float ? text_of(std::bit_cast<float>(word)) : text_of(word);
}

[[nodiscard]] MaybeDifference header_difference(const SetkaGridHeader& a, const SetkaGridHeader& b) {
    using Words = std::array<std::uint32_t, header_words.size()>;
    const auto words_a = std::bit_cast<Words>(a), words_b = std::bit_cast<Words>(b);
    for (std::size_t i = 0; i < words_a.size(); ++i)
        if (words_a[i] != words_b[i])
            return Difference{"grid header", header_words[i], header_word(words_a[i], i),
                              header_word(words_b[i], i)};
    return std::nullopt;
}

/// A cell's list, as far as it lies within the references: a wrong offset must not be followed out of them.
[[nodiscard]] std::span<const std::uint32_t> list_of(const Tables& tables, std::size_t cell) {
    const std::span<const std::uint32_t> references(tables.references);
    const std::size_t begin = std::min(std::size_t(std::max(tables.offsets[cell], 0)), references.size());
    return references.subspan(begin, std::min<std::size_t>(tables.counts[cell], references.size() - begin));
}

/// Offset, count and the list around its entry `from`.
[[nodiscard]] std::string cell_text(const Tables& tables, std::size_t cell, std::size_t from) {
    constexpr std::size_t before = 4, most_shown = 24;
    const auto list = list_of(tables, cell);
    const std::size_t begin =
        list.size() <= most_shown ? 0 : std::min(from - std::min(from, before), list.size());
    const std::size_t end = std::min(begin + most_shown, list.size());
    std::string text =
        "offset " + to_string(tables.offsets[cell]) + ", count " + to_string(tables.counts[cell]) + ", list";
    if (begin != 0) text += " …";
    for (std::size_t i = begin; i < end; ++i) text += ' ' + to_string(list[i]);
    return text + (end != list.size() ? " …" : "");
}

/// The first cell with another offset, count or list; of equally many cells.
[[nodiscard]] MaybeDifference cell_difference(const Tables& a, const Tables& b) {
    MaybeDifference first;
    for (std::size_t cell = 0; cell < a.offsets.size(); ++cell) {
        const auto list_a = list_of(a, cell), list_b = list_of(b, cell);
        const char* part = a.offsets[cell] != b.offsets[cell] ? "cell offset"
                           : a.counts[cell] != b.counts[cell] ? "cell count"
                           : !is_same(list_a, list_b)         ? "cell list"
                                                              : nullptr;
        if (part == nullptr) continue;
        if (!first) {
            const auto& d = a.header.dims;
            const std::string place = "cell " + to_string(cell) + " (" + to_string(cell % d[0]) + ", " +
                                      to_string(cell / d[0] % d[1]) + ", " + to_string(cell / d[0] / d[1]) +
                                      ") of " + to_string(d[0]) + " x " + to_string(d[1]) + " x " +
                                      to_string(d[2]);
            const auto from = std::size_t(std::ranges::mismatch(list_a, list_b).in1 - list_a.begin());
            first = Difference{part, place,           cell_text(a, cell, from), cell_text(b, cell, from),
                               0,    a.offsets.size()};
        }
        ++first->differing;
    }
    return first;
}

[[nodiscard]] MaybeDifference size_difference(const std::string& part, std::size_t a, std::size_t b) {
    if (a == b) return std::nullopt;
    return Difference{part, "how many there are", to_string(a), to_string(b)};
}

/// The number of pairs comes last: the cell whose list is longer says more.
[[nodiscard]] MaybeDifference table_difference(const Tables& a, const Tables& b) {
    SetkaGridHeader header = b.header;
    header.reference_count = a.header.reference_count;
    if (auto found = header_difference(a.header, header)) return found;
    if (auto found = size_difference("cell offset", a.offsets.size(), b.offsets.size())) return found;
    if (auto found = size_difference("cell count", a.counts.size(), b.counts.size())) return found;
    const auto as_span = [](const auto& values) { return std::span(values); };
    const bool is_equal = is_same(as_span(a.offsets), as_span(b.offsets)) &&
                          is_same(as_span(a.counts), as_span(b.counts)) &&
                          is_same(as_span(a.references), as_span(b.references));
    if (!is_equal)
        if (auto found = cell_difference(a, b)) return found;
    if (auto found = header_difference(a.header, b.header)) return found;
    return size_difference("reference", a.references.size(), b.references.size());
}

// ---- rays, hits and pictures

/// The first element that differs; `place(i)` says which one that is.
template <typename T, typename Place>
[[nodiscard]] MaybeDifference list_difference(const std::string& part, const std::vector<T>& a,
                                              const std::vector<T>& b, const Place& place) {
    if (auto found = size_difference(part, a.size(), b.size())) return found;
    if (is_same(std::span(a), std::span(b))) return std::nullopt;
    MaybeDifference first;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (is_same(a[i], b[i])) continue;
        if (!first) first = Difference{part, place(i), text_of(a[i]), text_of(b[i]), 0, a.size()};
        ++first->differing;
    }
    return first;
}

[[nodiscard]] MaybeDifference ray_difference(const std::string& part, const std::vector<Ray>& a,
                                             const std::vector<Ray>& b) {
    return list_difference(part, a, b, [](std::size_t i) { return "ray " + to_string(i); });
}

/// A pixel as the list comparison sees it.
struct Pixel {
    Float3 linear;
    std::array<std::uint32_t, 3> srgb;
};

[[nodiscard]] std::string text_of(const Pixel& pixel) {
    return "linear " + text_of(pixel.linear.x) + ", " + text_of(pixel.linear.y) + ", " +
           text_of(pixel.linear.z) + "; sRGB " + to_string(pixel.srgb[0]) + ", " + to_string(pixel.srgb[1]) +
           ", " + to_string(pixel.srgb[2]);
}

[[nodiscard]] std::vector<Pixel> pixels_of(const Image& image) {
    std::vector<Pixel> pixels(image.linear.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i].linear = image.linear[i];
        for (std::size_t c = 0; c < 3; ++c) pixels[i].srgb[c] = image.srgb.at(3 * i + c);
    }
    return pixels;
}

/// What one step of the other found, in the order of what follows from what.
class StepComparison {
    // First, since its type is deduced.
    [[nodiscard]] auto place_in(const std::vector<Ray>& rays) const {
        return [this, &rays](std::size_t i) {
            return "ray " + to_string(i) + ", " + step_ + (i < rays.size() ? ": " + text_of(rays[i]) : "");
        };
    }

  public:
    StepComparison(const Answers& reference, const Results& expected, GridStep step, const Results& results)
        : reference_(reference), expected_(expected), step_(name_of(step)), results_(results) {}

    [[nodiscard]] MaybeDifference primary() const {
        return list_difference("primary hit", expected_.primary, results_.primary,
                               place_in(reference_.primary_rays));
    }
    [[nodiscard]] MaybeDifference shadow() const {
        return list_difference("occlusion flag", expected_.shadow, results_.shadow,
                               place_in(reference_.shadow_rays));
    }
    [[nodiscard]] MaybeDifference diffuse() const {
        return list_difference("diffuse hit", expected_.diffuse, results_.diffuse,
                               place_in(reference_.diffuse_rays));
    }
    [[nodiscard]] MaybeDifference picture() const {
        const Image &a = expected_.picture, &b = results_.picture;
        if (is_same(std::span(a.linear), std::span(b.linear)) &&
            is_same(std::span(a.srgb), std::span(b.srgb)))
            return std::nullopt;  // without the copies below
        const std::size_t width = std::max(1u, a.width);
        return list_difference("pixel", pixels_of(a), pixels_of(b), [&](std::size_t i) {
            return "x " + to_string(i % width) + ", y " + to_string(i / width) + ", " + step_;
        });
    }

  private:
    const Answers& reference_;
    const Results& expected_;
    std::string step_;
    const Results& results_;
};

}  // namespace

Tables download_tables(Queue& queue, const Grid& grid) {
    const GridTables tables = grid.tables(queue);
    return {grid.header(), queue.download(tables.offsets), queue.download(tables.counts),
            queue.download(tables.references)};
}

std::string Difference::to_string() const {
    std::string text = part + ", " + place;
    if (differing != 0)
        text += " (" + std::to_string(differing) + " of " + std::to_string(total) + " differ)";
    return text + "\n  reference: " + reference + "\n  other:     " + other;
}

std::optional<Difference> first_difference(const Answers& reference, const Answers& other) {
    std::vector<StepComparison> steps;
    for (const auto& [step, results] : other.steps)
        steps.emplace_back(reference, reference.steps.front().second, step, results);
    const auto in_steps = [&](MaybeDifference (StepComparison::*compare)() const) {
        MaybeDifference found;
        for (const StepComparison& step : steps)
            if (!found) found = (step.*compare)();
        return found;
    };
    if (auto found = table_difference(reference.tables, other.tables)) return found;
    if (auto found = ray_difference("primary ray", reference.primary_rays, other.primary_rays)) return found;
    if (auto found = in_steps(&StepComparison::primary)) return found;
    if (auto found = ray_difference("shadow ray", reference.shadow_rays, other.shadow_rays)) return found;
    if (auto found = in_steps(&StepComparison::shadow)) return found;
    if (auto found = ray_difference("diffuse ray", reference.diffuse_rays, other.diffuse_rays)) return found;
    if (auto found = in_steps(&StepComparison::diffuse)) return found;
    return in_steps(&StepComparison::picture);
}

}  // namespace setka::workload
