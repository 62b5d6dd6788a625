// SPDX-License-Identifier: MIT
/// Do the CUDA kernels round as the specification says? Reads the PTX: every operation on floats has to be
/// one of those that have a single right answer, and none may be left for the assembler to fuse.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/kernels.hpp"

namespace {

/// An instruction of a function: "mul.rn.f32" in parts, and where it stands.
struct Instruction {
    std::string function;
    std::size_t line = 0;
    std::string text;
    std::vector<std::string> parts;
};

bool contains(const std::vector<std::string>& parts, std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* word) {
        return std::find(parts.begin(), parts.end(), word) != parts.end();
    });
}

bool is_float_type(const std::string& part) {
    static const std::set<std::string> types{"f16",   "f16x2", "bf16", "bf16x2", "tf32",
                                             "f32x2", "e4m3",  "e5m2", "f32",    "f64"};
    return types.contains(part);
}

/// Whether the last operand is a number that is neither 0 nor NaN. The compiler makes a minimum or maximum of
/// `x < c ? c : x` and the like only then: it has one answer, NaN included.
bool has_plain_constant(const std::string& text) {
    const auto at = text.rfind("0f");
    if (at == std::string::npos || at + 10 > text.size()) return false;
    const auto bits =
        static_cast<std::uint32_t>(std::stoul(text.substr(at + 2, 8), nullptr, 16)) & 0x7fffffffu;
    return bits != 0 && bits <= 0x7f800000u;
}

/// Why the instruction with these parts may round otherwise elsewhere, or an empty string.
std::string objection(const std::vector<std::string>& parts, const std::string& text) {
    const std::string& name = parts.front();
    if (contains(parts, {"ftz"})) return "flushes subnormal numbers";
    if (contains(parts, {"approx", "full"})) return "is an approximation";
    static const std::set<std::string> approximations{"rsqrt", "ex2", "lg2", "sin", "cos", "tanh"};
    if (approximations.contains(name)) return "is a function of which the rounding is not pinned";
    if (std::none_of(parts.begin(), parts.end(), is_float_type)) return "";
    if (name == "fma" || name == "mad") return "is fused";
    if (contains(parts, {"f64"})) return "is in double precision, which not every device has";
    if (!contains(parts, {"f32"})) return "is not in single precision";
    static const std::set<std::string> rounding{"add", "sub", "mul", "div", "rcp", "sqrt"};
    if (rounding.contains(name)) {
        if (parts == std::vector<std::string>{name, "rn", "f32"}) return "";
        return contains(parts, {"rn"}) ? "is not plain " + name + ".rn.f32" : "may be fused: it lacks .rn";
    }
    if (name == "min" || name == "max")
        return has_plain_constant(text) ? "" : "differs from a conditional expression for NaN and -0";
    // What moves, compares or changes a sign rounds nothing. A conversion names its rounding or needs none.
    static const std::set<std::string> exact{"ld",   "st",  "mov", "selp", "setp", "set",
                                             "slct", "neg", "abs", "cvt",  "testp"};
    return exact.contains(name) ? "" : "is not among the operations that are the same everywhere";
}

/// The kernels of which the host computes the result again and compares it: they may use doubles, as strictly as any may use floats.
bool may_use_doubles(const std::string& function) { return function == "grid_resolve" || function == "grid_resolve_clear"; }

/// The same in a function.
std::string objection_in(const std::string& function, std::vector<std::string> parts, const std::string& text) {
    if (may_use_doubles(function) && contains(parts, {"f64"})) {
        if (parts.front() == "min" || parts.front() == "max") return "differs from a conditional expression for NaN and -0";
        std::replace(parts.begin(), parts.end(), std::string("f64"), std::string("f32"));
    }
    return objection(parts, text);
}

