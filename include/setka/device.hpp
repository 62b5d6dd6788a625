// SPDX-License-Identifier: MIT
/// Where does the work run? Devices of every backend in one list, an in-order queue on a device, and typed buffers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace setka {

namespace backend {  // the seam of the library's inside; opaque to users
class Device;
class Memory;
class PendingRead;
class Queue;
}  // namespace backend

enum class Backend { OpenCL, Cuda };
enum class DeviceType { Cpu, Gpu, Accelerator, Other };

[[nodiscard]] const char* to_string(Backend backend) noexcept;
[[nodiscard]] const char* to_string(DeviceType type) noexcept;

/// What a device says of itself. None of it influences what a table, a hit or a picture contains.
struct DeviceInfo {
    std::string id;        ///< what Device::open takes: "opencl:0", …
    Backend backend = Backend::OpenCL;
    DeviceType type = DeviceType::Other;
    std::string name;
    std::string vendor;
    std::string platform;  ///< the driver's platform with its version
    std::string driver;    ///< the driver's version
    std::uint32_t compute_units = 0;
    std::uint32_t max_work_group_size = 0;
    std::uint64_t memory_bytes = 0;
    std::uint64_t max_allocation_bytes = 0;
    std::uint64_t local_memory_bytes = 0;
    std::uint64_t max_parameter_bytes = 0;
    bool unified_memory = false;                ///< host and device share memory: host buffers are used in place
    /// What the driver states of itself; what it does is in Device::parity().
    bool correctly_rounded_divide_sqrt = false;
};

/// Every usable device of every backend, in a stable order. A missing driver means fewer devices, never an error.
[[nodiscard]] std::vector<DeviceInfo> enumerate_devices();

/// Why backends or devices are missing from enumerate_devices(), one sentence each; empty if nothing is missing.
[[nodiscard]] std::vector<std::string> enumeration_notes();

/// How scans, sorts and the bounds of a scene are done on the device, and how much one work-item does. It never changes a result.
enum class PrimitiveShape {
    Auto,      ///< Library where the backend has one, else Portable
    Library,   ///< the vendor's library for scan and sort: CUB on CUDA; Unsupported elsewhere
    Portable,  ///< setka's own kernels: Serial on a CPU, Group elsewhere
    Serial,    ///< one work-item a group over a long run: fastest on CPUs, no barrier ever waits
    Group,     ///< groups of work-items with local memory: for GPUs
};

/// Whether a device computes as every other one does: checked when it is opened, by putting some hundred operands through
/// the kernels' own arithmetic, every record that host and device share, and a barrier.
struct ParityReport {
    bool is_capable = false;
    /// One sentence each; empty if capable. The expression, its operands, what the device gives and what is right; or a
    /// record's member and where it lies; or a barrier that lets values pass.
    std::vector<std::string> differences;
};

/// Whether a device has to give the same bits as every other one.
enum class ParityRequirement {
    Required,  ///< a device that is not parity-capable is refused
    None,      ///< it is opened: tables, hits and pictures may differ from those of other devices, or be wrong
};

/// How a device is opened. The defaults are right for use; the rest serves tests and measurements.
struct DeviceOptions {
    /// Work-items in a group of per-element kernels: a power of two up to 256; 0 picks 64 on a CPU and 128 elsewhere. Kernels that
    /// trace through grids with the DDA step run in groups of 32 on GPUs.
    std::uint32_t work_group_size = 0;
    PrimitiveShape primitives = PrimitiveShape::Auto;
    /// Bytes that setka may hold on the device at a time; 0 picks three quarters of the device's memory.
    std::uint64_t memory_budget_bytes = 0;
    ParityRequirement parity = ParityRequirement::Required;
};

namespace detail {  // of Download
[[nodiscard]] bool is_ready(backend::PendingRead* read);
void wait(backend::PendingRead* read);
/// Throws InvalidArgument unless `is_there`, which is false afterwards.
void take_once(bool& is_there, const char* what);
}  // namespace detail

class Queue;

/// A device that was opened: its kernels are compiled, its memory is pooled. Copies share the device.
class Device {
  public:
    /// Opens the device with this id, or the one device whose name contains `selector` (ignoring case). With an empty
    /// selector: the environment's SETKA_DEVICE, else the first GPU, else the first device.
    /// Throws InvalidArgument if nothing or more than one device matches; Unsupported if there is no device at all, or if the
    /// one that was chosen is not parity-capable and that is required.
    [[nodiscard]] static Device open(std::string_view selector = {}, const DeviceOptions& options = {});

    [[nodiscard]] const DeviceInfo& info() const noexcept;
    [[nodiscard]] const DeviceOptions& options() const noexcept;  ///< with every "0" and "Auto" resolved
    /// Found when the device was opened, at the work-group size of options().
    [[nodiscard]] const ParityReport& parity() const noexcept;
    [[nodiscard]] Queue make_queue() const;

