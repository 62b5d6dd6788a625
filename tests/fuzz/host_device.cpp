// SPDX-License-Identifier: MIT
/// How does the host run kernels? See the header.
// The translation comes before every file of the dialect; with it kernels_cl/platform.h is empty.
#include "device/host_platform.h"
// The kernels.
#include "kernels_cl/all_hits.cl"
#include "kernels_cl/bins.cl"
#include "kernels_cl/blocks.cl"
#include "kernels_cl/grid.cl"
#include "kernels_cl/probe.cl"
#include "kernels_cl/scan.cl"
#include "kernels_cl/shade.cl"
#include "kernels_cl/sort.cl"
#include "kernels_cl/trace.cl"

#include <cstdlib>
#include <tuple>

#include "backend/device.hpp"
#include "fuzz/check.hpp"
#include "fuzz/host_device.hpp"

namespace fuzz {

namespace {

using setka::Argument;
using setka::Arguments;
using setka::Kernel;
using setka::backend::Memory;

class HostMemory final : public Memory {
  public:
    HostMemory(std::shared_ptr<setka::backend::Device> device, std::uint64_t size_bytes, std::string name)
        : Memory(size_bytes, std::move(name)), device_(std::move(device)), data_(std::malloc(size_bytes)) {
        check(data_ != nullptr, "the budget is larger than the machine");
        std::memset(data_, 0xa5, size_bytes);  // nobody may count on zeros
    }
    HostMemory(void* data, std::uint64_t size_bytes, std::string name)
        : Memory(size_bytes, std::move(name)), data_(data) {}
    ~HostMemory() override {
        if (!device_) return;
        device_->release(size_bytes());
        std::free(data_);
    }
    [[nodiscard]] void* data() const { return data_; }

  private:
    std::shared_ptr<setka::backend::Device> device_;  ///< none where the memory is somebody else's
    void* data_;
};

void* data_of(const Memory& memory) { return static_cast<const HostMemory&>(memory).data(); }

void check_size(const Memory& memory, std::uint64_t at, std::uint64_t size_bytes) {
    check(at <= memory.size_bytes() && size_bytes <= memory.size_bytes() - at,
          "a transfer beyond the end of '" + memory.name() + "'");
}

std::byte* bytes_of(const Memory& memory) { return static_cast<std::byte*>(data_of(memory)); }

template <typename T>
T value_of(const Argument& argument) {
    if constexpr (std::is_pointer_v<T>) {
        check(argument.value_bytes == 0, "a value where the kernel takes a buffer");
        return static_cast<T>(argument.memory ? data_of(*argument.memory) : nullptr);
    } else {
        check(argument.value_bytes == sizeof(T), "a value of another size than the kernel's parameter");
        T value;
        std::memcpy(&value, argument.value.data(), sizeof(T));
        return value;
    }
}

template <typename... Ts>
void run(void (*kernel)(Ts...), std::uint32_t items, const Arguments& arguments) {
    check(arguments.size() == sizeof...(Ts), "another number of arguments than the kernel's parameters");
    const auto values = [&]<std::size_t... i>(std::index_sequence<i...>) {
        return std::tuple<Ts...>(value_of<Ts>(arguments[i])...);
    }
    (std::index_sequence_for<Ts...>());
    for (sk_host_group = 0; sk_host_group < items; ++sk_host_group) std::apply(kernel, values);
}

void run(Kernel kernel, std::uint32_t items, const Arguments& arguments) {
    switch (kernel) {
#define FUZZ_RUN(name) \
    case Kernel::name: \
        return run(&::name, items, arguments);
        SETKA_KERNEL_LIST(FUZZ_RUN)
#undef FUZZ_RUN
    }
}

/// There is nothing to wait for on the host.
class ReadAlready final : public setka::backend::PendingRead {
  public:
    bool is_ready() override { return true; }
    void wait() override {}
};

class HostQueue final : public setka::backend::Queue {
  public:
    explicit HostQueue(std::shared_ptr<setka::backend::Device> device) : device_(std::move(device)) {}

