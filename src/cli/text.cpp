// SPDX-License-Identifier: MIT
/// How are numbers written for people? See the header.
#include "cli/text.hpp"

#include <fmt/core.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace setka::cli {

std::string grouped(std::uint64_t number) {
    const std::string digits = std::to_string(number);
    std::string text;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i != 0 && (digits.size() - i) % 3 == 0) text += ',';
        text += digits[i];
    }
    return text;
}

std::string as_bytes(std::uint64_t size_bytes) {
    constexpr const char* units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    auto amount = static_cast<double>(size_bytes);
    std::size_t unit = 0;
    for (; amount >= 1024 && unit + 1 < std::size(units); ++unit) amount /= 1024;
    return unit == 0 ? fmt::format("{} bytes", size_bytes) : fmt::format("{:.1f} {}", amount, units[unit]);
}

std::string as_utf8(const std::string& text) {
    try {
        (void)nlohmann::json(text).dump();
        return text;
    } catch (const nlohmann::json::type_error&) {  // JSON's writer knows what UTF-8 is
    }
    std::string result;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 128) result += c;
        else result += fmt::format("%{:02X}", byte);
    }
    return result;
}

std::vector<std::string> as_utf8(const std::vector<std::string>& texts) {
    std::vector<std::string> result;
    for (const std::string& text : texts) result.push_back(as_utf8(text));
    return result;
}

}  // namespace setka::cli
