// SPDX-License-Identifier: MIT
/// Where does a queue's time go? What was launched in which stage, until its time is known, and the sums of
/// each stage.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "setka/device.hpp"

namespace setka::backend {

/// Bookkeeping only: a Span is what a backend needs to learn later how long one launch took, an event or two.
template <typename Span>
class StageClock {
  public:
    /// Spans from here on count towards this stage.
    void begin_stage(std::string_view stage) {
        const auto it = std::ranges::find(stages_, stage, &StageTime::stage);
        stage_ = static_cast<std::size_t>(it - stages_.begin());
        if (it == stages_.end()) stages_.push_back({std::string(stage), 0, 0});
    }

    /// Whether spans are wanted: what measures them costs time itself.
    [[nodiscard]] bool is_running() const noexcept { return is_running_; }
    void start() noexcept { is_running_ = true; }
    void stop() noexcept { is_running_ = false; }

    void add(Span span) { pending_.push_back({stage_, std::move(span)}); }
    /// Whether it is time to collect, so that a long run does not gather events without end.
    [[nodiscard]] bool is_full() const noexcept { return pending_.size() >= max_pending; }

    /// Adds up the time of every pending span, time_ms(Span&), and forgets it.
    template <typename TimeOf>
    void collect(TimeOf time_ms) {
        collect_first(pending_.size(), time_ms);
    }
    /// The same for the older half: the newer may belong to work that nobody wants to wait for yet. wait(Span&) is called for the
    /// last of them, after which all before it have ended.
    template <typename Wait, typename TimeOf>
    void collect_older(Wait wait, TimeOf time_ms) {
        const std::size_t count = pending_.size() / 2;
        if (count == 0) return;
        wait(pending_[count - 1].span);
        collect_first(count, time_ms);
    }

    /// Time of each stage in which something was collected since the last call, in order of first use.
    [[nodiscard]] std::vector<StageTime> take_timings() {
        std::vector<StageTime> result;
        for (StageTime& stage : stages_) {
            if (stage.launches > 0) result.push_back(stage);
            stage.time_ms = 0;
            stage.launches = 0;
        }
        return result;
    }

    static constexpr std::size_t max_pending = 1024;

  private:
    struct Pending {
        std::size_t stage;
        Span span;
    };

    template <typename TimeOf>
    void collect_first(std::size_t count, TimeOf time_ms) {
        // What cannot be read is not asked for again.
        const auto end = pending_.begin() + static_cast<std::ptrdiff_t>(count);
        std::vector<Pending> taken(std::make_move_iterator(pending_.begin()), std::make_move_iterator(end));
        pending_.erase(pending_.begin(), end);
        for (Pending& pending : taken) {
            stages_[pending.stage].time_ms += time_ms(pending.span);
            ++stages_[pending.stage].launches;
        }
    }

    /// Launches before the first begin_stage are "other".
    std::vector<StageTime> stages_{{"other", 0, 0}};
    std::size_t stage_ = 0;
    std::vector<Pending> pending_;
    bool is_running_ = false;
};

}  // namespace setka::backend
