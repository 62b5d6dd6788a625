// SPDX-License-Identifier: MIT
#include "view/render_thread.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "setka/error.hpp"

namespace setka::view {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double total_ms(const std::vector<StageTime>& stages) {
    double sum = 0;
    for (const StageTime& stage : stages) sum += stage.time_ms;
    return sum;
}

bool is_trace(const StageTime& stage) {
    return stage.stage == "closest hit" || stage.stage == "any hit" || stage.stage == "cost";
}

/// What a picture may take while something moves, and what a first one may take before a smaller one is worth
/// showing.
constexpr double moving_ms = 45, first_ms = 150;
/// Sums in the making are shown no more often than this.
constexpr double show_every_ms = 60;

}  // namespace

RenderThread::RenderThread(Scene scene, SceneMotion motion, const RenderThreadOptions& options,
                           const Settings& first, std::function<void()> on_frame)
    : scene_(std::move(scene)),
      motion_(std::move(motion)),
      options_(options),
      on_frame_(std::move(on_frame)),
      world_(make_world(first)),
      first_device_(world_->device.info().id) {
    thread_ = std::thread([this] { run(); });
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
        stop_.request_stop();
    }
    wake_.notify_one();
    thread_.join();
}

std::uint64_t RenderThread::ask(const Settings& settings, Motion motion) {
    const std::lock_guard lock(mutex_);
    waiting_ = {settings, motion, ++orders_};
    stop_.request_stop();
    wake_.notify_one();
    return orders_;
}

std::shared_ptr<const Frame> RenderThread::newest() const {
    const std::lock_guard lock(mutex_);
    return newest_;
}

bool RenderThread::is_outdated() const {
    const std::lock_guard lock(mutex_);
    return has_ended_ || waiting_.has_value();
}

std::optional<RenderThread::Order> RenderThread::next_order() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return has_ended_ || waiting_; });
    if (has_ended_) return std::nullopt;
    // Pictures of a movement are always finished: else none would be seen before its end.
    stop_ = waiting_->motion == Motion::Still ? std::stop_source() : std::stop_source(std::nostopstate);
    return std::exchange(waiting_, std::nullopt);
}

void RenderThread::run() {
    while (const auto order = next_order()) {
        try {
            work(*order);
        } catch (const Error& error) {
            if (error.category() != ErrorCategory::Cancelled) publish_trouble(*order, error);
        } catch (const std::exception& error) {
            publish_trouble(*order, error);
        }
    }
}

void RenderThread::publish_trouble(const Order& order, const std::exception& error) {
    Frame frame = frame_of(order, error.what());
    publish(std::move(frame));
}

void RenderThread::work(const Order& order) {
    const Settings& settings = order.settings;
    const std::string trouble = prepare(settings);
    // Where launches are short nothing needs to be broken off, and waiting for each would cost more.
    const bool is_slow = world_->device.info().type == DeviceType::Cpu;
    world_->queue.set_stop_token(is_slow ? stop_.get_token() : std::stop_token());
    const Frame frame = frame_of(order, trouble);
    if (order.motion == Motion::Moving)
        return show_one_sample(order, frame, divisor_for(settings, moving_ms));
    if (const std::uint32_t divisor = divisor_for(settings, first_ms); divisor > 1)
        show_one_sample(order, frame, divisor);
    if (is_outdated()) return;
    if (settings.samples_per_axis > 1) show_one_sample(order, frame, 1);
    show_passes(order, frame);
}

Grid RenderThread::build_grid(Queue& queue, const DeviceScene& scene, float density) const {
    GridOptions options = options_.grid;
    options.density = density;
    return make_grid_builder(options)->build(queue, scene);
}

std::unique_ptr<RenderThread::World> RenderThread::make_world(const Settings& settings) const {
    Device device = Device::open(settings.device, options_.device);
    Queue queue = device.make_queue();
    const auto start = Clock::now();
    DeviceScene scene(queue, scene_);
    if (!motion_.is_still()) scene.apply(queue, motion_.at(settings.moment));
    queue.finish();
    const double upload_ms = ms_since(start);
    (void)queue.take_timings();
    Grid grid = build_grid(queue, scene, settings.density);
    const double build_ms = total_ms(queue.take_timings());
    return std::make_unique<World>(World{std::move(device), std::move(queue), std::move(scene),
                                         std::move(grid), settings.density, settings.moment, upload_ms, build_ms});
}