    std::shared_ptr<Memory> allocate(std::uint64_t size_bytes, std::string_view name) override {
        device_->reserve(size_bytes, name);
        return std::make_shared<HostMemory>(device_, size_bytes, std::string(name));
    }
    std::shared_ptr<Memory> wrap_host(void* data, std::uint64_t size_bytes, bool,
                                      std::string_view name) override {
        return std::make_shared<HostMemory>(data, size_bytes, std::string(name));
    }
    void launch(Kernel kernel, std::uint32_t group_count, std::uint32_t group_size,
                const Arguments& arguments) override {
        check(group_size == 1, "the host has groups of one work-item");
        run(kernel, group_count, arguments);
    }
    void write(Memory& target, std::uint64_t at, const void* source, std::uint64_t size_bytes) override {
        check_size(target, at, size_bytes);
        std::memcpy(bytes_of(target) + at, source, size_bytes);
    }
    void read(Memory& source, void* target, std::uint64_t size_bytes) override {
        check_size(source, 0, size_bytes);
        if (data_of(source) != target) std::memcpy(target, data_of(source), size_bytes);
    }
    std::unique_ptr<setka::backend::PendingRead> read_later(Memory& source, void* target,
                                                            std::uint64_t size_bytes) override {
        read(source, target, size_bytes);
        return std::make_unique<ReadAlready>();
    }
    void copy(Memory& source, std::uint64_t source_at, Memory& target, std::uint64_t target_at,
              std::uint64_t size_bytes) override {
        check_size(source, source_at, size_bytes);
        write(target, target_at, bytes_of(source) + source_at, size_bytes);
    }
    void fill(Memory& target, std::uint32_t pattern, std::uint64_t size_bytes) override {
        check_size(target, 0, size_bytes);
        auto* words = static_cast<std::uint32_t*>(data_of(target));
        std::fill_n(words, size_bytes / sizeof pattern, pattern);
    }
    void finish() override {}
    void begin_stage(std::string_view) override {}
    std::vector<setka::StageTime> take_timings() override { return {}; }
    void stop_timings() override {}

  private:
    std::shared_ptr<setka::backend::Device> device_;
};

class HostDevice final : public setka::backend::Device {
  public:
    HostDevice() {
        info_.id = "host";
        info_.type = setka::DeviceType::Cpu;
        info_.name = "the host";
        info_.compute_units = info_.max_work_group_size = 1;
        info_.memory_bytes = info_.max_allocation_bytes = options_.memory_budget_bytes = memory_budget_bytes;
        info_.max_parameter_bytes = 4096;
        info_.unified_memory = true;
        options_.work_group_size = 1;
        options_.primitives = setka::PrimitiveShape::Serial;
        set_parity({true, {}});
    }
    const setka::DeviceInfo& info() const noexcept override { return info_; }
    const setka::DeviceOptions& options() const noexcept override { return options_; }
    std::uint32_t width() const noexcept override { return SK_WIDTH; }
    bool has_doubles() const noexcept override { return SK_DOUBLE != 0; }
    std::shared_ptr<setka::backend::Queue> make_queue() override {
        return std::make_shared<HostQueue>(shared_from_this());
    }
    void trim() override {}

  private:
    setka::DeviceInfo info_;
    setka::DeviceOptions options_;
};

setka::Device chosen_device() {
    const char* selector = std::getenv("SETKA_FUZZ_DEVICE");
    if (!selector || !*selector) return host_device();
    setka::DeviceOptions options;
    options.memory_budget_bytes = memory_budget_bytes;
    return setka::Device::open(selector, options);
}

}  // namespace

setka::Device host_device() { return setka::Device(std::make_shared<HostDevice>()); }

setka::Queue& queue() {
    // Never destroyed: a driver's own end comes first, and may have taken what the queue holds.
    static auto* const queue = new setka::Queue(chosen_device().make_queue());
    return *queue;
}

}  // namespace fuzz
