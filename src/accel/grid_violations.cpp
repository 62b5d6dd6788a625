// SPDX-License-Identifier: MIT
/// Can rays be traced through these tables? Header first, then sizes, then contents: each stage relies on the
/// one before.
#include "accel/grid_violations.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <limits>
#include <utility>

#include "accel/world_geometry.hpp"
#include "core/float_environment.hpp"

namespace setka {

namespace {

constexpr std::uint32_t most_cells_per_axis = 4096;
constexpr std::uint32_t most_triangles = 1u << 28;
constexpr std::uint32_t most_entries = std::numeric_limits<std::int32_t>::max();
constexpr float least_cell_size = 0x1p-80f;
constexpr float largest_extent = 1e20f;

std::string text(float number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(number));
    return digits;
}
template <std::integral T>
std::string text(T number) {
    return std::to_string(number);
}
std::string text(const char* words) { return words; }

template <typename... Parts>
std::string sentence(const Parts&... parts) {
    return (std::string() + ... + text(parts));
}

/// 0 and -0 differ, a NaN is itself.
bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

/// One invariant, of which only the first violation is told.
class Invariant {
  public:
    explicit Invariant(std::vector<std::string>& list) : list_(list) {}

    template <typename... Parts>
    void violated(const Parts&... parts) {
        if (!std::exchange(is_violated_, true)) list_.push_back(sentence(parts...));
    }
    [[nodiscard]] bool holds() const { return !is_violated_; }

  private:
    std::vector<std::string>& list_;
    bool is_violated_ = false;
};

template <typename... Parts>
void require(std::vector<std::string>& list, bool holds, const Parts&... parts) {
    if (!holds) list.push_back(sentence(parts...));
}

void check_counts(const ::SetkaGridHeader& h, std::vector<std::string>& list) {
    for (int axis = 0; axis < 3; ++axis)
        require(list, h.dims[axis] >= 1 && h.dims[axis] <= most_cells_per_axis, "header: dims[", axis,
                "] is ", h.dims[axis], "; 1 to ", most_cells_per_axis, " are accepted");
    if (!list.empty()) return;
    const std::uint64_t cells = std::uint64_t(h.dims[0]) * h.dims[1] * h.dims[2];
    require(list, h.cell_count == cells, "header: cell_count is ", h.cell_count, "; the product of dims is ",
            cells);
    require(list, h.cell_count <= most_entries, "header: cell_count is ", h.cell_count, "; up to ",
            most_entries, " are accepted");
    require(list, h.reference_count <= most_entries, "header: reference_count is ", h.reference_count,
            "; up to ", most_entries, " are accepted");
    require(list, h.triangle_count >= 1 && h.triangle_count <= most_triangles, "header: triangle_count is ",
            h.triangle_count, "; 1 to ", most_triangles, " are accepted");
    require(list, h.instance_count >= 1 && h.instance_count <= most_entries, "header: instance_count is ",
            h.instance_count, "; 1 to ", most_entries, " are accepted");
    require(list, h.reserved[0] == 0 && h.reserved[1] == 0, "header: reserved is ", h.reserved[0], ", ",
            h.reserved[1], "; 0, 0 is accepted");
}

void check_numbers(const ::SetkaGridHeader& h, std::vector<std::string>& list) {
    require(list, h.cell_size >= least_cell_size && h.cell_size <= largest_extent, "header: cell_size is ",
            h.cell_size, "; ", least_cell_size, " to ", largest_extent, " are accepted");
    require(list, same_bits(h.inverse_cell_size, 1.0f / h.cell_size), "header: inverse_cell_size is ",
            h.inverse_cell_size, "; 1 / cell_size is ", 1.0f / h.cell_size);
    const float tolerance = static_cast<float>(*std::ranges::max_element(h.dims)) * 0x1p-17f;
    require(list, same_bits(h.tolerance, tolerance), "header: tolerance is ", h.tolerance,
            "; max(dims) * 2^-17 is ", tolerance);
    require(list, h.extent >= 0 && h.extent <= largest_extent, "header: extent is ", h.extent, "; 0 to ",
            largest_extent, " are accepted");
}

void check_size(std::vector<std::string>& list, const char* table, std::uint64_t size, std::uint64_t needed,
                const char* why) {
    require(list, size == needed, table, " has ", size, " elements; ", why, " asks for ", needed);
}

void check_sizes(const HostTables& tables, std::vector<std::string>& list) {
    const ::SetkaGridHeader& h = tables.header;
    check_size(list, "offsets", tables.offsets.size(), h.cell_count, "cell_count");
    check_size(list, "counts", tables.counts.size(), h.cell_count, "cell_count");
    check_size(list, "references", tables.references.size(), h.reference_count, "reference_count");
    check_size(list, "triangles", tables.triangles.size(), 9 * std::uint64_t(h.triangle_count),
               "9 * triangle_count");
    check_size(list, "instance starts", tables.instance_starts.size(), std::uint64_t(h.instance_count) + 1,
               "instance_count + 1");
    check_size(list, "instances", tables.instances.size(), h.instance_count, "instance_count");
}

/// Every coordinate is a number and not -0; returns the box around them.
Bounds check_triangles(std::span<const float> triangles, std::vector<std::string>& list) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Bounds box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    Invariant infinite(list), negative_zero(list);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const float value = triangles[i];
        const std::size_t axis = i % 3;
        if (!std::isfinite(value))
            infinite.violated("triangle ", i / 9, " has a coordinate that is not finite: ", value);
        if (same_bits(value, -0.0f))
            negative_zero.violated("triangle ", i / 9, " has a coordinate that is -0; 0 is accepted");
        box.lower[axis] = std::min(box.lower[axis], value);
        box.upper[axis] = std::max(box.upper[axis], value);
    }
    return box;
}

