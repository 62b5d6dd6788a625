// SPDX-License-Identifier: MIT
/// Is a picture the same, bit for bit, however it is made? Work-group sizes, primitives, structures, steps
/// and batches.
#include <cstring>

#include "fixture.hpp"

namespace setka::render_test {
namespace {

class Same : public Render {
  protected:
    void SetUp() override {
        Render::SetUp();
        if (device_) reference_ = render(scene_, options_);
    }
    const Scene scene_ = everything();
    const RenderOptions options_{.width = 61, .height = 47, .samples_per_axis = 2};
    Picture reference_;
};

TEST_F(Same, ForEveryWorkGroupSize) {
    for (const std::uint32_t size : {1u, 32u, 64u, 256u}) {
        DeviceOptions device_options;
        device_options.work_group_size = size;
        const Device device = Device::open(device_->info().id, device_options);
        EXPECT_TRUE(same_picture(render_on(device, scene_, options_).image, reference_.image)) << size;
    }
}

TEST_F(Same, ForEveryShapeOfPrimitives) {
    for (const PrimitiveShape shape : {PrimitiveShape::Serial, PrimitiveShape::Group}) {
        DeviceOptions device_options;
        device_options.primitives = shape;
        const Device device = Device::open(device_->info().id, device_options);
        EXPECT_TRUE(same_picture(render_on(device, scene_, options_).image, reference_.image));
    }
}

TEST_F(Same, ForEveryStructureAndStep) {
    EXPECT_TRUE(same_picture(render_on(*device_, scene_, options_, StructureKind::BruteForce).image,
                             reference_.image));
    RenderOptions other = options_;
    other.trace.step = GridStep::BranchFree;
    EXPECT_TRUE(same_picture(render(scene_, other).image, reference_.image));
}

TEST_F(Same, InEveryRunAndOnEveryDevice) {
    EXPECT_TRUE(same_picture(render(scene_, options_).image, reference_.image));
    for (const DeviceInfo& info : enumerate_devices()) {
        SCOPED_TRACE(info.id + " " + info.name);
        EXPECT_TRUE(same_picture(render_on(Device::open(info.id), scene_, options_).image, reference_.image));
    }
}

TEST_F(Same, HoweverLittleMemoryThereIs) {
    Queue queue = device_->make_queue();
    device_->reset_peak_memory();
    (void)render(scene_, options_);
    const std::uint64_t peak = device_->peak_memory_bytes();
    DeviceOptions device_options;
    device_options.memory_budget_bytes = peak / 5;
    const Device device = Device::open(device_->info().id, device_options);
    RenderOptions counted = options_;
    std::size_t batches = 0;
    counted.progress = [&](double) { ++batches; };
    const Picture small = render_on(device, scene_, counted);
    EXPECT_TRUE(same_picture(small.image, reference_.image));
    EXPECT_GT(batches, 4u);
    EXPECT_EQ(small.statistics.secondary_rays, reference_.statistics.secondary_rays);
    EXPECT_EQ(small.statistics.shadow_rays, reference_.statistics.shadow_rays);
    EXPECT_LE(device.peak_memory_bytes(), peak / 5);
}

TEST_F(Same, WithViewsInBatches) {
    for (const View view : {View::Normals, View::Depth, View::Steps, View::Tests}) {
        RenderOptions options = options_;
        options.view = view;
        device_->reset_peak_memory();
        const Picture large = render(scene_, options);
        DeviceOptions device_options;
        device_options.memory_budget_bytes = device_->peak_memory_bytes() * 3 / 5;
        const Device device = Device::open(device_->info().id, device_options);
        EXPECT_TRUE(same_picture(render_on(device, scene_, options).image, large.image))
            << static_cast<int>(view);
    }
}

TEST_F(Same, ButNotWithoutAnyMemory) {
    DeviceOptions device_options;
    device_options.memory_budget_bytes = 4096;
    const Device device = Device::open(device_->info().id, device_options);
    EXPECT_TRUE(
        fails_with(ErrorCategory::OutOfMemory, "", [&] { (void)render_on(device, scene_, options_); }));
}

}  // namespace
}  // namespace setka::render_test
