// SPDX-License-Identifier: MIT
#include "core/probe.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>

#include "core/float_environment.hpp"
#include "core/launch.hpp"
#include "core/probe_expectation.hpp"

namespace setka {

namespace {

std::string hexadecimal(std::uint32_t word) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%08x", word);
    return text;
}

/// "0.1 (0x3dcccccd)".
std::string float_text(std::uint32_t word) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(std::bit_cast<float>(word)));
    return text + (" (" + hexadecimal(word) + ")");
}

std::string value_text(std::uint32_t word, bool is_float) {
    return is_float ? float_text(word) : std::to_string(word) + " (" + hexadecimal(word) + ")";
}

/// True if the variable `name` stands in `text`, not as a letter of a word.
bool mentions(std::string_view text, char name) {
    const auto is_letter = [&](std::size_t i) {
        return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]));
    };
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == name && !is_letter(i - 1) && !is_letter(i + 1)) return true;
    return false;
}

std::string operands_text(std::string_view text, std::span<const float> tuple) {
    std::string result;
    for (std::size_t k = 0; k < 4; ++k) {
        const char name = static_cast<char>('a' + k);
        if (!mentions(text, name)) continue;
        result += result.empty() ? "" : ", ";
        result += name + (" = " + float_text(std::bit_cast<std::uint32_t>(tuple[k])));
    }
    return result;
}

/// Which NaN it is differs between devices and shows nowhere.
bool is_same(std::uint32_t found, std::uint32_t expected, bool is_float) {
    const auto is_nan = [](std::uint32_t word) { return (word & 0x7fffffffu) > 0x7f800000u; };
    return found == expected || (is_float && is_nan(found) && is_nan(expected));
}

void compare_rounding(const ProbeWords& found, const ProbeWords& expected, ParityReport& report) {
    const ProbeInput& input = probe_input();
    const std::size_t n = input.tuple_count;
    for (std::size_t e = 0; e < probe_expressions().size(); ++e) {
        const auto [text, is_float] = probe_expressions()[e];
        std::size_t first = n, count = 0;
        for (std::size_t i = n; i-- > 0;)
            if (!is_same(found.rounding[e * n + i], expected.rounding[e * n + i], is_float)) {
                first = i;
                ++count;
            }
        if (count == 0) continue;
        report.differences.push_back(std::string(text) + " with " +
                                     operands_text(text, std::span(input.tuples).subspan(4 * first, 4)) +
                                     " gives " + value_text(found.rounding[e * n + first], is_float) +
                                     " instead of " + value_text(expected.rounding[e * n + first], is_float) +
                                     "; " + std::to_string(count) + " of " + std::to_string(n) +
                                     " cases differ");
    }
}

/// Where a word of the pattern was read, as bytes from the start of its record.
std::string place_text(std::uint32_t word, const ProbeMember& member, std::uint32_t record_bytes) {
    const std::uint32_t k = word - probe_pattern(member.slot, 0);
    if (k >= SK_PROBE_SLOT) return "at no place of the record (it holds " + hexadecimal(word) + ")";
    const int skipped = member.is_argument ? 0 : static_cast<int>(record_bytes);
    return "at byte " + std::to_string(static_cast<int>(4 * k) - skipped);
}

void compare_layout(const ProbeWords& found, const ProbeWords& expected, ParityReport& report) {
    std::uint32_t record_bytes = 0;
    for (const ProbeMember& member : probe_members()) {
        const std::uint32_t is = found.layout[member.at], should = expected.layout[member.at];
        if (member.name.empty()) record_bytes = should;
        if (is == should) continue;
        const std::string record(member.record);
        report.differences.push_back(member.name.empty()
                                         ? "a " + record + " has " + std::to_string(is) +
                                               " bytes instead of " + std::to_string(should)
                                         : record + "." + std::string(member.name) +
                                               (member.is_argument ? " of a kernel argument" : " in memory") +
                                               " lies " + place_text(is, member, record_bytes) +
                                               " instead of " + place_text(should, member, record_bytes));
    }
}

void compare_barrier(const ProbeWords& found, const ProbeWords& expected, std::uint32_t group_size,
                     ParityReport& report) {
    const std::size_t n = expected.barrier.size();
    std::size_t first = n, count = 0;
    for (std::size_t i = n; i-- > 0;)
        if (found.barrier[i] != expected.barrier[i]) {
            first = i;
            ++count;
        }
    if (count == 0) return;
    report.differences.push_back(
        "barriers: of " + std::to_string(n) + " values passed around groups of " +
        std::to_string(group_size) + " work-items " + std::to_string(count) + " are wrong; work-item " +
        std::to_string(first % group_size) + " of group " + std::to_string(first / group_size) + " holds " +
        hexadecimal(found.barrier[first]) + " instead of " + hexadecimal(expected.barrier[first]) +
        "; PrimitiveShape::Serial needs no barrier");
}

/// Puts the kernels on the queue, which write one after the other into one buffer.
Buffer<std::uint32_t> enqueue_probe(Queue& queue, std::size_t rounding, std::size_t layout,
                                    std::size_t barrier) {
    const ProbeInput& input = probe_input();
    const ProbeRecords& r = input.records;
    queue.impl().begin_stage("probe");
    const auto tuples = queue.upload(std::span(input.tuples), "probe operands");
    const auto memory = queue.upload(std::span(input.memory), "probe records");
    const auto words = queue.make_buffer<std::uint32_t>(rounding + layout + barrier, "probe words");
    // What a kernel leaves out is not taken for the answer of an earlier run.
    queue.impl().fill(*words.memory(), 0xa5a5a5a5u, words.size_bytes());
    launch_items(queue, Kernel::probe_rounding, input.tuple_count, tuples, words);
    launch_groups(queue, Kernel::probe_layout, 1, 1, static_cast<std::uint32_t>(rounding), r.ray, r.hit,
                  r.primitive, r.cost, r.bounds, r.instance, r.grid, r.params, r.camera, r.material, r.light, r.background,
                  r.surface, memory, words);
    launch_groups(queue, Kernel::probe_barrier, probe_barrier_groups,
                  queue.device().options().work_group_size, static_cast<std::uint32_t>(rounding + layout),
                  probe_barrier_rounds, words);
    return words;
}

}  // namespace

ParityReport compare_probe(const ProbeWords& found, std::uint32_t group_size) {
    const ProbeWords expected = expected_probe(group_size);
    const FloatEnvironment environment;  // so that a subnormal operand is not printed as 0
    ParityReport report;
    compare_layout(found, expected, report);
    compare_rounding(found, expected, report);
    compare_barrier(found, expected, group_size, report);
    report.is_capable = report.differences.empty();
    return report;
}

ParityReport run_probe(Queue& queue) {
    const std::uint32_t group_size = queue.device().options().work_group_size;
    const std::size_t rounding = probe_expressions().size() * probe_input().tuple_count;
    const std::size_t layout = probe_input().memory.size() / 4, barrier = probe_barrier_groups * group_size;
    const std::vector<std::uint32_t> words = queue.download(enqueue_probe(queue, rounding, layout, barrier));
    const auto part = [&](std::size_t first, std::size_t count) {
        const auto begin = words.begin() + static_cast<std::ptrdiff_t>(first);
        return std::vector<std::uint32_t>(begin, begin + static_cast<std::ptrdiff_t>(count));
    };
    return compare_probe({part(0, rounding), part(rounding, layout), part(rounding + layout, barrier)},
                         group_size);
}

}  // namespace setka
