// SPDX-License-Identifier: MIT
/// Is the probe's right answer right, and does a report name whatever differs from it?
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cfenv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "core/float_environment.hpp"
#include "core/probe.hpp"
#include "core/probe_expectation.hpp"

namespace {

using namespace setka;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::uint32_t bits(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); }
bool is_nan(std::uint32_t word) { return (word & 0x7fffffffu) > 0x7f800000u; }

/// Basic operations in double, rounded once to float: a double is precise enough that this is the float
/// operation, subnormal results included (Figueroa 1995). More than one operation rounds after each.
double as_float(double value) { return static_cast<float>(value); }
using Reference = std::function<double(double a, double b, double c, double d)>;
const std::map<std::string, Reference>& references() {
    static const std::map<std::string, Reference> all{
        {"a * c + b", [](double a, double b, double c, double) { return as_float(a * c) + b; }},
        {"a * d - b * c",
         [](double a, double b, double c, double d) { return as_float(a * d) - as_float(b * c); }},
        {"a + b", [](double a, double b, double, double) { return a + b; }},
        {"a - b", [](double a, double b, double, double) { return a - b; }},
        {"a * b", [](double a, double b, double, double) { return a * b; }},
        {"a / b", [](double a, double b, double, double) { return a / b; }},
        {"1 / c", [](double, double, double c, double) { return 1 / c; }},
        {"sqrt(|a|)", [](double a, double, double, double) { return std::sqrt(std::fabs(a)); }},
        {"c * 2^-20", [](double, double, double c, double) { return c * 0x1p-20; }},
        {"d * 2^30", [](double, double, double, double d) { return d * 0x1p30; }},
        {"(b + c) + d", [](double, double b, double c, double d) { return as_float(b + c) + d; }},
        {"(a + c) - a", [](double a, double, double c, double) { return as_float(a + c) - a; }},
        {"b * d without -0", [](double, double b, double, double d) { return as_float(b * d) + 0.0; }},
        {"-c / d", [](double, double, double c, double d) { return -c / d; }},
        {"floor(a)", [](double a, double, double, double) { return std::floor(a); }},
    };
    return all;
}

TEST(ProbeExpectation, AgreesWithOperationsInDouble) {
    const ProbeInput& input = probe_input();
    const ProbeWords words = expected_probe(1);
    std::size_t checked = 0;
    for (std::size_t e = 0; e < probe_expressions().size(); ++e) {
        const std::string text(probe_expressions()[e].text);
        const auto reference = references().find(text);
        if (reference == references().end()) continue;
        ++checked;
        for (std::size_t i = 0; i < input.tuple_count; ++i) {
            const float* t = &input.tuples[4 * i];
            const std::uint32_t expected = bits(reference->second(t[0], t[1], t[2], t[3]));
            const std::uint32_t found = words.rounding[e * input.tuple_count + i];
            if (is_nan(expected)) EXPECT_TRUE(is_nan(found)) << text << ", tuple " << i;
            else EXPECT_EQ(found, expected) << text << ", tuple " << i;
        }
    }
    EXPECT_EQ(checked, references().size()) << "a text has changed";
}

/// Each trap is in the operands: what a careless device does shows in some tuple.
TEST(ProbeExpectation, ShowsFusedFlushedAndApproximateResults) {
    const ProbeInput& input = probe_input();
    int fused = 0, flushed_results = 0, flushed_operands = 0, by_reciprocal = 0, reordered = 0, near_root = 0;
    for (std::size_t i = 0; i < input.tuple_count; ++i) {
        const float a = input.tuples[4 * i], b = input.tuples[4 * i + 1], c = input.tuples[4 * i + 2],
                    d = input.tuples[4 * i + 3];
        const float apart = a * c + b, sum = (b + c) + d, other = b + (c + d), quotient = a / b;
        const float reciprocal = 1.0f / b, product = a * reciprocal, root = std::sqrt(std::fabs(a));
        const float inverse_root = 1.0f / root, by_inverse = std::fabs(a) * inverse_root;
        const bool is_finite = std::isfinite(apart) && std::isfinite(sum) && std::isfinite(quotient);
        if (!is_finite) continue;
        fused += std::fma(a, c, b) != apart;
        flushed_results += std::fpclassify(c * 0x1p-20f) == FP_SUBNORMAL;
        flushed_operands += std::fpclassify(d) == FP_SUBNORMAL;
        by_reciprocal += product != quotient;
        reordered += sum != other;
        near_root += root > 0 && by_inverse != root;
    }
    for (const int count : {fused, flushed_results, flushed_operands, by_reciprocal, reordered, near_root})
        EXPECT_GE(count, 10);
}

