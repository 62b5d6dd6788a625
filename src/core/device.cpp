// SPDX-License-Identifier: MIT
#include "setka/device.hpp"

#include <algorithm>
#include <cctype>
#include <limits>

#include "backend/device.hpp"
#include "backend/registry.hpp"
#include "core/probe.hpp"
#include "core/settings.hpp"
#include "setka/error.hpp"

namespace setka {

const char* to_string(Backend backend) noexcept { return backend == Backend::OpenCL ? "OpenCL" : "CUDA"; }

const char* to_string(DeviceType type) noexcept {
    switch (type) {
        case DeviceType::Cpu: return "CPU";
        case DeviceType::Gpu: return "GPU";
        case DeviceType::Accelerator: return "accelerator";
        case DeviceType::Other: break;
    }
    return "other";
}

std::vector<DeviceInfo> enumerate_devices() {
    std::vector<DeviceInfo> infos;
    for (auto& entry : backend::find_devices().devices) infos.push_back(std::move(entry.info));
    return infos;
}

std::vector<std::string> enumeration_notes() { return backend::find_devices().notes; }

namespace {

std::string lower_case(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

std::string list_of(const std::vector<backend::DeviceEntry>& devices) {
    std::string list;
    for (const auto& entry : devices) list += (list.empty() ? "" : ", ") + entry.info.id + " (" + entry.info.name + ")";
    return list;
}

const backend::DeviceEntry& choose(const backend::Registry& registry, std::string_view selector) {
    const auto& devices = registry.devices;
    if (devices.empty()) {
        std::string reasons;
        for (const std::string& note : registry.notes) reasons += "; " + note;
        throw Error(ErrorCategory::Unsupported, "no device was found" + reasons);
    }
    if (selector.empty()) {
        const auto gpu = std::ranges::find(devices, DeviceType::Gpu, [](const auto& e) { return e.info.type; });
        return gpu != devices.end() ? *gpu : devices.front();
    }
    std::vector<const backend::DeviceEntry*> matches;
    for (const auto& entry : devices) {
        if (entry.info.id == selector) return entry;
        if (lower_case(entry.info.name).find(lower_case(selector)) != std::string::npos) matches.push_back(&entry);
    }
    if (matches.size() != 1)
        throw Error(ErrorCategory::InvalidArgument, "device '" + std::string(selector) + "' matches " +
                                                        (matches.empty() ? "none" : "more than one") +
                                                        " of: " + list_of(devices));
    return *matches.front();
}

[[noreturn]] void refuse(const Device& device) {
    const std::vector<std::string>& differences = device.parity().differences;
    const std::size_t more = differences.size() - 1;
    throw Error(ErrorCategory::Unsupported,
                "device " + device.info().id + " (" + device.info().name + ") is not parity-capable: " + differences[0] +
                    (more == 0 ? "" : " (and " + std::to_string(more) + " more differences)") +
                    ". Its results may differ from those of other devices; to use it all the same, set "
                    "DeviceOptions::parity to ParityRequirement::None (--parity none)");
}

}  // namespace

Device Device::open(std::string_view selector, const DeviceOptions& options) {
    const backend::Registry registry = backend::find_devices();
    if (selector.empty()) selector = settings().device;
    const Device device(choose(registry, selector).open(options));
    {
        Queue queue = device.make_queue();
        device.impl()->set_parity(run_probe(queue));
    }
    device.reset_peak_memory();
    if (options.parity == ParityRequirement::Required && !device.parity().is_capable) refuse(device);
    return device;
}

const DeviceInfo& Device::info() const noexcept { return impl_->info(); }
const DeviceOptions& Device::options() const noexcept { return impl_->options(); }
const ParityReport& Device::parity() const noexcept { return impl_->parity(); }
Queue Device::make_queue() const { return Queue(*this, impl_->make_queue()); }
std::uint64_t Device::memory_in_use_bytes() const noexcept { return impl_->in_use_bytes(); }
std::uint64_t Device::peak_memory_bytes() const noexcept { return impl_->peak_bytes(); }
void Device::reset_peak_memory() const noexcept { impl_->reset_peak(); }
std::uint64_t Device::driver_allocations() const noexcept { return impl_->driver_allocations(); }
void Device::trim() const { impl_->trim(); }

namespace {

[[noreturn]] void no_library() {
    throw Error(ErrorCategory::Internal, "a backend without a library of primitives was asked for one");
}

}  // namespace

std::uint64_t backend::Queue::library_scan_bytes(std::uint32_t) { no_library(); }
void backend::Queue::library_scan(Memory&, Memory&, Memory&, Memory&, std::uint32_t) { no_library(); }
std::uint64_t backend::Queue::library_sort_bytes(std::uint32_t, std::uint32_t) { no_library(); }
int backend::Queue::library_sort(const SortBuffers&, std::uint32_t, std::uint32_t) { no_library(); }

void backend::Queue::check_stop(std::string_view next) const {
    if (stop_token_.stop_requested())
        throw Error(ErrorCategory::Cancelled, "cancelled before " + std::string(next));
}

void backend::Device::reserve(std::uint64_t size_bytes, std::string_view name) {
    const std::uint64_t budget = options().memory_budget_bytes;
    const std::uint64_t now = in_use_bytes_ += size_bytes;
    if (now > budget && is_probed_) {
        in_use_bytes_ -= size_bytes;
        throw Error(ErrorCategory::OutOfMemory,
                    "buffer '" + std::string(name) + "' needs " + std::to_string(size_bytes) + " bytes; " +
                        std::to_string(now - size_bytes) + " of the memory budget of " + std::to_string(budget) +
                        " bytes are in use");
    }
    std::uint64_t peak = peak_bytes_;
    while (peak < now && !peak_bytes_.compare_exchange_weak(peak, now)) {
    }
}

std::shared_ptr<backend::Memory> Queue::allocate(std::size_t size, std::size_t element_bytes, std::string_view name) {
    if (size == 0) return nullptr;
    if (size > std::numeric_limits<std::size_t>::max() / element_bytes)
        throw Error(ErrorCategory::OutOfMemory, "buffer '" + std::string(name) + "' has " + std::to_string(size) +
                                                    " elements, more bytes than can be counted");
    impl_->check_stop([&] { return "allocating '" + std::string(name) + "'"; });
    return impl_->allocate(size * element_bytes, name);
}

std::shared_ptr<backend::Memory> Queue::wrap_host(void* data, std::size_t size, std::size_t element_bytes,
                                                  bool read_only, std::string_view name) {
    if (size == 0) return nullptr;
    impl_->check_stop([&] { return "wrapping '" + std::string(name) + "'"; });
    if (auto memory = impl_->wrap_host(data, size * element_bytes, read_only, name)) return memory;
    auto memory = allocate(size, element_bytes, name);
    impl_->write(*memory, 0, data, size * element_bytes);
    return memory;
}

void Queue::write(const std::shared_ptr<backend::Memory>& target, std::size_t at, const void* source,
                  std::size_t size_bytes) {
    if (size_bytes == 0) return;
    impl_->check_stop([&] { return "writing '" + target->name() + "'"; });
    impl_->write(*target, at, source, size_bytes);
}

void Queue::read(const std::shared_ptr<backend::Memory>& source, void* target, std::size_t size_bytes) {
    if (size_bytes == 0) return;
    impl_->check_stop([&] { return "reading '" + source->name() + "'"; });
    impl_->read(*source, target, size_bytes);
}

std::shared_ptr<backend::PendingRead> Queue::read_later(const std::shared_ptr<backend::Memory>& source, void* target,
                                                        std::size_t size_bytes) {
    if (size_bytes == 0) return nullptr;
    impl_->check_stop([&] { return "reading '" + source->name() + "'"; });
    return impl_->read_later(*source, target, size_bytes);
}

bool detail::is_ready(backend::PendingRead* read) { return !read || read->is_ready(); }

void detail::wait(backend::PendingRead* read) {
    if (read) read->wait();
}

void detail::take_once(bool& is_there, const char* what) {
    if (!is_there)
        throw Error(ErrorCategory::InvalidArgument,
                    std::string("get() of a ") + what + " that is empty or was fetched before; each can be fetched once");
    is_there = false;
}

void Queue::copy_bytes(const std::shared_ptr<backend::Memory>& source, std::size_t source_at,
                       const std::shared_ptr<backend::Memory>& target, std::size_t target_at, std::size_t size_bytes) {
    if (size_bytes == 0) return;
    impl_->check_stop([&] { return "copying '" + source->name() + "'"; });
    impl_->copy(*source, source_at, *target, target_at, size_bytes);
}

void Queue::check_fits(std::size_t first, std::size_t count, std::size_t capacity) {
    if (first <= capacity && count <= capacity - first) return;
    throw Error(ErrorCategory::InvalidArgument,
                "a transfer of " + std::to_string(count) + " elements" +
                    (first == 0 ? "" : " from element " + std::to_string(first) + " on") +
                    " does not fit a buffer of " + std::to_string(capacity));
}

void Queue::set_stop_token(std::stop_token token) { impl_->set_stop_token(std::move(token)); }
std::stop_token Queue::stop_token() const { return impl_->stop_token(); }
void Queue::finish() { impl_->finish(); }
std::vector<StageTime> Queue::take_timings() { return impl_->take_timings(); }
void Queue::stop_timings() { impl_->stop_timings(); }

}  // namespace setka
