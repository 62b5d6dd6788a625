// SPDX-License-Identifier: MIT
/// Are transfers that nobody waits for right? What they bring, whether they really do not wait, and what becomes of them when
/// buffer, queue or whoever wanted them goes first.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numeric>
#include <optional>
#include <string_view>

#include "algo/scan.hpp"
#include "setka/setka.hpp"
#include "support/devices.hpp"
#include "support/scenes.hpp"
#include "support/sizes.hpp"

namespace {

using Numbers = std::vector<std::uint32_t>;
using setka::Buffer;
using setka::Download;
using setka::Queue;

Numbers numbers(std::size_t count, std::uint32_t first = 1000) {
    Numbers values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

/// Keeps a CPU busy for some hundred milliseconds and a GPU for some ten, longer than the host takes for new pages: rays against every triangle of a
/// ball, one by one.
class LongWork {
  public:
    explicit LongWork(Queue& queue)
        : scene_(queue, support::ball(support::sized(20000u, 2000u))),
          structure_(setka::BruteForce::build(queue, scene_)),
          rays_(setka::camera_rays(queue, setka::frame(support::ball(8).bounds(), 1), side_, side_)) {
        queue.finish();
    }
    [[nodiscard]] Buffer<setka::Hit> enqueue(Queue& queue) const {
        auto hits = queue.make_buffer<setka::Hit>(rays_.size(), "hits");
        const int batches = queue.device().info().type == setka::DeviceType::Gpu ? 16 : 2;
        for (int i = 0; i < batches; ++i) setka::Tracer().closest_hit(queue, structure_, rays_, hits);
        return hits;
    }

  private:
    std::uint32_t side_ = support::sized(128u, 16u);
    setka::DeviceScene scene_;
    setka::BruteForce structure_;
    Buffer<setka::Ray> rays_;
};

class DownloadLater : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(DownloadLater);

TEST_P(DownloadLater, BringsWhatDownloadBrings) {
    Queue queue = device().make_queue();
    for (const std::size_t size : {0u, 1u, 2u, 63u, 4097u, 5u << 20}) {
        const auto values = numbers(size);
        auto download = queue.download_later(queue.upload(std::span(values), "values"));
        EXPECT_EQ(download.get(), values);
        try {
            (void)download.get();
            ADD_FAILURE() << "the elements were given away twice";
        } catch (const setka::Error& error) {
            EXPECT_EQ(error.category(), setka::ErrorCategory::InvalidArgument);
            EXPECT_THAT(error.what(), ::testing::HasSubstr("each can be fetched once"));
        }
    }
    EXPECT_THROW((void)Download<int>().get(), setka::Error);
    EXPECT_TRUE(Download<int>().is_ready());
}

TEST_P(DownloadLater, BringsWhatWasThereThen) {
    Queue queue = device().make_queue();
    std::vector<Download<std::uint32_t>> downloads;
    {
        const auto buffer = queue.make_buffer<std::uint32_t>(10000, "values");
        for (std::uint32_t i = 0; i < 50; ++i) {
            const auto values = numbers(10000, i);
            queue.upload(std::span(values), buffer);
            downloads.push_back(queue.download_later(buffer));
        }
    }
    // The buffer's memory serves others at once.
    const auto other = queue.upload(std::span<const std::uint32_t>(numbers(10000, 77)), "others");
    for (std::uint32_t i = 50; i-- > 0;) EXPECT_EQ(downloads[i].get(), numbers(10000, i)) << i;
}

TEST_P(DownloadLater, IsMoved) {
    Queue queue = device().make_queue();
    const auto first = queue.upload(std::span<const std::uint32_t>(numbers(1 << 20, 1)), "first"),
               second = queue.upload(std::span<const std::uint32_t>(numbers(1 << 20, 2)), "second");
    auto a = queue.download_later(first), b = queue.download_later(second);
    a = std::move(b);  // nobody waited for the first
    EXPECT_THROW((void)b.get(), setka::Error);  // NOLINT(bugprone-use-after-move): that is the question
    Download<std::uint32_t> c = std::move(a);
    EXPECT_THROW((void)a.get(), setka::Error);  // NOLINT(bugprone-use-after-move)
    EXPECT_EQ(c.get(), numbers(1 << 20, 2));
}

TEST_P(DownloadLater, MayBeLeftAndMayOutliveItsQueue) {
    std::optional<Download<std::uint32_t>> left;
    Download<setka::Hit> behind_long_work;
    std::vector<setka::Hit> expected;
    {
        Queue queue = device().make_queue();
        const LongWork work(queue);
        expected = queue.download(work.enqueue(queue));
        for (int i = 0; i < 20; ++i) {
            const auto buffer = queue.upload(std::span<const std::uint32_t>(numbers(1 << 18)), "values");
            (void)queue.download_later(buffer);
            left = queue.download_later(buffer);
        }
        behind_long_work = queue.download_later(work.enqueue(queue));
    }
    const auto hits = behind_long_work.get();
    ASSERT_EQ(hits.size(), expected.size());
    EXPECT_EQ(std::memcmp(hits.data(), expected.data(), hits.size() * sizeof(setka::Hit)), 0);
    EXPECT_EQ(left->get(), numbers(1 << 18));
}

/// Whether `enqueue`, called after long work, comes back while that runs. A machine that stalls may let the work end before somebody
/// looks; what waits never comes back earlier.
bool comes_back_before_the_work_ends(Queue& queue, const std::function<void()>& enqueue) {
    const LongWork work(queue);
    for (int attempt = 0; attempt < 4; ++attempt) {
        auto before = queue.download_later(work.enqueue(queue));
        enqueue();
        const bool is_running = !before.is_ready();
        (void)before.get();
        if (is_running) return true;
    }
    return false;
}

/// Whether the device works while the host goes on: some drivers run what is enqueued in the thread that asks.
bool runs_beside_the_host(Queue& queue) {
    using Clock = std::chrono::steady_clock;
    const LongWork work(queue);
    const auto start = Clock::now();
    (void)work.enqueue(queue);
    const auto enqueued = Clock::now();
    queue.finish();
    return (Clock::now() - enqueued) > 4 * (enqueued - start);
}

#define SKIP_WHERE_NOTHING_RUNS_BESIDE(queue)                                                           \
    if (support::has_small_sizes()) GTEST_SKIP() << "small sizes: the work ends before somebody looks"; \
    if (!runs_beside_the_host(queue)) GTEST_SKIP() << "this driver runs nothing beside the host"

TEST_P(DownloadLater, DoesNotWait) {
    Queue queue = device().make_queue();
    SKIP_WHERE_NOTHING_RUNS_BESIDE(queue);
    const auto buffer = queue.upload(std::span<const std::uint32_t>(numbers(1 << 20)), "values");
    Download<std::uint32_t> download;
    EXPECT_TRUE(comes_back_before_the_work_ends(queue, [&] {
        download = {};
        download = queue.download_later(buffer);
    }));
    EXPECT_EQ(download.get(), numbers(1 << 20));
    EXPECT_FALSE(comes_back_before_the_work_ends(queue, [&] { (void)queue.download(buffer); })) << "this test cannot fail";
}

class UploadsOfFrames : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(UploadsOfFrames);

/// Many, of all sizes, together more than what is kept for them.
TEST_P(UploadsOfFrames, ArriveInOrderWhileTheDeviceIsBusy) {
    Queue queue = device().make_queue();
    const LongWork work(queue);
    std::vector<Buffer<std::uint32_t>> buffers;
    std::vector<Numbers> values;
    const auto busy = work.enqueue(queue);
    for (std::uint32_t i = 0; i < 120; ++i) {
        values.push_back(numbers(i % 10 == 9 ? support::sized(1u << 21, 1u << 14) + 100 * i : 1 + 97 * i, i));
        buffers.push_back(queue.make_buffer<std::uint32_t>(values.back().size(), "values"));
        auto source = values.back();
        queue.upload(std::span(std::as_const(source)), buffers.back());
        std::fill(source.begin(), source.end(), 0u);  // upload() promises to have copied
        // A target that goes before anything was written there: its memory serves the next.
        (void)queue.upload(std::span(std::as_const(source)), "nobody's");
    }
    for (std::size_t i = 0; i < buffers.size(); ++i) ASSERT_EQ(queue.download(buffers[i]), values[i]) << i;
}

TEST_P(UploadsOfFrames, DoNotWait) {
    Queue queue = device().make_queue();
    SKIP_WHERE_NOTHING_RUNS_BESIDE(queue);
    const auto values = numbers(1 << 18);
    Buffer<std::uint32_t> last;
    const char* pool = std::getenv("SETKA_POOL");
    const bool is_unchecked = !pool || std::string_view(pool) != "0" || device().info().backend == setka::Backend::Cuda;
    EXPECT_EQ(comes_back_before_the_work_ends(queue,
                                              [&] {
                                                  for (int i = 0; i < 8; ++i)
                                                      last = queue.upload(std::span(values), "values");
                                              }),
              is_unchecked)
        << "for memory checkers, and only for them, uploads wait";
    EXPECT_EQ(queue.download(last), values);
}

TEST_P(UploadsOfFrames, MayBeOnTheirWayWhenTheQueueGoes) {
    Buffer<std::uint32_t> target;
    {
        Queue queue = device().make_queue();
        const LongWork work(queue);
        (void)work.enqueue(queue);
        target = queue.upload(std::span<const std::uint32_t>(numbers(1 << 18)), "values");
    }
    Queue other = device().make_queue();
    EXPECT_EQ(other.download(target), numbers(1 << 18));
}

}  // namespace
