// SPDX-License-Identifier: MIT
/// Which devices are compared? See the header.
#include "cli/compare_rows.hpp"

#include <algorithm>

#include "cli/options.hpp"
#include "cli/primitive_shapes.hpp"

namespace setka::cli {

namespace {

[[nodiscard]] RowChoice parse_row(const std::string& option, std::string_view text) {
    const std::size_t slash = text.rfind('/');
    const std::string_view selector = text.substr(0, slash);
    if (selector.empty()) reject(option, text, "a device's id or a part of its name");
    if (slash == std::string_view::npos) return {std::string(selector)};
    const auto shape = find_primitive_shape(text.substr(slash + 1));
    if (!shape) reject(option, text, "a device with one of " + primitive_shape_words() + " after the slash");
    return {std::string(selector), *shape};
}

}  // namespace

std::string RowChoice::to_string() const {
    return primitives == PrimitiveShape::Auto ? selector : selector + '/' + cli::to_string(primitives);
}

std::vector<RowChoice> parse_rows(const std::string& option, std::string_view text) {
    std::vector<RowChoice> rows;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        rows.push_back(parse_row(option, text.substr(begin, end - begin)));
        begin = end + 1;
    }
    if (rows.size() < 2)
        reject(option, text,
               "a comparison; two or more are, such as " + rows.front().selector + "/serial," +
                   rows.front().selector + "/group");
    return rows;
}

std::vector<RowChoice> default_rows(const std::vector<DeviceInfo>& devices) {
    std::vector<RowChoice> rows;
    for (const DeviceInfo& device : devices) {
        if (device.backend == Backend::Cuda) {
            rows.push_back({device.id, PrimitiveShape::Library});
            rows.push_back({device.id, PrimitiveShape::Portable});
        } else if (devices.size() == 1) {
            rows.push_back({device.id, PrimitiveShape::Serial});
            rows.push_back({device.id, PrimitiveShape::Group});
        } else {
            rows.push_back({device.id, PrimitiveShape::Auto});
        }
    }
    return rows;
}

}  // namespace setka::cli
