// SPDX-License-Identifier: MIT
/// What numbers does a checked glTF file hold? See the header.
#include "io/gltf_document.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/file.hpp"

namespace setka::io::detail {

namespace {

using Json = nlohmann::json;

constexpr std::uint64_t type_float = 5126;

std::size_t component_bytes(std::uint64_t component) {
    return component <= 5121 ? 1 : component <= 5123 ? 2 : 4;
}

std::size_t width_of(const std::string& type) {
    return type == "SCALAR" ? 1
           : type == "VEC2" ? 2
           : type == "VEC3" ? 3
           : type == "MAT4" ? 16
           : type == "MAT3" ? 9
                            : 4;
}

/// One component as a number: little-endian, and for normalised integers a share as glTF 2.0, 3.11, defines
/// it.
double component_at(const std::string& bytes, std::size_t at, std::uint64_t component, bool is_normalized) {
    std::uint32_t word = 0;
    for (std::size_t i = component_bytes(component); i-- > 0;)
        word = word << 8 | static_cast<unsigned char>(bytes.at(at + i));
    const auto share = [&](double value, double largest) {
        return is_normalized ? std::max(value / largest, -1.0) : value;
    };
    switch (component) {
        case 5120:
            return share(static_cast<std::int8_t>(word), 127);
        case 5121:
            return share(word, 255);
        case 5122:
            return share(static_cast<std::int16_t>(word), 32767);
        case 5123:
            return share(word, 65535);
        case 5125:
            return word;
        default:
            return std::bit_cast<float>(word);
    }
}

int digit_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

std::string decode_base64(std::string_view text) {
    std::string bytes;
    std::uint32_t word = 0;
    int bits = 0;
    for (const char c : text) {
        const int digit = digit_of(c);
        if (digit < 0) break;
        word = word << 6 | static_cast<std::uint32_t>(digit);
        if ((bits += 6) < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(word >> bits & 0xff);
    }
    return bytes;
}

void find_faults(GltfNumbers& numbers) {
    const std::vector<double>& values = numbers.values;
    numbers.first_not_finite = numbers.first_no_time = values.size();
    for (std::size_t i = values.size(); i-- > 0;) {
        const bool is_finite = std::isfinite(values[i]);
        if (!is_finite) numbers.first_not_finite = i;
        if (!is_finite || values[i] < 0 || (i && values[i] < values[i - 1])) numbers.first_no_time = i;
    }
}

}  // namespace

GltfDocument::GltfDocument(std::filesystem::path file, Json json, std::optional<std::string> binary,
                           std::uint64_t min_budget)
    : file_(std::move(file)), json_(std::move(json)), binary_(std::move(binary)), budget_bytes_(min_budget) {
    std::uint64_t buffer_bytes = 0;
    for (const Json& buffer : list("buffers")) buffer_bytes += buffer["byteLength"].get<std::uint64_t>();
    budget_bytes_ = std::max(budget_bytes_, budget_per_byte * buffer_bytes);
}

void GltfDocument::charge(std::uint64_t size_bytes, const std::string& what) const {
    if (size_bytes > budget_bytes_ - charged_bytes_)
        fail_read(file_, what + " takes " + std::to_string(size_bytes) + " bytes beside " +
                             std::to_string(charged_bytes_) +
                             " of other animations, skins and morph targets; together they may take " +
                             std::to_string(budget_bytes_) + " in a file with buffers of this size");
    charged_bytes_ += size_bytes;
}

const Json& GltfDocument::list(const char* key) const {
    static const Json none = Json::array();
    const auto found = json_.find(key);
    return found == json_.end() ? none : *found;
}

const Json& GltfDocument::element(const char* key, std::uint64_t index) const {
    const Json& all = list(key);
    if (index >= all.size())
        fail_read(file_, "malformed glTF: index " + std::to_string(index) + " into '" + key +
                             "', which has " + std::to_string(all.size()));
    return all[index];
}

const std::string& GltfDocument::buffer(std::size_t index) const {
    buffers_.resize(list("buffers").size());
    std::optional<std::string>& bytes = buffers_.at(index);
    if (!bytes) {
        const Json& buffer = element("buffers", index);
        const std::string uri = buffer.value("uri", std::string());
        if (uri.empty()) bytes = binary_.value_or(std::string());
        else if (uri.starts_with("data:"))
            bytes = decode_base64(std::string_view(uri).substr(uri.find(',') + 1));
        else bytes = read_file(file_.parent_path() / decode_uri(uri));
        if (bytes->size() < buffer["byteLength"].get<std::uint64_t>())
            fail_read(file_, "malformed glTF: buffer " + std::to_string(index) + " holds " +
                                 std::to_string(bytes->size()) + " bytes, fewer than its byteLength");
    }
    return *bytes;
}

std::vector<double> GltfDocument::read(const Json& user, std::size_t count, std::size_t width,
                                       std::uint64_t component, bool is_normalized) const {
    std::vector<double> values(count * width, 0.0);
    if (!user.contains("bufferView") || count == 0) return values;
    const Json& view = element("bufferViews", user["bufferView"].get<std::uint64_t>());
    const std::string& bytes = buffer(view["buffer"].get<std::size_t>());
    const std::size_t size = component_bytes(component);
    const std::size_t given_stride = view.value("byteStride", std::size_t(0));
    const std::size_t stride = given_stride ? given_stride : size * width;
    std::size_t at = view.value("byteOffset", std::size_t(0)) + user.value("byteOffset", std::size_t(0));
    for (std::size_t i = 0; i < count; ++i, at += stride)
        for (std::size_t c = 0; c < width; ++c)
            values[i * width + c] = component_at(bytes, at + c * size, component, is_normalized);
    return values;
}

std::shared_ptr<const GltfNumbers> GltfDocument::numbers(std::uint64_t index, const char* type) const {
    const Json& accessor = element("accessors", index);
    const std::string what = "accessor " + std::to_string(index);
    if (accessor.value("type", std::string()) != type)
        fail_read(file_, what + " is of type " + accessor.value("type", std::string()) + "; " + type +
                             " is needed here");
    std::shared_ptr<const GltfNumbers>& decoded = decoded_[index];
    if (!decoded) {
        const std::size_t width = width_of(type);
        charge(accessor["count"].get<std::uint64_t>() * width * sizeof(double), what);
        decoded = std::make_shared<const GltfNumbers>(decode(accessor, width, what));
    }
    return decoded;
}

GltfNumbers GltfDocument::decode(const Json& accessor, std::size_t width, const std::string& what) const {
    const auto component = accessor["componentType"].get<std::uint64_t>();
    const bool is_normalized = accessor.value("normalized", false);
    GltfNumbers numbers;
    numbers.count = accessor["count"].get<std::size_t>();
    numbers.width = width;
    numbers.values = read(accessor, numbers.count, numbers.width, component, is_normalized);
    if (const auto sparse = accessor.find("sparse"); sparse != accessor.end()) {
        const auto changed = (*sparse)["count"].get<std::size_t>();
        const std::vector<double> places =
            read((*sparse)["indices"], changed, 1, (*sparse)["indices"]["componentType"].get<std::uint64_t>(),
                 false);
        const std::vector<double> values =
            read((*sparse)["values"], changed, numbers.width, component, is_normalized);
        for (std::size_t i = 0; i < changed; ++i) {
            if (!(places[i] >= 0 && places[i] < double(numbers.count)))
                fail_read(file_, "malformed glTF: a sparse index of " + what + " is out of range");
            std::copy_n(values.begin() + std::ptrdiff_t(i * numbers.width), numbers.width,
                        numbers.values.begin() + std::ptrdiff_t(std::size_t(places[i]) * numbers.width));
        }
    }
    find_faults(numbers);
    return numbers;
}

}  // namespace setka::io::detail