std::string trimmed(const std::string& text) {
    const auto begin = text.find_first_not_of(" \t\r");
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// "@%p1 mul.rn.f32 %f1, …;" gives {mul, rn, f32}; a label, a directive or a bracket gives nothing.
std::vector<std::string> parts_of(std::string text) {
    if (text.starts_with('@')) text = trimmed(text.substr(std::min(text.find_first_of(" \t"), text.size())));
    if (text.empty() || text.find(';') == std::string::npos ||
        !std::isalpha(static_cast<unsigned char>(text[0])))
        return {};
    std::vector<std::string> parts;
    std::istringstream words(text.substr(0, text.find_first_of(" \t;")));
    for (std::string part; std::getline(words, part, '.');)
        if (!part.empty() && !part.starts_with(':')) parts.push_back(part);
    return parts;
}

/// The registers of "min.f32 %f1, %f2, %f3;": the one that is written, and those that are read.
std::vector<std::string> registers_of(const std::string& text) {
    std::vector<std::string> registers;
    for (std::size_t at = text.find("%f"); at != std::string::npos; at = text.find("%f", at + 1))
        registers.push_back(text.substr(at, text.find_first_not_of("0123456789", at + 2) - at));
    return registers;
}

struct Ptx {
    std::set<std::string> entries;
    std::vector<Instruction> instructions;
};

/// Who reads which float register.
class Readers {
  public:
    explicit Readers(const Ptx& ptx) {
        for (const Instruction& instruction : ptx.instructions) {
            const auto registers = registers_of(instruction.text);
            const bool writes = instruction.parts[0] != "setp" && instruction.parts[0] != "st";
            for (std::size_t i = writes ? 1 : 0; i < registers.size(); ++i)
                readers_[{instruction.function, registers[i]}].push_back(&instruction);
        }
    }

    /// Whether a minimum or maximum is only compared, by itself or within another. The compiler makes `a < 0
    /// || b < 0` a comparison of the smaller one: the same for NaN, and -0 compares as 0.
    [[nodiscard]] bool only_compared(const Instruction& instruction, int depth = 0) const {
        const auto registers = registers_of(instruction.text);
        if (registers.empty() || depth > 8) return false;
        const auto found = readers_.find({instruction.function, registers[0]});
        return found != readers_.end() &&
               std::all_of(found->second.begin(), found->second.end(), [&](const Instruction* reader) {
                   const std::string& name = reader->parts[0];
                   return name == "setp" ||
                          ((name == "min" || name == "max") && only_compared(*reader, depth + 1));
               });
    }

  private:
    std::map<std::pair<std::string, std::string>, std::vector<const Instruction*>> readers_;
};

Ptx parse(std::istream& text) {
    Ptx ptx;
    std::string function;
    std::size_t number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        line = trimmed(line.substr(0, line.find("//")));
        if (const auto at = line.find(".entry "); at != std::string::npos) {
            function = trimmed(line.substr(at + 7));
            function.resize(std::min(function.find('('), function.size()));
            ptx.entries.insert(function);
        } else if (line.starts_with(".func") || line.find(" .func") != std::string::npos) {
            function = line;
        } else if (auto parts = parts_of(line); !parts.empty()) {
            ptx.instructions.push_back({function, number, line, std::move(parts)});
        }
    }
    return ptx;
}

const std::set<std::string>& kernels() {
    static const std::set<std::string> names(std::begin(setka::kernel_names), std::end(setka::kernel_names));
    return names;
}

/// Every kernel of the list is there, and no instruction of `functions` raises an objection.
template <typename IsOurs>
void expect_pinned(const Ptx& ptx, IsOurs is_ours) {
    for (const std::string& kernel : kernels())
        EXPECT_TRUE(ptx.entries.contains(kernel)) << "there is no entry " << kernel;
    const Readers readers(ptx);
    std::map<std::string, std::size_t> objections;
    std::size_t operations = 0;
    for (const Instruction& instruction : ptx.instructions) {
        if (!is_ours(instruction.function)) continue;
        operations += instruction.parts == std::vector<std::string>{"mul", "rn", "f32"};
        const std::string& name = instruction.parts[0];
        if ((name == "min" || name == "max") && readers.only_compared(instruction)) continue;
        const std::string why = objection_in(instruction.function, instruction.parts, instruction.text);
        // The first few of each kernel say it all.
        if (!why.empty() && ++objections[instruction.function] <= 5)
            ADD_FAILURE() << instruction.function << ", line " << instruction.line << ": " << instruction.text
                          << "\n  " << instruction.parts.front() << " " << why;
    }
    for (const auto& [function, count] : objections)
        std::cout << function << ": " << count << " instructions that may round otherwise elsewhere\n";
    EXPECT_GT(operations, 100u) << "too few multiplications: is this the PTX of the kernels?";
}