    /// Bytes of live buffers now, and the most there were since the last reset_peak_memory().
    [[nodiscard]] std::uint64_t memory_in_use_bytes() const noexcept;
    [[nodiscard]] std::uint64_t peak_memory_bytes() const noexcept;
    void reset_peak_memory() const noexcept;
    /// How often memory was asked of the driver so far. Buffers are made of what earlier ones gave back where that fits, so that work
    /// that is done again and again, such as frames, soon asks for no more.
    [[nodiscard]] std::uint64_t driver_allocations() const noexcept;
    /// Gives cached, unused allocations back to the driver.
    void trim() const;

    /// Inside the library only.
    explicit Device(std::shared_ptr<backend::Device> impl) : impl_(std::move(impl)) {}
    [[nodiscard]] const std::shared_ptr<backend::Device>& impl() const noexcept { return impl_; }

  private:
    std::shared_ptr<backend::Device> impl_;
};

/// A typed view of one device allocation; copies share it. T is a plain struct without padding.
/// Memory goes back to the pool of the queue it came from, in that queue's order, with the last copy.
template <typename T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    Buffer() = default;
    Buffer(std::shared_ptr<backend::Memory> memory, std::size_t size)
        : memory_(std::move(memory)), size_(size) {}

    [[nodiscard]] std::size_t size() const noexcept { return size_; }  ///< elements
    [[nodiscard]] std::size_t size_bytes() const noexcept { return size_ * sizeof(T); }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] const std::shared_ptr<backend::Memory>& memory() const noexcept { return memory_; }

  private:
    std::shared_ptr<backend::Memory> memory_;
    std::size_t size_ = 0;
};

/// Device time spent in one named stage.
struct StageTime {
    std::string stage;
    double time_ms = 0;
    std::uint32_t launches = 0;
};

/// Elements on their way from a buffer to the host: what Queue::download_later() returns. It may outlive the queue and the buffer, and
/// belongs to the queue's thread as long as there is one. Destroying or replacing one that was not fetched waits for the device to come that far.
template <typename T>
class Download {
  public:
    Download() = default;  ///< of nothing: get() throws
    Download(Download&& other) noexcept
        : elements_(std::move(other.elements_)), read_(std::move(other.read_)), is_there_(std::exchange(other.is_there_, false)) {}
    Download& operator=(Download&& other) noexcept {
        if (this == &other) return *this;
        read_ = std::move(other.read_);  // first, since the device may still write the elements
        elements_ = std::move(other.elements_);
        is_there_ = std::exchange(other.is_there_, false);
        return *this;
    }
    ~Download() = default;

    /// Whether get() would return at once, or throw.
    [[nodiscard]] bool is_ready() const { return detail::is_ready(read_.get()); }
    /// Waits for the elements, and gives them away. Errors of asynchronous work surface here. A stop that is requested later than
    /// download_later() changes nothing. Throws InvalidArgument if it has been called before.
    [[nodiscard]] std::vector<T> get() {
        detail::take_once(is_there_, "download");
        detail::wait(read_.get());
        read_.reset();
        return std::move(elements_);
    }

  private:
    friend class Queue;
    std::vector<T> elements_;
    std::shared_ptr<backend::PendingRead> read_;  ///< into elements_, so it goes before them; none if there is nothing to wait for
    bool is_there_ = false;
};

/// One in-order stream of work on a device: what is enqueued later sees what was enqueued earlier. Calls return before the
/// device is done unless they say otherwise. One queue belongs to one host thread at a time. What another queue is to use, uploads too, needs
/// finish() first.
class Queue {
  public:
    /// A buffer of `size` elements with undefined contents. `name` appears in memory errors.
    /// Throws OutOfMemory if the device's budget or its largest single allocation would be exceeded.
    template <typename T>
    [[nodiscard]] Buffer<T> make_buffer(std::size_t size, std::string_view name) {
        return {allocate(size, sizeof(T), name), size};
    }

    /// A buffer with a copy of `source`, which may be changed as soon as the call returns.
    template <typename T>
    [[nodiscard]] Buffer<std::remove_const_t<T>> upload(std::span<T> source, std::string_view name) {
        auto buffer = make_buffer<std::remove_const_t<T>>(source.size(), name);
        write(buffer.memory(), 0, source.data(), source.size_bytes());
        return buffer;
    }

    /// Uses `storage` itself as the buffer where host and device share memory, and copies otherwise. `storage` must stay
    /// alive and untouched until finish() after the last use, or until read_back() of the buffer.
    template <typename T>
    [[nodiscard]] Buffer<std::remove_const_t<T>> wrap(std::span<T> storage, std::string_view name) {
        return {wrap_host(const_cast<std::remove_const_t<T>*>(storage.data()), storage.size(), sizeof(T),
                          std::is_const_v<T>, name),
                storage.size()};
    }

