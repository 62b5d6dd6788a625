// SPDX-License-Identifier: MIT
/// Is a device refused whose driver relaxes the arithmetic, and can it be used on request? PoCL adds what
/// POCL_EXTRA_BUILD_FLAGS holds to the options of every program. Drivers read their settings when they start:
/// each case runs in a process of its own, with an empty kernel cache.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "algo/scan.hpp"
#include "setka/device.hpp"
#include "setka/error.hpp"

namespace {

using ::testing::HasSubstr;

/// What `work` returns in a child process that sees these settings; the child must not have met a driver
/// before.
std::string in_child(const std::string& flags, const std::function<std::string()>& work) {
    std::string cache = (std::filesystem::temp_directory_path() / "setka-probe-XXXXXX").string();
    if (!::mkdtemp(cache.data())) throw std::runtime_error("no folder for the kernel cache");
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    const pid_t child = ::fork();
    if (child == 0) {
        ::setenv("POCL_EXTRA_BUILD_FLAGS", flags.c_str(), 1);
        ::setenv("POCL_CACHE_DIR", cache.c_str(), 1);
        std::string text;
        try {
            text = work();
        } catch (const std::exception& error) {
            text = std::string("exception: ") + error.what();
        }
        const bool is_written =
            ::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
        ::_exit(is_written ? 0 : 1);
    }
    ::close(ends[1]);
    std::string text;
    std::array<char, 4096> part{};
    for (ssize_t n; (n = ::read(ends[0], part.data(), part.size())) > 0;)
        text.append(part.data(), std::size_t(n));
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    std::filesystem::remove_all(cache);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0
               ? text
               : text + "\nthe child ended with status " + std::to_string(status);
}

/// The id of PoCL's device, or an empty string.
std::string pocl_device() {
    for (const setka::DeviceInfo& info : setka::enumerate_devices())
        if (info.platform.find("PoCL") != std::string::npos || info.platform.find("Portable Computing") == 0)
            return info.id;
    return {};
}

/// Opens the device as required and as requested, and uses it.
std::string try_device() {
    const std::string id = pocl_device();
    if (id.empty()) return "no PoCL device";
    std::string text;
    try {
        (void)setka::Device::open(id);
        text += "accepted\n";
    } catch (const setka::Error& error) {
        text += std::string("refused (") + setka::to_string(error.category()) + "): " + error.what() + "\n";
    }
    const setka::Device device = setka::Device::open(id, {.parity = setka::ParityRequirement::None});
    text += device.parity().is_capable ? "capable\n" : "not capable\n";
    for (const std::string& difference : device.parity().differences)
        text += "difference: " + difference + "\n";
    setka::Queue queue = device.make_queue();
    const std::vector<std::uint32_t> counts(1000, 3);
    const auto offsets = queue.make_buffer<std::uint32_t>(counts.size() + 1, "offsets");
    const auto total = setka::exclusive_scan(queue, queue.upload(std::span(counts), "counts"), 1000, offsets);
    return text + (total == 3000 ? "usable\n" : "wrong sum\n");
}

struct Case {
    std::string name, flags;
    std::vector<std::string> differences;  ///< how sentences about it begin; none if the device stays capable
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.flags; }

class RelaxedDriver : public ::testing::TestWithParam<Case> {};

TEST_P(RelaxedDriver, IsRefusedUnlessAskedFor) {
    const std::string text = in_child(GetParam().flags, try_device);
    if (text == "no PoCL device") GTEST_SKIP() << text;
    EXPECT_THAT(text, HasSubstr("usable\n"));
    if (GetParam().differences.empty()) {
        EXPECT_THAT(text, HasSubstr("accepted\ncapable\n"));
        return;
    }
    EXPECT_THAT(text, ::testing::StartsWith("refused (unsupported): device opencl:"));
    const std::string mark = "\ndifference: ";
    const std::size_t first = text.find(mark);
    ASSERT_NE(first, std::string::npos) << text;
    const std::size_t start = first + mark.size();
    EXPECT_THAT(text,
                HasSubstr("is not parity-capable: " + text.substr(start, text.find('\n', start) - start)));
    EXPECT_THAT(text, HasSubstr("set DeviceOptions::parity to ParityRequirement::None"));
    EXPECT_THAT(text, HasSubstr("\nnot capable\n"));
    for (const std::string& difference : GetParam().differences)
        EXPECT_THAT(text, HasSubstr("\ndifference: " + difference + " with "));
}

const Case cases[] = {
    {"as_it_is", "", {}},
    {"subnormals_flushed", "-cl-denorms-are-zero", {"a * c + b", "a * b", "c * 2^-20", "d * 2^30"}},
    {"relaxed", "-cl-fast-relaxed-math", {"(a + c) - a", "comparisons of a and b", "accurate a * b - c * d"}},
    {"unsafe",
     "-cl-unsafe-math-optimizations",
     {"(a + c) - a", "4097 * d - (4097 * d - d)", "accurate a * b - c * d"}},
    {"no_nan", "-cl-finite-math-only", {"comparisons of a and b"}},
    {"no_negative_zero", "-cl-no-signed-zeros", {"4097 * d - (4097 * d - d)", "low end of edge (a, b) - (c, d)"}},
};
INSTANTIATE_TEST_SUITE_P(Pocl, RelaxedDriver, ::testing::ValuesIn(cases),
                         [](const auto& test) { return test.param.name; });

}  // namespace
