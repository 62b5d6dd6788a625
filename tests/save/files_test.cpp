// SPDX-License-Identifier: MIT
/// Do files come about completely or not at all, and does every failure say why?
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "save/file_maker.hpp"
#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"

namespace {

using namespace save_test;
using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A new folder that everybody may enter, removed with everything in it.
class Folder {
  public:
    Folder() {
        std::string pattern = (fs::temp_directory_path() / "setka-save-XXXXXX").string();
        if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
        path_ = pattern;
        ::chmod(pattern.c_str(), 0755);
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }
    [[nodiscard]] const fs::path& path() const { return path_; }
    [[nodiscard]] std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(path_), {}); }

  private:
    fs::path path_;
};

/// For its lifetime permissions count, also for root.
class OrdinaryUser {
  public:
    OrdinaryUser() { is_changed_ = ::geteuid() == 0 && ::seteuid(65534) == 0; }
    ~OrdinaryUser() {
        if (is_changed_ && ::seteuid(0) != 0) std::abort();
    }
    OrdinaryUser(const OrdinaryUser&) = delete;
    OrdinaryUser& operator=(const OrdinaryUser&) = delete;

  private:
    bool is_changed_ = false;
};

/// For its lifetime no file grows beyond this: writing fails in the middle, as on a full disk.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

template <typename Action>
std::string error(setka::ErrorCategory category, const Action& action) {
    try {
        action();
    } catch (const setka::Error& e) {
        EXPECT_EQ(e.category(), category) << e.what();
        EXPECT_THAT(e.what(), ::testing::Not(HasSubstr("\n")));
        return e.what();
    }
    return "no error";
}

void write(const fs::path& file, std::span<const std::byte> bytes) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}
Bytes read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

std::string inspect_error(const fs::path& file,
                          setka::ErrorCategory category = setka::ErrorCategory::InvalidData) {
    return error(category, [&] { (void)setka::inspect(file); });
}

TEST(InputFiles, ThatCannotBeReadSayWhy) {
    const Folder folder;
    EXPECT_THAT(inspect_error(folder / "none.setka"),
                AllOf(HasSubstr("none.setka"), HasSubstr("no such file")));
    EXPECT_THAT(inspect_error(folder.path()), HasSubstr("directory"));
    write(folder / "empty.setka", {});
    EXPECT_THAT(inspect_error(folder / "empty.setka"), HasSubstr("empty"));
    ASSERT_EQ(::mkfifo((folder / "pipe.setka").c_str(), 0600), 0);
    EXPECT_THAT(inspect_error(folder / "pipe.setka"), HasSubstr("not a regular file"));
    EXPECT_THAT(inspect_error("/dev/zero"), HasSubstr("not a regular file"));
    write(folder / "secret.setka", file_of(model_of(small_scene())));
    ASSERT_EQ(::chmod((folder / "secret.setka").c_str(), 0), 0);
    const OrdinaryUser user;
    EXPECT_THAT(inspect_error(folder / "secret.setka"),
                AllOf(HasSubstr("secret.setka"), HasSubstr("Permission denied")));
}

TEST(InputFiles, AreNamedInEveryRefusal) {
    const Folder folder;
    const Bytes sound = file_of(model_of(small_scene()));
    write(folder / "sound.setka", sound);
    EXPECT_TRUE(setka::inspect(folder / "sound.setka").violations.empty());
    Bytes newer = sound;
    newer[8] = std::byte{9};
    write(folder / "newer.setka", newer);
    EXPECT_THAT(inspect_error(folder / "newer.setka", setka::ErrorCategory::Unsupported),
                AllOf(HasSubstr("newer.setka"), HasSubstr("version 9")));
    write(folder / "cut.setka", std::span(sound).first(sound.size() - 1));
    EXPECT_THAT(setka::inspect(folder / "cut.setka").violations,
                ::testing::ElementsAre(HasSubstr("truncated")));
}

