// SPDX-License-Identifier: MIT
#include "trace/pending_image.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace setka {

namespace {

/// What may be on its way at a time: backends may need as much host memory of a kind that is scarce.
constexpr std::uint64_t most_on_the_way_bytes = std::uint64_t(128) << 20;

}  // namespace

PendingImage::Impl::Impl(const RenderOptions& options, const RenderStatistics& statistics, Fetch fetch)
    : fetch_(fetch), image_{options.width, options.height, {}, {}}, statistics_(statistics) {
    const std::size_t pixels = std::size_t(options.width) * options.height;
    if (options.pixels == Pixels::LinearAndSrgb) image_.linear.resize(pixels);
    image_.srgb.resize(3 * pixels);
}

template <typename T>
void PendingImage::Impl::add(Queue& queue, const Buffer<T>& source, std::span<T> target) {
    if (fetch_ == Fetch::Now) return queue.download(source, target);
    auto read = queue.read_later(source, target);
    reads_.push_back({std::move(read), target.size_bytes()});
    on_the_way_bytes_ += target.size_bytes();
    for (; on_the_way_bytes_ > most_on_the_way_bytes && reads_.size() > 1; reads_.pop_front()) {
        detail::wait(reads_.front().read.get());
        on_the_way_bytes_ -= reads_.front().size_bytes;
    }
}

void PendingImage::Impl::add_pixels(Queue& queue, std::uint32_t first, const Buffer<Float3>& linear,
                                    const Buffer<std::uint8_t>& codes) {
    if (!image_.linear.empty()) add(queue, linear, std::span(image_.linear).subspan(first, linear.size()));
    add(queue, codes, std::span(image_.srgb).subspan(std::size_t(first) * 3, codes.size()));
}

void PendingImage::Impl::add_shadow_rays(Queue& queue, const Buffer<std::uint32_t>& numbers) {
    if (fetch_ == Fetch::Later) return shadow_rays_.push_back(queue.download_later(numbers));
    for (const std::uint32_t n : queue.download(numbers)) statistics_.shadow_rays += n;
}

bool PendingImage::Impl::is_ready() const {
    return std::ranges::all_of(reads_, [](const Read& read) { return detail::is_ready(read.read.get()); }) &&
           std::ranges::all_of(shadow_rays_, [](const auto& numbers) { return numbers.is_ready(); });
}

Image PendingImage::Impl::take() {
    const Timer timer(statistics_.wall_ms);
    for (const Read& read : reads_) detail::wait(read.read.get());
    for (auto& numbers : shadow_rays_)
        for (const std::uint32_t n : numbers.get()) statistics_.shadow_rays += n;
    return std::move(image_);
}

PendingImage::PendingImage() noexcept = default;
PendingImage::~PendingImage() = default;
PendingImage::PendingImage(PendingImage&&) noexcept = default;
PendingImage& PendingImage::operator=(PendingImage&&) noexcept = default;
PendingImage::PendingImage(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}

bool PendingImage::is_ready() const { return !impl_ || impl_->is_ready(); }

Image PendingImage::get() {
    bool is_there = impl_ != nullptr;
    detail::take_once(is_there, "picture");
    const std::unique_ptr<Impl> impl = std::move(impl_);
    Image image = impl->take();
    statistics_ = impl->statistics();
    return image;
}

const RenderStatistics& PendingImage::statistics() const noexcept { return statistics_; }

}  // namespace setka
