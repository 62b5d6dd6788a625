// SPDX-License-Identifier: MIT
/// What is left of a file whose saving fails or is cancelled? Nothing, or the file that was there before.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "faults/faulty_queue.hpp"
#include "faults/work.hpp"
#include "support/devices.hpp"

namespace {

namespace fs = std::filesystem;
using faults::Step;
using setka::ErrorCategory;

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class Saving : public support::DeviceTest {
  protected:
    Saving() { fs::create_directories(folder_); }
    ~Saving() override {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }

    /// What save() throws.
    std::optional<setka::Error> save_error(setka::Queue& queue, const setka::Grid& grid) const {
        try {
            setka::save(queue, grid, file_);
        } catch (const setka::Error& error) {
            return error;
        }
        return std::nullopt;
    }

    /// Files in the folder.
    [[nodiscard]] std::ptrdiff_t file_count() const {
        return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
    }

    fs::path folder_ = fs::path(::testing::TempDir()) /
                       ("setka-saving-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
                        "-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)));
    fs::path file_ = folder_ / "grid.setka";
};
SETKA_ON_EVERY_DEVICE(Saving);

TEST_P(Saving, LeavesNothingWhereATransferFails) {
    const auto [steps, made] = faults::make_faulty_queue(device());
    setka::Queue queue = made;
    const faults::World world(queue);
    std::uint32_t number = 1;
    for (;; ++number) {
        steps->fail(Step::Read, number);
        const auto error = save_error(queue, world.grid);
        steps->heal();
        if (!steps->has_failed()) break;
        ASSERT_TRUE(error) << number;
        EXPECT_EQ(error->category(), ErrorCategory::DeviceFailed);
        EXPECT_EQ(file_count(), 0) << number;
    }
    EXPECT_GT(number, 5u);
    const std::string saved = content_of(file_);
    EXPECT_EQ(saved.size(), world.saved.size());
    steps->fail(Step::Read, 1);
    EXPECT_TRUE(save_error(queue, world.grid));
    EXPECT_EQ(file_count(), 1);
    EXPECT_TRUE(content_of(file_) == saved) << "the file that was there is not what it was";
}

TEST_P(Saving, LeavesNothingWhereItIsCancelled) {
    const auto [steps, made] = faults::make_faulty_queue(device());
    setka::Queue queue = made;
    const faults::World world(queue);
    std::uint32_t number = 1;
    for (;; ++number) {  // the last is the last transfer: only writing is left
        std::stop_source stop;
        queue.set_stop_token(stop.get_token());
        steps->before(Step::Read, number, [&] { stop.request_stop(); });
        const auto error = save_error(queue, world.grid);
        steps->heal();
        if (!steps->has_failed()) break;
        ASSERT_TRUE(error) << number;
        EXPECT_EQ(error->category(), ErrorCategory::Cancelled);
        EXPECT_EQ(file_count(), 0) << number;
    }
    EXPECT_GT(number, 5u);
    EXPECT_EQ(content_of(file_).size(), world.saved.size());
}

}  // namespace
