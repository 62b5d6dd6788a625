// SPDX-License-Identifier: MIT
/// Do the sources keep to the seams? No API is named above the backends, both folders of kernels hold the
/// same shells, and no compiler is allowed to round as it likes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace {

namespace fs = std::filesystem;

const fs::path root = SETKA_PROJECT_DIR;

std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::vector<fs::path> files_under(const fs::path& folder) {
    std::vector<fs::path> files;
    if (!fs::is_directory(folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// "file:line: text" of each line with `word`, ignoring case.
std::vector<std::string> lines_with(const fs::path& file, const std::string& word) {
    std::vector<std::string> found;
    std::istringstream text(read(file));
    int number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        if (lower(line).find(word) != std::string::npos)
            found.push_back(fs::relative(file, root).string() + ":" + std::to_string(number) + ": " + line);
    }
    return found;
}

TEST(Seam, NoApiAboveTheBackends) {
    std::size_t searched = 0;
    for (const char* folder : {"src/accel", "src/algo", "src/trace", "src/device", "src/scene", "src/save"})
        for (const fs::path& file : files_under(root / folder)) {
            ++searched;
            for (const char* word : {"cuda", "opencl"})
                for (const std::string& line : lines_with(file, word)) ADD_FAILURE() << line;
        }
    EXPECT_GT(searched, 10u);
}

std::map<std::string, std::string> shells(const fs::path& folder, const std::string& extension) {
    std::map<std::string, std::string> result;
    for (const fs::path& file : files_under(folder))
        if (file.extension() == extension) result[file.stem().string()] = read(file);
    return result;
}

/// A shell without the line that includes the platform, and with the folder's and extension's names made
/// equal.
std::string common_part(const std::string& text) {
    std::istringstream stream(text);
    std::string result;
    for (std::string line; std::getline(stream, line);)
        if (line.find("platform.h") == std::string::npos) result += line + "\n";
    return result;
}

TEST(Seam, BothFoldersOfKernelsHoldTheSameShells) {
    const auto opencl = shells(root / "kernels_cl", ".cl"), cuda = shells(root / "kernels_cu", ".cu");
    EXPECT_FALSE(opencl.empty());
    if (cuda.empty()) GTEST_SKIP() << "kernels_cu holds no kernels yet";
    for (const auto& [name, text] : opencl) {
        const auto twin = cuda.find(name);
        if (twin == cuda.end()) {
            ADD_FAILURE() << "kernels_cu/" << name << ".cu is missing";
            continue;
        }
        EXPECT_EQ(common_part(text), common_part(twin->second)) << name;
    }
    for (const auto& [name, text] : cuda)
        EXPECT_TRUE(opencl.contains(name)) << "kernels_cl/" << name << ".cl is missing";
}

TEST(Seam, NobodyAsksForFastMath) {
    std::vector<fs::path> files = files_under(root / "src" / "backend");
    for (const char* folder : {"src", "cmake", "tests", "bench", "kernels_cl", "kernels_cu", "scripts"})
        for (const fs::path& file : files_under(root / folder))
            if (file.filename() == "CMakeLists.txt" || file.extension() == ".cmake" ||
                file.filename() == "platform.h" || file.extension() == ".sh" || file.extension().empty())
                files.push_back(file);
    for (const char* name : {"CMakeLists.txt", "CMakePresets.json"}) files.push_back(root / name);
    const std::vector<std::string> words{"fast-math",
                                         "fast_math",
                                         "ffast",
                                         "ofast",
                                         "-cl-mad-enable",
                                         "-cl-unsafe-math",
                                         "funsafe-math",
                                         "-cl-fast-relaxed",
                                         "-cl-finite-math",
                                         "-cl-no-signed-zeros",
                                         "-cl-denorms-are-zero",
                                         "-ffp-contract=fast",
                                         "-fmad=true",
                                         "-ftz=true"};
    for (const fs::path& file : files)
        for (const std::string& word : words)
            for (const std::string& line : lines_with(file, word)) ADD_FAILURE() << line;
    EXPECT_GT(files.size(), 5u);
}

}  // namespace