TEST(ProbeExpectation, DoesNotDependOnTheThreadsRounding) {
    const ProbeWords expected = expected_probe(4);
    const auto check = [&] {
        const ProbeWords words = expected_probe(4);
        EXPECT_EQ(words.rounding, expected.rounding);
    };
    std::fenv_t before;
    std::fegetenv(&before);
    for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(direction);
        check();
        EXPECT_EQ(std::fegetround(), direction) << "the caller's state is put back";
    }
    std::fesetenv(&before);
#if defined(__SSE2__)
    // Reports neither: 1e-45 is not printed as 0.
    ProbeWords doctored = expected;
    for (std::uint32_t& word : doctored.rounding) word = 1;
    const std::vector<std::string> sentences = compare_probe(doctored, 4).differences;
    EXPECT_THAT(sentences, ::testing::Contains(HasSubstr("e-45")));
    const unsigned control = _mm_getcsr();
    _mm_setcsr(control | 0x8040u);  // FTZ and DAZ
    check();
    const std::vector<std::string> flushed = compare_probe(doctored, 4).differences;
    const unsigned after = _mm_getcsr();
    _mm_setcsr(control);
    EXPECT_EQ(flushed, sentences);
    EXPECT_EQ(after & 0x8040u, 0x8040u) << "the caller's state is put back";
#endif
}

TEST(ProbeReport, TheRightWordsAreCapable) {
    for (const std::uint32_t group_size : {1u, 2u, 3u, 64u, 256u}) {
        const ParityReport report = compare_probe(expected_probe(group_size), group_size);
        EXPECT_TRUE(report.is_capable);
        EXPECT_THAT(report.differences, ::testing::IsEmpty());
    }
}

/// The one sentence about `words`.
std::string only_difference(const ProbeWords& words, std::uint32_t group_size) {
    const ParityReport report = compare_probe(words, group_size);
    EXPECT_FALSE(report.is_capable);
    EXPECT_EQ(report.differences.size(), 1u) << ::testing::PrintToString(report.differences);
    return report.differences.empty() ? "" : report.differences.front();
}

TEST(ProbeReport, NamesEachExpression) {
    const ProbeWords right = expected_probe(1);
    const std::size_t n = probe_input().tuple_count;
    for (std::size_t e = 0; e < probe_expressions().size(); ++e) {
        const std::string text(probe_expressions()[e].text);
        for (const std::size_t i : {std::size_t{0}, e * 7 % n, n - 1}) {
            ProbeWords words = right;
            std::uint32_t& word = words.rounding[e * n + i];
            word = is_nan(word) ? 0 : word ^ 1;
            EXPECT_THAT(only_difference(words, 1),
                        AllOf(::testing::StartsWith(text + " with "), HasSubstr("1 of ")));
        }
    }
}

TEST(ProbeReport, GivesOperandsAndBothValues) {
    const ProbeInput& input = probe_input();
    ASSERT_EQ(probe_expressions()[0].text, "a * c + b");
    ASSERT_EQ(std::vector<float>(input.tuples.begin(), input.tuples.begin() + 3),
              (std::vector<float>{0x1.001p0f, -0x1.002p0f, 0x1.001p0f}));
    ProbeWords words = expected_probe(1);
    words.rounding[0] = std::bit_cast<std::uint32_t>(0x1p-24f);  // what a fused operation gives
    EXPECT_EQ(only_difference(words, 1),
              "a * c + b with a = 1.00024414 (0x3f800800), b = -1.00048828 (0xbf801000), c = 1.00024414 "
              "(0x3f800800) "
              "gives 5.96046448e-08 (0x33800000) instead of 0 (0x00000000); 1 of " +
                  std::to_string(input.tuple_count) + " cases differ");
}

