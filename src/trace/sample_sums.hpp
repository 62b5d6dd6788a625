// SPDX-License-Identifier: MIT
/// Where do the sums of a picture's samples lie while passes add to them? On the device, or, where a whole
/// picture of them would leave too little of it for the work, on the host.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "setka/device.hpp"

namespace setka {

/// Some floats for each pixel. A pass reads the sums that it starts from and writes others, so that one that
/// is broken off changes nothing.
class SampleSums {
  public:
    /// `passes` that are to come: the first needs no sums before it.
    SampleSums(const Queue& queue, std::uint64_t pixels, std::uint32_t floats_per_pixel,
               std::uint32_t passes);

    /// The sums of some pixels: pixel i of them has place `first` + i in `before` and `after`.
    struct Part {
        std::uint32_t first = 0;
        Buffer<float> before, after;
    };
    using Work = std::function<void(const Part&)>;

    /// Calls work(part) for pixels `first` and following; it writes part.after. The first pass has nothing
    /// before it.
    void add(std::uint32_t first, std::uint32_t count, const Work& work);
    /// What was written for all pixels becomes the sums.
    void end_pass();
    /// Calls work(part), which reads part.before.
    void read(std::uint32_t first, std::uint32_t count, const Work& work);
    /// No sums any more; what holds them is kept.
    void clear() { has_sums_ = false; }
    [[nodiscard]] bool is_on_device() const { return is_on_device_; }

  private:
    struct Table {
        Buffer<float> on_device;
        std::vector<float> on_host;
    };
    void move_to_host();
    void make_after();

    Queue queue_;
    std::uint64_t pixels_;
    std::uint32_t floats_per_pixel_;
    bool is_on_device_;
    bool has_sums_ = false;
    Table before_, after_;
};

}  // namespace setka