TEST(Ptx, ObjectionsAreRaisedWhereTheyMust) {
    const std::vector<const char*> wrong{"fma.rn.f32 %f1, %f2, %f3, %f4;",
                                         "mad.f32 %f1, %f2, %f3, %f4;",
                                         "mul.f32 %f1, %f2, %f3;",
                                         "add.f32 %f1, %f2, %f3;",
                                         "sub.f32 %f1, %f2, %f3;",
                                         "mul.rn.ftz.f32 %f1, %f2, %f3;",
                                         "setp.lt.ftz.f32 %p1, %f1, %f2;",
                                         "div.approx.f32 %f1, %f2, %f3;",
                                         "div.full.f32 %f1, %f2, %f3;",
                                         "div.rz.f32 %f1, %f2, %f3;",
                                         "sqrt.approx.f32 %f1, %f2;",
                                         "sqrt.approx.ftz.f32 %f1, %f2;",
                                         "rsqrt.approx.f32 %f1, %f2;",
                                         "rcp.f32 %f1, %f2;",
                                         "rcp.approx.ftz.f32 %f1, %f2;",
                                         "min.f32 %f1, %f2, %f3;",
                                         "max.f32 %f1, %f2, %f3;",
                                         "add.rn.f64 %fd1, %fd2, %fd3;",
                                         "cvt.f64.f32 %fd1, %f1;",
                                         "add.rn.sat.f32 %f1, %f2, %f3;",
                                         "ex2.approx.ftz.f32 %f1, %f2;",
                                         "lg2.approx.f32 %f1, %f2;",
                                         "sin.approx.f32 %f1, %f2;",
                                         "cos.approx.f32 %f1, %f2;",
                                         "atom.global.add.f32 %f1, [%rd1], %f2;",
                                         "red.global.add.f32 [%rd1], %f2;",
                                         "fma.rn.f16 %h1, %h2, %h3, %h4;",
                                         "add.rn.f32x2 %rd1, %rd2, %rd3;",
                                         "min.f32 %f1, %f2, 0f80000000;",
                                         "max.f32 %f1, %f2, 0f7FC00000;",
                                         "@%p1 fma.rn.f32 %f1, %f2, %f3, %f4;",
                                         "@!%p1\tmul.f32 %f1, %f2, %f3;"};
    for (const char* text : wrong) {
        const auto parts = parts_of(text);
        ASSERT_FALSE(parts.empty()) << text;
        EXPECT_NE(objection(parts, text), "") << text;
    }
    const std::vector<const char*> right{"mul.rn.f32 \t%f1, %f2, %f3;",
                                         "add.rn.f32 %f1, %f2, %f3;",
                                         "sub.rn.f32 %f1, %f2, %f3;",
                                         "div.rn.f32 %f1, %f2, %f3;",
                                         "sqrt.rn.f32 %f1, %f2;",
                                         "neg.f32 %f1, %f2;",
                                         "abs.f32 %f1, %f2;",
                                         "@%p1 setp.lt.f32 %p2, %f1, %f2;",
                                         "cvt.rn.f32.u32 %f1, %r1;",
                                         "cvt.rzi.s32.f32 %r1, %f1;",
                                         "ld.global.nc.f32 %f1, [%rd1];",
                                         "st.global.f32 [%rd1], %f1;",
                                         "mad.lo.s32 %r1, %r2, %r3, %r4;",
                                         "min.u32 %r1, %r2, %r3;",
                                         "ld.param::b.b32 %r1, [a];",
                                         "rcp.rn.f32 %f1, %f2;",
                                         "max.f32 %f1, %f2, 0fFF61B1E6;",
                                         "ret;",
                                         "@%p1 bra $L__BB0_2;",
                                         "atom.global.add.u32 %r1, [%rd1], %r2;"};
    for (const char* text : right) {
        const auto parts = parts_of(text);
        ASSERT_FALSE(parts.empty()) << text;
        EXPECT_EQ(objection(parts, text), "") << text;
    }
    for (const char* text : {"fma.rn.f64 %fd1, %fd2, %fd3, %fd4;", "mul.f64 %fd1, %fd2, %fd3;", "div.rz.f64 %fd1, %fd2, %fd3;",
                             "rcp.approx.ftz.f64 %fd1, %fd2;", "min.f64 %fd1, %fd2, 0d3FF0000000000000;",
                             "fma.rn.f32 %f1, %f2, %f3, %f4;"})
        EXPECT_NE(objection_in("grid_resolve", parts_of(text), text), "") << text;
    for (const char* text : {"mul.rn.f64 %fd1, %fd2, %fd3;", "div.rn.f64 %fd1, %fd2, %fd3;", "cvt.f64.f32 %fd1, %f1;",
                             "cvt.rn.f32.f64 %f1, %fd1;", "setp.lt.f64 %p1, %fd1, %fd2;"}) {
        EXPECT_EQ(objection_in("grid_resolve", parts_of(text), text), "") << text;
        EXPECT_NE(objection_in("grid_count", parts_of(text), text), "") << text;
    }
    for (const char* text : {"$L__BB0_2:", ".reg .f32 %f<20>;", "{", "}", "", ".param .u64 a"})
        EXPECT_TRUE(parts_of(text).empty()) << text;
}

