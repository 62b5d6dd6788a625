// SPDX-License-Identifier: MIT
#include "accel/grid_limits.hpp"

#include <algorithm>

#include "accel/compact_tables.hpp"
#include "device/grid/limits.h"
#include "setka/error.hpp"

namespace setka {

namespace {

constexpr std::uint64_t word = sizeof(std::uint32_t);

static_assert(std::uint64_t(SK_LONG_ROW) * SK_MOST_LONG_ROWS > most_entries,
              "no grid that is allowed may be left uncounted");

std::string bytes_text(std::uint64_t bytes) {
    return std::to_string(bytes) + " bytes (" + std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB)";
}

}  // namespace

GridLimits::GridLimits(const Device& device, const GridOptions& options, std::uint64_t own_bytes)
    : device_(device), options_(options), held_before_bytes_(device.memory_in_use_bytes() - own_bytes) {}

void GridLimits::check_cells(const GridResolution& resolution) const {
    const std::uint64_t cells = resolution.cell_count(), words = SK_REPORT + counter_count(resolution.dims);
    const std::uint64_t budget = device_.options().memory_budget_bytes;
    const std::uint64_t most_words = std::min(budget, device_.info().max_allocation_bytes) / word;
    if (cells <= most_entries && words <= most_words) return;
    const double share = double(cells) / double(words);
    const auto limit = std::min(most_entries, static_cast<std::uint64_t>(share * double(most_words)));
    throw Error(ErrorCategory::OutOfMemory,
                "density " + std::to_string(options_.density) + " needs " + std::to_string(cells) +
                    " cells; the memory budget of " + bytes_text(budget) + " and " + device_.info().name +
                    " allow " + std::to_string(limit) + ": use a density below " +
                    std::to_string(double(options_.density) * double(limit) / double(cells)));
}

bool GridLimits::fits(std::uint64_t bytes) const {
    return held_before_bytes_ + bytes <= device_.options().memory_budget_bytes;
}

void GridLimits::check_budget(std::uint64_t bytes, const std::string& purpose) const {
    if (fits(bytes)) return;
    throw Error(ErrorCategory::OutOfMemory,
                "density " + std::to_string(options_.density) + " needs " + bytes_text(bytes) + " " + purpose +
                    "; " + bytes_text(held_before_bytes_) + " of the memory budget of " +
                    bytes_text(device_.options().memory_budget_bytes) +
                    " are in use: use a lower density or a larger budget");
}

void GridLimits::check_allocation(std::uint64_t words, const std::string& name) const {
    if (fits_an_allocation(words)) return;
    throw Error(ErrorCategory::OutOfMemory, "density " + std::to_string(options_.density) + " needs " +
                                                bytes_text(words * word) + " for '" + name + "'; " +
                                                device_.info().name + " allows " +
                                                std::to_string(device_.info().max_allocation_bytes) +
                                                " in one allocation: use a lower density");
}

bool GridLimits::fits_an_allocation(std::uint64_t words) const {
    return words * word <= device_.info().max_allocation_bytes;
}

void GridLimits::refuse_count(const std::string& count) const {
    throw Error(ErrorCategory::OutOfMemory, "density " + std::to_string(options_.density) + " needs " + count +
                                                "; tables hold up to " + std::to_string(most_entries) +
                                                ": use a lower density or fewer cells along an axis");
}

std::uint64_t triangles_a_launch(const Device& device) {
    return device.info().type == DeviceType::Cpu ? 1u << 16 : 1u << 22;
}

std::uint64_t rows_a_launch(const Device& device, const std::uint32_t (&dims)[3]) {
    const bool is_cpu = device.info().type == DeviceType::Cpu;
    const std::uint64_t columns = is_cpu ? 1u << 23 : 1u << 26;
    const std::uint64_t filling = is_cpu ? 1 : 2048 * std::uint64_t(device.info().compute_units);
    return std::max(columns / *std::ranges::max_element(dims), filling);
}

}  // namespace setka