    /// Copies `source` over the elements of `target` from number `first` on. Throws InvalidArgument if it does not fit.
    template <typename T>
    void upload(std::span<const T> source, const Buffer<T>& target, std::size_t first = 0) {
        check_fits(first, source.size(), target.size());
        write(target.memory(), first * sizeof(T), source.data(), source.size_bytes());
    }

    /// Copies `count` elements of `source`, from `source_first` on, over those of `target` from `target_first` on, on the device.
    /// Throws InvalidArgument if they are not there or do not fit. Within one buffer the two parts must not overlap.
    template <typename T>
    void copy(const Buffer<T>& source, std::size_t source_first, const Buffer<T>& target, std::size_t target_first,
              std::size_t count) {
        check_fits(source_first, count, source.size());
        check_fits(target_first, count, target.size());
        copy_bytes(source.memory(), source_first * sizeof(T), target.memory(), target_first * sizeof(T),
                   count * sizeof(T));
    }

    /// Waits and copies the first elements of `source`; a copy of a buffer onto the memory that it wraps costs nothing.
    template <typename T>
    void download(const Buffer<T>& source, std::span<T> target) {
        check_fits(0, target.size(), source.size());
        read(source.memory(), target.data(), target.size_bytes());
    }
    template <typename T>
    [[nodiscard]] std::vector<T> download(const Buffer<T>& source) {
        std::vector<T> target(source.size());
        read(source.memory(), target.data(), source.size_bytes());
        return target;
    }

    /// The elements of `source` as they are when the device has done what was enqueued so far, without waiting: Download::get() does.
    /// What is enqueued later runs on meanwhile, may write `source`, and does not show in the result; the buffer may be freed as soon as the call
    /// returns. Throws Cancelled as download() does.
    template <typename T>
    [[nodiscard]] Download<T> download_later(const Buffer<T>& source) {
        Download<T> download;
        download.elements_.resize(source.size());
        download.read_ = read_later(source, std::span(download.elements_));
        download.is_there_ = true;
        return download;
    }

    /// Waits until everything enqueued so far is done. Errors of asynchronous work surface here and in download(); those of a Download in its get().
    void finish();

    /// Device time by stage since the last call, in order of first use; waits for what was enqueued. Times are recorded from the first call
    /// on, which returns none, until stop_timings(): they are not for nothing. On an NVIDIA GPU a launch that is timed costs the host some 3
    /// microseconds more with CUDA and 7 with OpenCL, which half of the time of small builds is made of.
    [[nodiscard]] std::vector<StageTime> take_timings();
    /// Records no more times, and forgets those that were not taken; waits for what was enqueued. take_timings() begins anew.
    void stop_timings();

    /// Once a stop is requested of `token`, calls that put work on this queue or a copy of it (buffers, transfers, builds, traces,
    /// renders) throw Cancelled, at the latest when the launch that runs is done. What they had allocated is given back, and
    /// the queue is usable again as soon as it has another token; `{}` is one of which no stop can be requested.
    /// While a stop can be requested, each launch is waited for and long ones are divided, which costs some ten microseconds a
    /// launch. No result depends on it.
    void set_stop_token(std::stop_token token);
    [[nodiscard]] std::stop_token stop_token() const;

    [[nodiscard]] const Device& device() const noexcept { return device_; }

    /// Inside the library only.
    Queue(Device device, std::shared_ptr<backend::Queue> impl)
        : device_(std::move(device)), impl_(std::move(impl)) {}
    [[nodiscard]] backend::Queue& impl() const noexcept { return *impl_; }
    /// Inside the library only: the first elements of `source`. `target` has to stay until the result was waited for or is gone; it is none if
    /// there is nothing to read.
    template <typename T>
    [[nodiscard]] std::shared_ptr<backend::PendingRead> read_later(const Buffer<T>& source, std::span<T> target) {
        check_fits(0, target.size(), source.size());
        return read_later(source.memory(), target.data(), target.size_bytes());
    }

  private:
    [[nodiscard]] std::shared_ptr<backend::Memory> allocate(std::size_t size, std::size_t element_bytes,
                                                            std::string_view name);
    [[nodiscard]] std::shared_ptr<backend::Memory> wrap_host(void* data, std::size_t size, std::size_t element_bytes,
                                                             bool read_only, std::string_view name);
    void write(const std::shared_ptr<backend::Memory>& target, std::size_t at, const void* source, std::size_t size_bytes);
    void read(const std::shared_ptr<backend::Memory>& source, void* target, std::size_t size_bytes);
    [[nodiscard]] std::shared_ptr<backend::PendingRead> read_later(const std::shared_ptr<backend::Memory>& source,
                                                                   void* target, std::size_t size_bytes);
    void copy_bytes(const std::shared_ptr<backend::Memory>& source, std::size_t source_at,
                    const std::shared_ptr<backend::Memory>& target, std::size_t target_at, std::size_t size_bytes);
    static void check_fits(std::size_t first, std::size_t count, std::size_t capacity);

    Device device_;
    std::shared_ptr<backend::Queue> impl_;
};

}  // namespace setka
