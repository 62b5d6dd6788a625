// SPDX-License-Identifier: MIT
// The dialect's translation for the host comes before every file in it.
#include "device/host_platform.h"
// The dialect.
#include "device/probe/probe.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>

#include "core/float_environment.hpp"
#include "core/probe_expectation.hpp"

namespace setka {

namespace {

using Tuple = std::array<float, 4>;

/// Numbers that are the same everywhere (Steele, Lea & Flood 2014, SplitMix).
class Bits {
  public:
    std::uint32_t next() {
        state_ += 0x9e3779b97f4a7c15u;
        std::uint64_t z = (state_ ^ (state_ >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
    }
    /// Any sign and fraction, with a biased exponent from `lowest` to `highest`; 0 is that of subnormals.
    float number(std::uint32_t lowest, std::uint32_t highest) {
        const std::uint32_t exponent = lowest + next() % (highest - lowest + 1);
        return std::bit_cast<float>((next() & 0x807fffffu) | exponent << 23);
    }
    /// An odd whole number below 2^bits.
    float odd(std::uint32_t bits) {
        return static_cast<float>((next() & ((1u << bits) - 1)) | 1u | 1u << (bits - 1));
    }

  private:
    std::uint64_t state_ = 1;
};

/// Where one rounding more or less shows, one line a case.
constexpr Tuple chosen[] = {
    {0x1.001p0f, -0x1.002p0f, 0x1.001p0f, 0x1.001p0f},  // a fused a*c + b keeps 2^-24
    {1, 0x1p-24f, 0x1p-24f, 0x1p-24f},                  // halfway, to even
    {0x1.000002p0f, 0x1p-24f, -0x1p-24f, 3},            // halfway, to even upwards
    {1, 0x1.000002p-24f, 0x1.fffffep-25f, 0x1p-50f},    // just beyond and before halfway
    {0x1p24f, 1, 1, 1},                                 // (b + c) + d and (a + c) - a
    {1e8f, 1e8f, 1, -1e8f},
    {1e-30f, 1e30f, -1e30f, 1e-30f},
    {1, 3, 49, 10},                                                  // quotients of rounded reciprocals
    {0x1p-126f, 0x1.fffffep-1f, 0x1p-126f, 0x1p-149f},               // results that just become subnormal
    {0x1.fffffep127f, 0x1.fffffep127f, 0x1p127f, -0x1.fffffep127f},  // overflow
    {0.0f, -0.0f, -0.0f, 0.0f},
    {-0.0f, -0.0f, 1, -0.0f},
    {999.99994f, 1000, 63.999996f, 1},                      // the last cell
    {2147483520.0f, 16777217.0f, 8388607.5f, 4194303.75f},  // the largest integers
};

/// Every pair of these, with others of them behind.
constexpr float special[] = {0.0f,
                             -0.0f,
                             1.0f,
                             -1.0f,
                             0x1.000002p0f,
                             0x1.fffffep-1f,
                             -3.0f,
                             0x1p-149f,
                             -0x1.fffffcp-127f,
                             0x1p-126f,
                             0x1.fffffep127f,
                             -0x1p-75f,
                             8388609.0f,
                             std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::quiet_NaN()};

/// Families of random operands; each returns one tuple.
constexpr Tuple (*families[])(Bits&) = {
    // Around 1, where approximations of quotients and roots show.
    [](Bits& r) -> Tuple {
        return {r.number(124, 130), r.number(124, 130), r.number(124, 130), r.number(124, 130)};
    },
    // Anything finite.
    [](Bits& r) -> Tuple {
        return {r.number(0, 254), r.number(0, 254), r.number(0, 254), r.number(0, 254)};
    },
    // Subnormal operands and results.
    [](Bits& r) -> Tuple {
        return {r.number(0, 30), r.number(0, 2), r.number(1, 22), r.number(0, 0)};
    },
    // a*d - b*c is 0 unless one product is fused.
    [](Bits& r) -> Tuple {
        const float x = r.number(125, 129), y = r.number(125, 129);
        return {x, x, y, y};
    },
    // Sums that cancel.
    [](Bits& r) -> Tuple {
        const float large = r.number(140, 160), small = r.number(127, 150);
        return {large, large, small, -large};
    },
    // Products of 25 bits: halfway between two floats.
    [](Bits& r) -> Tuple {
        return {r.odd(12), r.odd(13), r.odd(13), r.odd(12)};
    },
    // Next to whole numbers, where cells meet.
    [](Bits& r) -> Tuple {
        const auto beside = [&] {
            const auto whole = static_cast<float>(1 + r.next() % 1100);
            return std::bit_cast<float>(std::bit_cast<std::uint32_t>(whole) + r.next() % 3 - 1);
        };
        return {beside(), beside(), beside(), 1};
    },
    // Nearly equal products of any sign.
    [](Bits& r) -> Tuple {
        const float x = r.number(120, 134), y = r.number(120, 134);
        const float z = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + r.next() % 5);
        return {x, y, y, z};
    },
};
constexpr int tuples_a_family = 40;

std::vector<Tuple> make_tuples() {
    std::vector<Tuple> tuples(std::begin(chosen), std::end(chosen));
    constexpr std::size_t n = std::size(special);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            tuples.push_back(
                {special[i], special[j], special[(5 * i + j + 3) % n], special[(i + 7 * j + 1) % n]});
    Bits bits;
    for (const auto family : families)
        for (int k = 0; k < tuples_a_family; ++k) tuples.push_back(family(bits));
    return tuples;
}

/// A turn, a scale and a shift whose products are all inexact.
constexpr float matrix[12] = {0.8660254f,  -0.35355338f, 0.35355338f, 0.1f, 0.0f,        0.70710677f,
                              0.70710677f, -0.3f,        -0.5f,       0.6f, 1.41421354f, 7.7f};

template <typename Record>
Record patterned(std::uint32_t slot) {
    static_assert(sizeof(Record) % 4 == 0 && sizeof(Record) * 2 + 4 <= SK_PROBE_SLOT * 4);
    std::array<std::uint32_t, sizeof(Record) / 4> words;
    for (std::uint32_t k = 0; k < words.size(); ++k) words[k] = probe_pattern(slot, k);
    return std::bit_cast<Record>(words);
}

// Each list of members covers its record.
#define SETKA_COUNT(member) +1
#define SETKA_CHECK_LIST(type, variable, members)                            \
    static_assert(sizeof(type) == 4 * (0 members(SETKA_COUNT, SETKA_COUNT)), \
                  #type " has members that are not listed");
SK_PROBE_RECORDS(SETKA_CHECK_LIST)
#undef SETKA_CHECK_LIST
#undef SETKA_COUNT

#define SETKA_COUNT(type, variable, members) +1u
constexpr std::uint32_t record_count = 0u SK_PROBE_RECORDS(SETKA_COUNT);
#undef SETKA_COUNT

ProbeInput make_input() {
    ProbeInput input;
    const std::vector<Tuple> tuples = make_tuples();
    input.tuple_count = static_cast<std::uint32_t>(tuples.size());
    for (const Tuple& tuple : tuples) input.tuples.insert(input.tuples.end(), tuple.begin(), tuple.end());
    input.tuples.insert(input.tuples.end(), std::begin(matrix), std::end(matrix));
    std::uint32_t slot = 0;
#define SETKA_FILL(type, variable, members) input.records.variable = patterned<type>(slot++);
    SK_PROBE_RECORDS(SETKA_FILL)
#undef SETKA_FILL
    // Copied as bytes: the records are read from there as what they are.
    input.memory.resize(record_count * SK_PROBE_SLOT * 4);
    for (std::uint32_t i = 0; i < record_count * SK_PROBE_SLOT; ++i) {
        const std::uint32_t word = probe_pattern(i / SK_PROBE_SLOT, i % SK_PROBE_SLOT);
        std::memcpy(&input.memory[4 * i], &word, 4);
    }
    return input;
}

/// Not inlined: the compiler must not move it out of the scope of a FloatEnvironment.
[[gnu::noinline]] void evaluate(const ProbeInput& input, std::vector<std::uint32_t>& words) {
    for (std::uint32_t i = 0; i < input.tuple_count; ++i)
        sk_probe_rounding(i, input.tuple_count, input.tuples.data(), words.data());
}

}  // namespace

const ProbeInput& probe_input() {
    static const ProbeInput input = make_input();
    return input;
}

const std::vector<ProbeExpression>& probe_expressions() {
    static const std::vector<ProbeExpression> expressions{
#define SETKA_FLOAT(name, text, value) {text, true},
#define SETKA_INTEGER(name, text, value) {text, false},
        SK_PROBE_EXPRESSIONS(SETKA_FLOAT, SETKA_INTEGER)
#undef SETKA_FLOAT
#undef SETKA_INTEGER
    };
    return expressions;
}

const std::vector<ProbeMember>& probe_members() {
    static const std::vector<ProbeMember> all = [] {
        std::vector<ProbeMember> list;
        std::uint32_t slot = 0;
        const auto add = [&](std::string_view record, std::initializer_list<std::string_view> names) {
            std::uint32_t at = slot * SK_PROBE_SLOT;
            list.push_back({record, "", slot, false, at++});
            for (const bool is_argument : {true, false})
                for (const std::string_view name : names)
                    list.push_back({record, name, slot, is_argument, at++});
            ++slot;
        };
#define SETKA_NAME(member) #member,
#define SETKA_ADD(type, variable, members) add(#type, {members(SETKA_NAME, SETKA_NAME)});
        SK_PROBE_RECORDS(SETKA_ADD)
#undef SETKA_ADD
#undef SETKA_NAME
        return list;
    }();
    return all;
}

ProbeWords expected_probe(std::uint32_t group_size) {
    const ProbeInput& input = probe_input();
    ProbeWords words;
    words.rounding.resize(probe_expressions().size() * input.tuple_count);
    {
        const FloatEnvironment environment;
        evaluate(input, words.rounding);
    }
    words.layout.resize(record_count * SK_PROBE_SLOT);
    const ProbeRecords& r = input.records;
    sk_probe_layout(0, r.ray, r.hit, r.primitive, r.cost, r.bounds, r.instance, r.grid, r.params, r.camera,
                    r.material, r.light, r.background, r.surface, reinterpret_cast<const char*>(input.memory.data()),
                    words.layout.data());
    std::uint64_t moved = 1;
    for (std::uint32_t round = 0; round < probe_barrier_rounds; ++round) moved += round + 2;
    for (std::uint32_t group = 0; group < probe_barrier_groups; ++group)
        for (std::uint32_t item = 0; item < group_size; ++item)
            words.barrier.push_back(
                sk_probe_token(group, static_cast<std::uint32_t>((item + moved) % group_size)));
    return words;
}

}  // namespace setka