TEST(Ptx, MinimaAreJudgedByWhoReadsThem) {
    std::istringstream text(R"(.visible .entry some_kernel(
{
    min.f32 %f1, %f10, %f11;
    min.f32 %f2, %f1, %f12;
    setp.lt.f32 %p1, %f2, 0f00000000;
    max.f32 %f3, %f10, %f11;
    setp.gt.f32 %p2, %f3, 0f00000000;
    st.global.f32 [%rd1], %f3;
    max.f32 %f4, %f10, %f11;
    add.rn.f32 %f5, %f4, %f4;
    max.f32 %f6, %f10, %f11;
}
)");
    const Ptx ptx = parse(text);
    const Readers readers(ptx);
    std::string compared;
    for (const Instruction& instruction : ptx.instructions)
        if (instruction.text.starts_with("m") && readers.only_compared(instruction))
            compared += registers_of(instruction.text)[0] + " ";
    EXPECT_EQ(compared, "%f1 %f2 ");
}

/// Everything in the file: functions that are not inlined count too.
TEST(Ptx, OfTheKernelsRoundsInOneWay) {
    std::ifstream file(SETKA_PTX_FILE);
    ASSERT_TRUE(file) << "cannot read " << SETKA_PTX_FILE;
    const Ptx ptx = parse(file);
    EXPECT_EQ(ptx.entries, kernels());
    expect_pinned(ptx, [](const std::string&) { return true; });
    std::cout << ptx.entries.size() << " entries, " << ptx.instructions.size() << " instructions\n";
}

/// The same of the library itself, if the toolkit is complete and the build holds PTX. CUB's kernels, which
/// have no floats to round but other names, are left out.
TEST(Ptx, InTheLibraryRoundsInOneWay) {
    const std::string tool = SETKA_CUOBJDUMP;
    if (tool.empty()) GTEST_SKIP() << "cuobjdump was not found beside nvcc";
    const std::string command = "'" + tool + "' -ptx '" SETKA_LIBRARY_FILE "' 2>&1";
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    ASSERT_TRUE(pipe) << "cannot run " << command;
    std::stringstream text;
    std::array<char, 4096> part{};
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe.get()))
        text.write(part.data(), static_cast<std::streamsize>(size));
    const Ptx ptx = parse(text);
    if (ptx.entries.empty()) {
        ASSERT_NE(text.str().find("Fatbin"), std::string::npos) << command << " printed:\n" << text.str();
        GTEST_SKIP() << "this build holds no PTX: CMAKE_CUDA_ARCHITECTURES names real architectures only";
    }
    expect_pinned(ptx, [](const std::string& function) { return kernels().contains(function); });
}

}  // namespace