std::string RenderThread::prepare(const Settings& settings) {
    try {
        if (world_->device.info().id != settings.device) {
            world_ = make_world(settings);
            ms_a_pixel_ = 0;
            return {};
        }
        world_->queue.set_stop_token({});
        if (world_->moment != settings.moment && !motion_.is_still()) move(*world_, settings.moment);
        if (world_->density != settings.density) rebuild(*world_, settings.density);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

void RenderThread::rebuild(World& world, float density) const {
    (void)world.queue.take_timings();
    world.grid = build_grid(world.queue, world.scene, density);
    world.density = density;
    world.build_ms = total_ms(world.queue.take_timings());
}

double RenderThread::pose(World& world, double moment) const {
    const SceneUpdate update = motion_.at(moment);
    const auto start = Clock::now();
    world.scene.apply(world.queue, update);
    world.queue.finish();
    return ms_since(start);
}

void RenderThread::move(World& world, double moment) const {
    const double upload_ms = pose(world, moment);
    try {
        rebuild(world, world.density);
    } catch (const Error&) {
        (void)pose(world, world.moment);  // which the grid is still of
        throw;
    }
    world.moment = moment;
    world.upload_ms = upload_ms;
}

Frame RenderThread::frame_of(const Order& order, const std::string& trouble) const {
    const World& world = *world_;
    const ::SetkaGridHeader& header = world.grid.header();
    Frame frame;
    frame.order = order.number;
    frame.trouble = trouble;
    frame.times.upload = world.upload_ms;
    frame.times.build = world.build_ms;
    frame.facts.device = world.device.info().id;
    frame.facts.device_name = world.device.info().name;
    frame.facts.density = world.density;
    frame.facts.moment = world.moment;
    frame.facts.triangles = header.triangle_count;
    std::copy_n(header.dims, 3, frame.facts.dims);
    frame.facts.cells = header.cell_count;
    frame.facts.pairs = header.reference_count;
    frame.facts.structure_bytes = world.grid.size_bytes();
    frame.facts.device_bytes = world.device.memory_in_use_bytes();
    return frame;
}

std::uint32_t RenderThread::divisor_for(const Settings& settings, double budget_ms) const {
    const double pixels = double(settings.width) * settings.height;
    if (ms_a_pixel_ == 0) return pixels > 1e5 ? 4 : 1;  // the first picture tells
    std::uint32_t divisor = 1;
    while (divisor < 8 && pixels * ms_a_pixel_ > budget_ms * divisor * divisor) divisor *= 2;
    return divisor;
}

void RenderThread::fill_in(Frame& frame, ProgressiveRender& picture, std::uint32_t passes) const {
    frame.image = picture.image();
    frame.statistics = picture.statistics();
    frame.times.trace = frame.times.shade = 0;
    for (const StageTime& stage : world_->queue.take_timings())
        (is_trace(stage) ? frame.times.trace : frame.times.shade) += stage.time_ms / passes;
}

void RenderThread::show_one_sample(const Order& order, Frame frame, std::uint32_t divisor) {
    const Settings& settings = order.settings;
    RenderOptions options;
    options.width = std::max(1u, settings.width / divisor);
    options.height = std::max(1u, settings.height / divisor);
    options.max_depth = options_.max_depth;
    options.view = settings.view;
    options.trace.step = settings.step;
    options.pixels = Pixels::Srgb;
    const auto start = Clock::now();
    ProgressiveRender picture(world_->queue, world_->scene, world_->grid, settings.camera(), options);
    picture.finish();
    frame.passes = settings.samples_per_axis * settings.samples_per_axis;
    fill_in(frame, picture, 1);
    ms_a_pixel_ = ms_since(start) / (double(options.width) * options.height);
    publish(std::move(frame));
}

void RenderThread::show_passes(const Order& order, Frame frame) {
    const Settings& settings = order.settings;
    RenderOptions options;
    options.width = settings.width;
    options.height = settings.height;
    options.samples_per_axis = settings.samples_per_axis;
    options.max_depth = options_.max_depth;
    options.view = settings.view;
    options.trace.step = settings.step;
    options.pixels = Pixels::Srgb;
    ProgressiveRender picture(world_->queue, world_->scene, world_->grid, settings.camera(), options);
    frame.passes = picture.passes();
    const auto start = Clock::now();
    auto shown = start;
    while (picture.passes_done() < picture.passes() && !is_outdated()) {
        picture.add_pass();
        const bool is_last = picture.passes_done() == picture.passes();
        // The mean of the first rows of samples lies beside the pixel's middle: from half of them on it moves
        // little.
        if (!is_last && (picture.passes_done() * 2 < picture.passes() || ms_since(shown) < show_every_ms)) {
            world_->queue.finish();  // so that another order does not wait for what was only enqueued
            continue;
        }
        const std::uint32_t added = picture.passes_done() - frame.passes_done;
        frame.passes_done = picture.passes_done();
        fill_in(frame, picture, added);
        shown = Clock::now();
        if (picture.passes() == 1) ms_a_pixel_ = ms_since(start) / (double(options.width) * options.height);
        publish(frame);
    }
}

void RenderThread::publish(Frame frame) {
    {
        const std::lock_guard lock(mutex_);
        newest_ = std::make_shared<const Frame>(std::move(frame));
    }
    on_frame_();
}

}  // namespace setka::view
