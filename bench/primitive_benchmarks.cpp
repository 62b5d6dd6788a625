// SPDX-License-Identifier: MIT
/// How fast are the primitives? Scan and sort of random input, compared with std:: before they are timed.
#include <algorithm>
#include <bit>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "algo/scan.hpp"
#include "algo/sort.hpp"
#include "backend/device.hpp"
#include "bench/benchmarks.hpp"
#include "bench/timing.hpp"
#include "workload/random_rays.hpp"

namespace setka::bench {

namespace {

constexpr std::uint64_t seed = 2012;
constexpr std::uint64_t word = sizeof(std::uint32_t);

/// One primitive over n elements with its input on a device. The constructors of those derived check the
/// result.
class Primitive : public Fixture {
  public:
    Primitive(Target& target, std::uint32_t n)
        : n_(n), name_(target.name()), queue_(target.device().make_queue()) {}

    [[nodiscard]] Queue& queue() noexcept { return queue_; }
    [[nodiscard]] virtual Work work() const = 0;
    virtual void prepare() {}
    virtual void run() = 0;

  protected:
    void require(bool is_equal, const char* what, const char* expected) const {
        if (!is_equal)
            throw Mismatch(std::string(what) + " of " + std::to_string(n_) + " elements on " + name_ +
                           " differs from " + expected + "; it is not timed");
    }

    const std::uint32_t n_;

  private:
    std::string name_;

  protected:
    Queue queue_;
};

class Scan final : public Primitive {
  public:
    Scan(Target& target, std::uint32_t n) : Primitive(target, n) {
        workload::Random random(seed);
        std::vector<std::uint32_t> counts(n), expected(std::size_t(n) + 1);
        std::ranges::generate(counts, [&] { return random.below(8); });
        std::exclusive_scan(counts.begin(), counts.end(), expected.begin(), 0u);
        expected[n] = expected[n - 1] + counts[n - 1];
        counts_ = queue_.upload(std::span(counts), "counts");
        offsets_ = queue_.make_buffer<std::uint32_t>(expected.size(), "offsets");
        run();
        require(queue_.download(offsets_) == expected, "scan", "std::exclusive_scan");
    }
    [[nodiscard]] Work work() const override {
        return {"Melem/s", millions(n_), (2 * std::uint64_t(n_) + 1) * word};
    }
    void run() override {
        queue_.impl().begin_stage("scan");
        (void)enqueue_exclusive_scan(queue_, counts_, n_, offsets_);
    }

  private:
    Buffer<std::uint32_t> counts_, offsets_;
};

class Sort final : public Primitive {
  public:
    Sort(Target& target, std::uint32_t n) : Primitive(target, n) {
        workload::Random random(seed);
        std::vector<std::uint32_t> keys(n), values(n);
        std::ranges::generate(keys, [&] { return random.below(n_); });
        std::iota(values.begin(), values.end(), 0u);
        source_keys_ = queue_.upload(std::span(keys), "source keys");
        source_values_ = queue_.upload(std::span(values), "source values");
        keys_ = queue_.make_buffer<std::uint32_t>(n, "keys");
        values_ = queue_.make_buffer<std::uint32_t>(n, "values");
        prepare();
        run();
        std::ranges::stable_sort(values, {}, [&](std::uint32_t value) { return keys[value]; });
        const std::vector<std::uint32_t> unsorted = keys;
        std::ranges::transform(values, keys.begin(), [&](std::uint32_t value) { return unsorted[value]; });
        require(queue_.download(keys_) == keys && queue_.download(values_) == values, "sort",
                "std::stable_sort");
    }
    [[nodiscard]] Work work() const override {
        return {"Melem/s", millions(n_), 4 * std::uint64_t(n_) * word};
    }
    /// Sorting what is sorted already would be another, easier task.
    void prepare() override {
        queue_.impl().copy(*source_keys_.memory(), 0, *keys_.memory(), 0, keys_.size_bytes());
        queue_.impl().copy(*source_values_.memory(), 0, *values_.memory(), 0, values_.size_bytes());
    }
    void run() override {
        queue_.impl().begin_stage("sort");
        stable_sort_pairs(queue_, keys_, values_, n_, static_cast<std::uint32_t>(std::bit_width(n_ - 1)));
    }

  private:
    Buffer<std::uint32_t> source_keys_, source_values_, keys_, values_;
};

template <typename T>
void register_primitive(Bench& bench, Target& target, const char* kind, std::uint32_t n) {
    const std::string name = std::string(kind) + '/' + std::to_string(n) + '/' + target.name();
    add_benchmark(name, [&bench, &target, n, name](benchmark::State& state) {
        Primitive& primitive =
            bench.slot.get<Primitive>(name, [&] { return std::make_unique<T>(target, n); });
        time_work(
            state, primitive.queue(), primitive.work(), [&] { primitive.run(); },
            [&] { primitive.prepare(); });
    });
}

}  // namespace

void register_primitives(Bench& bench) {
    for (const std::uint32_t n : bench.options.elements)
        for (Target& target : bench.targets) {
            register_primitive<Scan>(bench, target, "scan", n);
            register_primitive<Sort>(bench, target, "sort", n);
        }
}

}  // namespace setka::bench