/// The box is the triangles', and the grid's cells are laid out in it: else a walk could leave the grid or
/// never end.
void check_box(const HostTables& tables, const Bounds& box, std::vector<std::string>& list) {
    const ::SetkaGridHeader& h = tables.header;
    for (int axis = 0; axis < 3; ++axis) {
        const float lower = tables.bounds.lower[axis], upper = tables.bounds.upper[axis];
        require(list, same_bits(lower, box.lower[axis]), "bounds: lower[", axis, "] is ", lower,
                "; the triangles' smallest is ", box.lower[axis]);
        require(list, same_bits(upper, box.upper[axis]), "bounds: upper[", axis, "] is ", upper,
                "; the triangles' largest is ", box.upper[axis]);
        require(list, same_bits(h.origin[axis], lower), "header: origin[", axis, "] is ", h.origin[axis],
                "; bounds.lower is ", lower);
        // Products of a float and 13 bits are exact in double.
        const double side = double(upper) - double(lower), size = h.cell_size;
        const std::uint32_t dim = h.dims[axis];
        require(list, (dim + 1.0) * size >= side && (dim == 1 || (dim - 1.0) * size < side), "header: dims[",
                axis, "] is ", dim, ", but ", dim, " cells of ", h.cell_size,
                " do not just cover the bounds' ", static_cast<float>(side));
    }
    require(list, same_bits(h.extent, extent_of(tables.bounds)), "header: extent is ", h.extent,
            "; the longest side of the bounds is ", extent_of(tables.bounds));
}

void check_instances(const HostTables& tables, std::vector<std::string>& list) {
    const auto starts = tables.instance_starts;
    const auto instances = tables.instances;
    require(list, starts.front() == 0, "instance starts: the first is ", starts.front(), "; 0 is accepted");
    require(list, starts.back() == tables.header.triangle_count, "instance starts: the last is ",
            starts.back(), "; triangle_count is ", tables.header.triangle_count);
    Invariant descending(list), other_start(list), infinite(list);
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (starts[i + 1] < starts[i])
            descending.violated("instance starts: ", starts[i + 1], " follows ", starts[i], " at instance ",
                                i + 1, "; they have to ascend");
        if (instances[i].first_triangle != starts[i])
            other_start.violated("instance ", i, ": first_triangle is ", instances[i].first_triangle,
                                 "; its start is ", starts[i]);
        if (!std::ranges::all_of(instances[i].matrix, [](float value) { return std::isfinite(value); }))
            infinite.violated("instance ", i, ": its matrix is not finite");
    }
}

/// Every list lies behind the one before it, and the last ends where the references end.
bool check_cells(const HostTables& tables, std::vector<std::string>& list) {
    const std::uint64_t references = tables.references.size();
    Invariant half_empty(list), misplaced(list), too_long(list), wrong_sum(list);
    std::uint64_t end = 0;  // of the lists so far; 2^31 counts of 32 bits fit
    for (std::size_t cell = 0; cell < tables.counts.size(); ++cell) {
        const std::int32_t offset = tables.offsets[cell];
        const std::uint32_t count = tables.counts[cell];
        if ((offset == -1) != (count == 0)) {
            half_empty.violated("cell ", cell, " has offset ", offset, " and count ", count,
                                "; an empty cell has -1 and 0, others neither");
        } else if (count != 0) {
            if (offset < 0 || static_cast<std::uint64_t>(offset) != end)
                misplaced.violated("cell ", cell, " has offset ", offset, "; the lists before it end at ",
                                   end);
            if (offset >= 0 && static_cast<std::uint64_t>(offset) + count > references)
                too_long.violated("cell ", cell, " has offset ", offset, " and count ", count,
                                  ", beyond the ", references, " references");
        }
        end += count;
    }
    if (end != references)
        wrong_sum.violated("counts add up to ", end, "; there are ", references, " references");
    return half_empty.holds() && misplaced.holds() && too_long.holds() && wrong_sum.holds();
}

void check_references(const HostTables& tables, std::vector<std::string>& list) {
    Invariant out_of_range(list);
    for (std::size_t i = 0; i < tables.references.size(); ++i)
        if (tables.references[i] >= tables.header.triangle_count)
            out_of_range.violated("reference ", i, " is triangle ", tables.references[i], "; there are ",
                                  tables.header.triangle_count);
}

/// Lists tile the references: check_cells() found nothing.
void check_order(const HostTables& tables, std::vector<std::string>& list) {
    Invariant unordered(list);
    std::size_t first = 0;
    for (std::size_t cell = 0; cell < tables.counts.size(); ++cell) {
        const std::size_t end = first + tables.counts[cell];
        for (std::size_t i = first + 1; i < end; ++i)
            if (tables.references[i] <= tables.references[i - 1])
                unordered.violated("cell ", cell, ": triangle ", tables.references[i], " follows ",
                                   tables.references[i - 1], " in its list; lists have to ascend");
        first = end;
    }
}

[[gnu::noinline]] std::vector<std::string> examine(const HostTables& tables) {
    std::vector<std::string> list;
    check_counts(tables.header, list);
    check_numbers(tables.header, list);
    if (list.empty()) check_sizes(tables, list);
    if (!list.empty()) return list;
    const Bounds box = check_triangles(tables.triangles, list);
    if (list.empty()) check_box(tables, box, list);
    check_instances(tables, list);
    const bool tiles = check_cells(tables, list);
    check_references(tables, list);
    if (tiles) check_order(tables, list);
    return list;
}

}  // namespace

std::vector<std::string> violations_of(const HostTables& tables) {
    // Sound tables stay sound in a thread that flushes subnormals.
    const FloatEnvironment environment;
    return examine(tables);
}

}  // namespace setka
