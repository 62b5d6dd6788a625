// SPDX-License-Identifier: MIT
/// What do benchmarks work on? Something on a device that is made and checked once, serves the benchmarks
/// that follow one another, and is gone before the next is made.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "setka/error.hpp"

namespace setka::bench {

class Fixture {
  public:
    virtual ~Fixture() = default;
};

class FixtureSlot {
  public:
    /// The fixture of this key, made by `make` unless it is still here. What making it threw is thrown again
    /// next time.
    template <typename T>
    [[nodiscard]] T& get(const std::string& key, const std::function<std::unique_ptr<T>()>& make) {
        if (key != key_) {
            fixture_.reset();
            failure_.reset();
            key_ = key;
            try {
                fixture_ = make();
            } catch (const Error& error) {
                failure_ = error;
            }
        }
        if (failure_) throw *failure_;
        return static_cast<T&>(*fixture_);
    }

  private:
    std::string key_;
    std::unique_ptr<Fixture> fixture_;
    std::optional<Error> failure_;
};

}  // namespace setka::bench
