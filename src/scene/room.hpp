// SPDX-License-Identifier: MIT
/// Where in a table is there room? Ranges of its elements are taken and given back; neighbours that are free become one.
#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <new>
#include <optional>

namespace setka {

struct Range {
    std::uint64_t first = 0, size = 0;
};

class Room {
  public:
    [[nodiscard]] std::uint64_t capacity() const noexcept { return capacity_; }
    [[nodiscard]] std::uint64_t taken() const noexcept { return taken_; }

    /// The first free range that is large enough, cut to size; nothing if there is none. An empty one is always there.
    [[nodiscard]] std::optional<Range> take(std::uint64_t size) {
        if (size == 0) return Range{};
        for (auto it = free_.begin(); it != free_.end(); ++it) {
            if (it->second < size) continue;
            const Range range{it->first, size};
            const std::uint64_t rest = it->second - size;
            // The node becomes the rest's, so that nothing is allocated and nothing can fail.
            auto node = free_.extract(it);
            if (rest > 0) {
                node.key() = range.first + size;
                node.mapped() = rest;
                free_.insert(std::move(node));
            }
            taken_ += size;
            return range;
        }
        return std::nullopt;
    }

    /// Where the host has no memory to remember it, the range is lost.
    void give(const Range& range) noexcept {
        if (range.size == 0) return;
        try {
            insert(range);
            taken_ -= range.size;
        } catch (const std::bad_alloc&) {
        }
    }

    void grow(std::uint64_t capacity) {
        insert({capacity_, capacity - capacity_});
        capacity_ = capacity;
    }

  private:
    void insert(const Range& range) {
        auto it = free_.emplace(range.first, range.size).first;
        if (const auto next = std::next(it); next != free_.end() && range.first + range.size == next->first) {
            it->second += next->second;
            free_.erase(next);
        }
        if (it == free_.begin()) return;
        if (const auto before = std::prev(it); before->first + before->second == it->first) {
            before->second += it->second;
            free_.erase(it);
        }
    }

    std::map<std::uint64_t, std::uint64_t> free_;  ///< by their first element, their sizes
    std::uint64_t capacity_ = 0, taken_ = 0;
};

}  // namespace setka
