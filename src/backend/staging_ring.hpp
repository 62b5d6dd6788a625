// SPDX-License-Identifier: MIT
/// Where does what the host writes wait for the device? In places of one piece of memory, given out and taken back in the queue's order.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

namespace setka::backend {

/// Bookkeeping only: an Event is what a backend needs to learn that the device has read a place. Places are reused when it has.
template <typename Event>
class StagingRing {
  public:
    explicit StagingRing(std::size_t capacity) : capacity_(capacity) {}

    [[nodiscard]] bool empty() const noexcept { return places_.empty(); }

    /// Calls enqueue(place) for a place with `size` bytes, at most the capacity; what it returns is the place's event. Forgets what
    /// has_ended(event), and calls wait(event) for the oldest as long as there is no room.
    template <typename HasEnded, typename Wait, typename Enqueue>
    void use(std::size_t size, const HasEnded& has_ended, const Wait& wait, const Enqueue& enqueue) {
        retire(has_ended);
        size = (size + alignment - 1) / alignment * alignment;
        std::optional<std::size_t> begin = find(size);
        for (; !begin; begin = find(size)) wait(take_oldest());
        Place& place = places_.emplace_back(Place{*begin, *begin + size, Event()});
        try {
            place.event = enqueue(*begin);
        } catch (...) {
            places_.pop_back();
            throw;
        }
    }

    /// Forgets the oldest as long as has_ended(event). One for which that throws is forgotten, too.
    template <typename HasEnded>
    void retire(const HasEnded& has_ended) {
        while (!places_.empty()) {
            bool is_over = true;
            try {
                is_over = has_ended(places_.front().event);
            } catch (...) {
                places_.pop_front();
                throw;
            }
            if (!is_over) return;
            places_.pop_front();
        }
    }

    static constexpr std::size_t alignment = 256;

  private:
    struct Place {
        std::size_t begin, end;
        Event event;
    };

    [[nodiscard]] Event take_oldest() {
        Event event = std::move(places_.front().event);
        places_.pop_front();
        return event;
    }

    /// The start of `size` bytes behind the newest place, or before the oldest.
    [[nodiscard]] std::optional<std::size_t> find(std::size_t size) const {
        if (places_.empty()) return 0;
        const std::size_t oldest = places_.front().begin, end = places_.back().end;
        const bool has_turned = places_.back().begin < oldest;
        if (has_turned) return oldest - end >= size ? std::optional(end) : std::nullopt;
        if (capacity_ - end >= size) return end;
        return oldest >= size ? std::optional<std::size_t>(0) : std::nullopt;
    }

    std::size_t capacity_;
    std::deque<Place> places_;
};

}  // namespace setka::backend
