// SPDX-License-Identifier: MIT
/// Does what goes into a buffer come out of it, whichever way it goes, and is what does not fit refused?
#include <gtest/gtest.h>

#include <numeric>

#include "algo/scan.hpp"
#include "setka/error.hpp"
#include "support/devices.hpp"
#include "support/sizes.hpp"

namespace {

using setka::Error;
using setka::ErrorCategory;

std::vector<std::uint32_t> numbers(std::size_t count) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), 1000u);
    return values;
}

template <typename Call>
void expect_invalid_argument(Call&& call) {
    try {
        call();
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.category(), ErrorCategory::InvalidArgument) << error.what();
    }
}

class Buffers : public support::DeviceTest {};
SETKA_ON_EVERY_DEVICE(Buffers);

TEST_P(Buffers, UploadAndDownload) {
    setka::Queue queue = device().make_queue();
    for (const std::size_t size : {0u, 1u, 2u, 63u, 4097u, 1u << 20}) {
        auto values = numbers(size);
        const auto buffer = queue.upload(std::span(std::as_const(values)), "values");
        EXPECT_EQ(buffer.size(), size);
        EXPECT_EQ(buffer.size_bytes(), 4 * size);
        const auto expected = values;
        std::fill(values.begin(), values.end(), 0u);  // upload() promises to have copied
        EXPECT_EQ(queue.download(buffer), expected);
    }
}

TEST_P(Buffers, PartsOfThem) {
    setka::Queue queue = device().make_queue();
    const auto values = numbers(100);
    const auto buffer = queue.upload(std::span(values), "values");
    const std::vector<std::uint32_t> front{7, 8, 9};
    queue.upload(std::span(front), buffer);
    std::vector<std::uint32_t> read(5);
    queue.download(buffer, std::span(read));
    EXPECT_EQ(read, (std::vector<std::uint32_t>{7, 8, 9, 1003, 1004}));
}

TEST_P(Buffers, WhatDoesNotFitIsRefused) {
    setka::Queue queue = device().make_queue();
    const auto buffer = queue.upload(std::span<const std::uint32_t>(numbers(4)), "values");
    const auto five = numbers(5);
    expect_invalid_argument([&] { queue.upload(std::span(five), buffer); });
    std::vector<std::uint32_t> target(5);
    expect_invalid_argument([&] { queue.download(buffer, std::span(target)); });
    EXPECT_EQ(queue.download(buffer), numbers(4));
}

TEST_P(Buffers, WrappedMemoryIsReadInPlaceOrCopied) {
    setka::Queue queue = device().make_queue();
    const std::vector<std::uint32_t> counts(1000, 2);
    const auto wrapped = queue.wrap(std::span(counts), "counts");
    EXPECT_EQ(wrapped.size(), counts.size());
    const auto offsets = queue.make_buffer<std::uint32_t>(1001, "offsets");
    EXPECT_EQ(setka::exclusive_scan(queue, wrapped, 1000, offsets), 2000u);
    EXPECT_EQ(queue.download(offsets)[999], 1998u);
    EXPECT_EQ(queue.download(wrapped), counts);
}

TEST_P(Buffers, WrappedMemoryIsWrittenInPlaceOrReadBack) {
    setka::Queue queue = device().make_queue();
    const std::vector<std::uint32_t> counts(1000, 3);
    std::vector<std::uint32_t> storage(1001, 77);
    const auto wrapped = queue.wrap(std::span(storage), "offsets");
    EXPECT_EQ(setka::exclusive_scan(queue, queue.upload(std::span(counts), "counts"), 1000, wrapped), 3000u);
    queue.download(wrapped, std::span(storage));  // onto the very memory that it wraps
    for (std::uint32_t i = 0; i <= 1000; ++i) ASSERT_EQ(storage[i], 3 * i);
}

TEST_P(Buffers, UnalignedMemoryCanBeWrapped) {
    setka::Queue queue = device().make_queue();
    const std::size_t count = support::sized<std::size_t>(1001, 65);
    std::vector<std::uint32_t> storage(count, 1);
    for (std::size_t first = 0; first < 20; ++first) {
        const std::span<const std::uint32_t> part(storage.data() + first, count - first);
        const auto size = static_cast<std::uint32_t>(part.size());
        const auto offsets = queue.make_buffer<std::uint32_t>(size + 1, "offsets");
        EXPECT_EQ(setka::exclusive_scan(queue, queue.wrap(part, "part"), size, offsets), size);
    }
}

TEST_P(Buffers, CopiesShareTheMemory) {
    setka::Queue queue = device().make_queue();
    const auto buffer = queue.upload(std::span<const std::uint32_t>(numbers(3)), "values");
    const auto copy = buffer;
    const std::vector<std::uint32_t> other{1, 2, 3};
    queue.upload(std::span(other), copy);
    EXPECT_EQ(queue.download(buffer), other);
}

}  // namespace
