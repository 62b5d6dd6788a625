// SPDX-License-Identifier: MIT
#include "trace/sample_sums.hpp"

#include <span>
#include <utility>

#include "setka/error.hpp"

namespace setka {

namespace {

/// What sums may take of the memory that is free: rays, hits and colours of a batch need some 200 bytes a
/// pixel beside them.
constexpr std::uint64_t share_for_sums = 4;

bool fits(const Device& device, std::uint64_t table_bytes, std::uint64_t tables) {
    const std::uint64_t budget = device.options().memory_budget_bytes, used = device.memory_in_use_bytes();
    return table_bytes <= device.info().max_allocation_bytes && used < budget &&
           tables * table_bytes <= (budget - used) / share_for_sums;
}

}  // namespace

SampleSums::SampleSums(const Queue& queue, std::uint64_t pixels, std::uint32_t floats_per_pixel,
                       std::uint32_t passes)
    : queue_(queue),
      pixels_(pixels),
      floats_per_pixel_(floats_per_pixel),
      is_on_device_(fits(queue.device(), pixels * floats_per_pixel * sizeof(float), passes > 1 ? 2 : 1)) {}

void SampleSums::move_to_host() {
    std::vector<float> sums;
    if (has_sums_) sums = queue_.download(before_.on_device);  // this may fail; what follows may not
    is_on_device_ = false;
    before_.on_host = std::move(sums);
    before_.on_device = {};
    after_ = {};
}

/// What others have taken since the constructor looked may be missing.
void SampleSums::make_after() {
    const std::size_t size = pixels_ * floats_per_pixel_;
    if (is_on_device_ && after_.on_device.empty()) {
        try {
            after_.on_device = queue_.make_buffer<float>(size, "sample sums");
        } catch (const Error& error) {
            if (error.category() != ErrorCategory::OutOfMemory) throw;
            move_to_host();
        }
    }
    if (!is_on_device_) after_.on_host.resize(size);
}

void SampleSums::add(std::uint32_t first, std::uint32_t count, const Work& work) {
    make_after();
    if (is_on_device_)
        return work({first, has_sums_ ? before_.on_device : Buffer<float>(), after_.on_device});
    const std::size_t start = std::size_t(first) * floats_per_pixel_,
                      size = std::size_t(count) * floats_per_pixel_;
    Part part;
    if (has_sums_)
        part.before =
            queue_.upload(std::span<const float>(before_.on_host).subspan(start, size), "sample sums");
    part.after = queue_.make_buffer<float>(size, "sample sums");
    work(part);
    queue_.download(part.after, std::span(after_.on_host).subspan(start, size));
}

void SampleSums::end_pass() {
    std::swap(before_, after_);
    has_sums_ = true;
}

void SampleSums::read(std::uint32_t first, std::uint32_t count, const Work& work) {
    if (is_on_device_) return work({first, before_.on_device, {}});
    const std::size_t start = std::size_t(first) * floats_per_pixel_,
                      size = std::size_t(count) * floats_per_pixel_;
    work({0, queue_.upload(std::span<const float>(before_.on_host).subspan(start, size), "sample sums"), {}});
}

}  // namespace setka
