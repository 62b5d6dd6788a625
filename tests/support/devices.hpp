// SPDX-License-Identifier: MIT
/// On which devices does a test run? On every one that the library finds; with none, one case skips with the
/// reason, or fails if the environment's SETKA_REQUIRE (backends by name, separated by commas) asks for one.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "setka/device.hpp"

namespace support {

/// Ids of all devices, or "none".
[[nodiscard]] std::vector<std::string> device_ids();

/// A test's parameter name: letters, digits and underscores only.
[[nodiscard]] std::string identifier(const std::string& text);

/// Backends of SETKA_REQUIRE of which no device was found, with why; empty if nothing is missing.
[[nodiscard]] std::string missing_backends();

/// The device `id` with these options, opened once per process and kept.
[[nodiscard]] setka::Device open_once(const std::string& id, const setka::DeviceOptions& options = {});

/// Why the device `id` cannot be opened with these options, if that is the driver's limit: one whose own
/// choice of work-groups is smaller than usual may refuse a size that others accept. Empty if it can be
/// opened.
[[nodiscard]] std::string obstacle(const std::string& id, const setka::DeviceOptions& options);

/// A test of one device; its parameter is the device's id.
class DeviceTest : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override { require_device(GetParam()); }
    [[nodiscard]] setka::Device device(const setka::DeviceOptions& options = {}) const {
        return open_once(GetParam(), options);
    }
    /// Skips or fails if there is none.
    static void require_device(const std::string& id);
};

/// A test of one device and one more parameter.
template <typename Other>
class DeviceAndTest : public ::testing::TestWithParam<std::tuple<std::string, Other>> {
  protected:
    void SetUp() override;
    [[nodiscard]] setka::Device device(const setka::DeviceOptions& options = {}) const {
        return open_once(std::get<0>(this->GetParam()), options);
    }
    [[nodiscard]] const Other& other() const { return std::get<1>(this->GetParam()); }
};

/// What becomes of a test without a device.
struct NoDevice {
    bool is_failure = false;
    std::string message;
};
[[nodiscard]] NoDevice no_device();

template <typename Other>
void DeviceAndTest<Other>::SetUp() {
    if (std::get<0>(this->GetParam()) != "none") return;
    const NoDevice why = no_device();
    if (why.is_failure) FAIL() << why.message;
    GTEST_SKIP() << why.message;
}

/// Names "opencl_0" and "opencl_0_other".
struct DeviceName {
    std::string operator()(const ::testing::TestParamInfo<std::string>& info) const {
        return identifier(info.param);
    }
    std::string operator()(const ::testing::TestParamInfo<std::tuple<std::string, std::string>>& info) const {
        return identifier(std::get<0>(info.param) + "_" + std::get<1>(info.param));
    }
};

}  // namespace support

/// Runs the suite, a DeviceTest, on every device.
#define SETKA_ON_EVERY_DEVICE(suite)                                                       \
    INSTANTIATE_TEST_SUITE_P(Devices, suite, ::testing::ValuesIn(::support::device_ids()), \
                             ::support::DeviceName())

/// Runs the suite, a DeviceAndTest<std::string>, on every device with each of `values`.
#define SETKA_ON_EVERY_DEVICE_AND(suite, values)                                                       \
    INSTANTIATE_TEST_SUITE_P(                                                                          \
        Devices, suite,                                                                                \
        ::testing::Combine(::testing::ValuesIn(::support::device_ids()), ::testing::ValuesIn(values)), \
        ::support::DeviceName())
