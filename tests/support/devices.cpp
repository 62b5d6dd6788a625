// SPDX-License-Identifier: MIT
/// How are the devices found, named and opened for tests?
#include "support/devices.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <sstream>
#include <tuple>

#include "setka/error.hpp"

namespace support {

namespace {

std::string required_backends() {
    const char* set = std::getenv("SETKA_REQUIRE");
    return set ? set : "";
}

std::string notes() {
    std::string all;
    for (const std::string& note : setka::enumeration_notes()) all += "\n  " + note;
    return all;
}

/// "OpenCL" and "opencl" are one.
std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

}  // namespace

std::vector<std::string> device_ids() {
    std::vector<std::string> ids;
    for (const setka::DeviceInfo& info : setka::enumerate_devices()) ids.push_back(info.id);
    if (ids.empty()) ids.emplace_back("none");
    return ids;
}

std::string identifier(const std::string& text) {
    std::string result = text;
    for (char& c : result)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return result;
}

std::string missing_backends() {
    std::stringstream wanted(required_backends());
    std::string missing;
    for (std::string name; std::getline(wanted, name, ',');) {
        const auto devices = setka::enumerate_devices();
        const bool found = std::any_of(devices.begin(), devices.end(), [&](const setka::DeviceInfo& info) {
            return lower(setka::to_string(info.backend)) == lower(name);
        });
        if (!found && !name.empty()) missing += (missing.empty() ? "" : ", ") + name;
    }
    return missing.empty() ? missing
                           : "SETKA_REQUIRE asks for " + missing + ", of which no device was found" + notes();
}

NoDevice no_device() {
    const std::string missing = missing_backends();
    return {!missing.empty(), missing.empty() ? "no device was found" + notes() : missing};
}

void DeviceTest::require_device(const std::string& id) {
    if (id != "none") return;
    const NoDevice why = no_device();
    if (why.is_failure) FAIL() << why.message;
    GTEST_SKIP() << why.message;
}

setka::Device open_once(const std::string& id, const setka::DeviceOptions& options) {
    using Key = std::tuple<std::string, std::uint32_t, setka::PrimitiveShape, std::uint64_t>;
    // Never destroyed: at exit a driver's own globals may be gone already (Oclgrind's are).
    static auto& opened = *new std::map<Key, setka::Device>;
    const Key key{id, options.work_group_size, options.primitives, options.memory_budget_bytes};
    auto found = opened.find(key);
    if (found == opened.end()) found = opened.emplace(key, setka::Device::open(id, options)).first;
    return found->second;
}

std::string obstacle(const std::string& id, const setka::DeviceOptions& options) {
    static std::map<std::tuple<std::string, std::uint32_t, setka::PrimitiveShape>, std::string> refused;
    const auto found = refused.find({id, options.work_group_size, options.primitives});
    if (found != refused.end()) return found->second;
    try {
        (void)open_once(id, options);
        return "";
    } catch (const setka::Error& error) {
        const setka::Device device = open_once(id);
        const std::uint32_t usual = device.info().type == setka::DeviceType::Cpu ? 64 : 128;
        if (error.category() != setka::ErrorCategory::InvalidArgument ||
            device.options().work_group_size >= usual)
            throw;
        return refused[{id, options.work_group_size, options.primitives}] = error.what();
    }
}

}  // namespace support