TEST(ProbeReport, OneNanIsAsGoodAsAnother) {
    ProbeWords words = expected_probe(1);
    const std::size_t n = probe_input().tuple_count;
    std::size_t count = 0;
    for (std::size_t e = 0; e < probe_expressions().size(); ++e)
        for (std::size_t i = 0; i < n; ++i)
            if (std::uint32_t& word = words.rounding[e * n + i];
                probe_expressions()[e].is_float && is_nan(word)) {
                word ^= 0x80000123u;
                ++count;
            }
    EXPECT_GT(count, 50u);
    EXPECT_TRUE(compare_probe(words, 1).is_capable);
}

TEST(ProbeReport, NamesEachMemberOfEachRecord) {
    const ProbeWords right = expected_probe(1);
    for (const ProbeMember& member : probe_members()) {
        ProbeWords words = right;
        words.layout[member.at] += 1;  // a byte more, or the next word
        const std::string sentence = only_difference(words, 1);
        EXPECT_THAT(sentence, HasSubstr(std::string(member.record)));
        EXPECT_THAT(sentence, HasSubstr(std::string(member.name)));
        EXPECT_THAT(sentence, HasSubstr(member.name.empty()  ? "bytes instead of"
                                        : member.is_argument ? "of a kernel argument lies at byte"
                                                             : "in memory lies at byte"));
    }
    EXPECT_GT(probe_members().size(), 250u);
}

/// A record that somebody adds is checked, or this fails.
TEST(ProbeReport, KnowsEveryRecordThatHostAndDeviceShare) {
    namespace fs = std::filesystem;
    const fs::path root = SETKA_PROJECT_DIR;
    std::vector<fs::path> files{root / "include" / "setka" / "layout.h"};
    for (const auto& entry : fs::recursive_directory_iterator(root / "src" / "device"))
        if (entry.path().filename() == "layout.h" || entry.path().filename() == "params.h")
            files.push_back(entry.path());
    std::set<std::string> declared, known;
    for (const fs::path& file : files) {
        std::ifstream stream(file);
        for (std::string line; std::getline(stream, line);) {
            std::istringstream words(line);
            std::string first, second, name;
            if (words >> first >> second >> name && first == "typedef" && second == "struct")
                declared.insert(name);
        }
    }
    for (const ProbeMember& member : probe_members()) known.emplace(member.record);
    EXPECT_EQ(known, declared);
    EXPECT_GE(declared.size(), 12u);
}

TEST(ProbeReport, SaysWhereAMemberLies) {
    ProbeWords words = expected_probe(1);
    // SetkaRay is the first record: its size, 8 words of the argument, 8 words of the second ray in memory.
    words.layout[0] = 36;
    words.layout[4] = probe_pattern(0, 4);  // tmin, of the argument
    words.layout[9] = probe_pattern(0, 9);  // origin[0], in memory
    words.layout[10] = 0x12345678;          // origin[1], in memory
    EXPECT_THAT(
        compare_probe(words, 1).differences,
        ::testing::ElementsAre("a SetkaRay has 36 bytes instead of 32",
                               "SetkaRay.tmin of a kernel argument lies at byte 16 instead of at byte 12",
                               "SetkaRay.origin[0] in memory lies at byte 4 instead of at byte 0",
                               "SetkaRay.origin[1] in memory lies at no place of the record (it holds "
                               "0x12345678) instead of at byte 4"));
}

TEST(ProbeReport, NamesEachWorkItemBehindABarrier) {
    for (const std::uint32_t group_size : {1u, 64u}) {
        const ProbeWords right = expected_probe(group_size);
        ASSERT_EQ(right.barrier.size(), probe_barrier_groups * group_size);
        for (std::size_t i = 0; i < right.barrier.size(); ++i) {
            ProbeWords words = right;
            words.barrier[i] ^= 1;
            EXPECT_THAT(only_difference(words, group_size),
                        AllOf(HasSubstr("barriers: of "), HasSubstr(" 1 are wrong"),
                              HasSubstr("work-item " + std::to_string(i % group_size) + " of group " +
                                        std::to_string(i / group_size) + " ")));
        }
    }
}

}  // namespace