/// A terabyte that is no file of setka is refused by its first bytes, not read.
TEST(InputFiles, ThatAreForeignAreNotRead) {
    const Folder folder;
    write(folder / "film.mkv", std::as_bytes(std::span("not this")));
    std::error_code cannot;
    fs::resize_file(folder / "film.mkv", std::uintmax_t(1) << 40, cannot);
    if (cannot) GTEST_SKIP() << "no sparse file of a terabyte here: " << cannot.message();
    EXPECT_THAT(inspect_error(folder / "film.mkv"), HasSubstr("not a file that setka saved"));
}

class OutputFiles : public support::DeviceTest {
  protected:
    void SetUp() override {
        support::DeviceTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        queue_.emplace(device().make_queue());
        grid_.emplace(setka::make_grid_builder()->build(
            *queue_, setka::DeviceScene(*queue_, support::find_scene("built_in_sphere").make())));
    }
    [[nodiscard]] std::string save_error(const fs::path& file) {
        return error(setka::ErrorCategory::InvalidArgument, [&] { setka::save(*queue_, *grid_, file); });
    }
    std::optional<setka::Queue> queue_;
    std::optional<setka::Grid> grid_;
};
SETKA_ON_EVERY_DEVICE(OutputFiles);

TEST_P(OutputFiles, HoldTheSerializedGrid) {
    const Folder folder;
    const fs::path file = folder / "grid.setka";
    write(file, std::as_bytes(std::span("an older file")));
    setka::save(*queue_, *grid_, file);
    EXPECT_EQ(read(file), setka::serialize(*queue_, *grid_));
    EXPECT_EQ(folder.entries(), 1);
    EXPECT_EQ(setka::load_grid(*queue_, file).digest(*queue_), grid_->digest(*queue_));
    EXPECT_THAT(
        error(setka::ErrorCategory::InvalidData, [&] { (void)setka::load_grid(*queue_, folder / "none"); }),
        HasSubstr("no such file"));
    fs::resize_file(file, 1000);
    EXPECT_THAT(error(setka::ErrorCategory::InvalidData, [&] { (void)setka::load_grid(*queue_, file); }),
                AllOf(HasSubstr("grid.setka"), HasSubstr("truncated")));
}

TEST_P(OutputFiles, ThatCannotBeWrittenLeaveNothingBehind) {
    const Folder folder;
    EXPECT_THAT(save_error(folder / "none/grid.setka"), HasSubstr("no directory"));
    EXPECT_THAT(save_error(folder.path()), HasSubstr("directory"));
    EXPECT_THAT(save_error("/dev/full"), HasSubstr("not a regular file"));
    {
        ASSERT_EQ(::mkdir((folder / "locked").c_str(), 0555), 0);
        // The build of the grid may not be done yet, and a driver that compiles under another user misses its cache.
        queue_->finish();
        const OrdinaryUser user;
        EXPECT_THAT(save_error(folder / "locked/grid.setka"),
                    AllOf(HasSubstr("locked/grid.setka"), HasSubstr("Permission denied")));
    }
    EXPECT_TRUE(fs::is_empty(folder / "locked"));
    EXPECT_EQ(folder.entries(), 1);
}

TEST_P(OutputFiles, ThatDoNotFitLeaveTheOldOne) {
    const Folder folder;
    const Bytes old{std::byte{1}, std::byte{2}};
    write(folder / "old.setka", old);
    for (const rlim_t room : {0, 1000, 100000}) {
        ASSERT_GT(setka::serialize(*queue_, *grid_).size(), room);
        const FileSizeLimit limit(room);
        EXPECT_THAT(save_error(folder / "old.setka"),
                    AllOf(HasSubstr("old.setka"), HasSubstr("File too large")));
        EXPECT_THAT(save_error(folder / "new.setka"), HasSubstr("File too large"));
    }
    EXPECT_EQ(read(folder / "old.setka"), old);
    EXPECT_EQ(folder.entries(), 1);
}

}  // namespace
