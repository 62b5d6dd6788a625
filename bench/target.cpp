// SPDX-License-Identifier: MIT
/// On what is it measured? See the header.
#include "bench/target.hpp"

#include <algorithm>

#include "bench/embree.hpp"
#include "setka/error.hpp"

namespace setka::bench {

namespace {

struct NamedShape {
    const char* name;
    PrimitiveShape shape;
};

constexpr NamedShape shapes[] = {{"library", PrimitiveShape::Library},
                                 {"portable", PrimitiveShape::Portable},
                                 {"serial", PrimitiveShape::Serial},
                                 {"group", PrimitiveShape::Group}};

[[nodiscard]] std::vector<PrimitiveShape> default_shapes(Backend backend) {
    if (backend == Backend::Cuda) return {PrimitiveShape::Library, PrimitiveShape::Portable};
    return {PrimitiveShape::Portable};
}

[[nodiscard]] std::vector<PrimitiveShape> parse_shapes(const std::string& name, const std::string& shape,
                                                       Backend backend) {
    if (shape.empty()) return default_shapes(backend);
    const auto* const found =
        std::ranges::find_if(shapes, [&](const NamedShape& s) { return shape == s.name; });
    if (found == std::end(shapes))
        throw Error(ErrorCategory::InvalidArgument, "device '" + name + "' has the shape '" + shape +
                                                        "'; accepted: library, portable, serial, group");
    return {found->shape};
}

void add(std::vector<Target>& targets, const DeviceInfo& info, const std::vector<PrimitiveShape>& wanted) {
    for (const PrimitiveShape shape : wanted) {
        const bool is_known =
            std::ranges::any_of(targets, [&](const Target& target) { return target.info().id == info.id; });
        targets.emplace_back(info, shape,
                             is_known ? Target::Place::AnotherShape : Target::Place::FirstOfDevice);
    }
}

}  // namespace

std::string Target::name() const {
    const auto* const found = std::ranges::find(shapes, shape_, &NamedShape::shape);
    return info_.id + '/' + found->name;
}

const Device& Target::device() {
    if (!device_) device_ = Device::open(info_.id, {.primitives = shape_});
    return *device_;
}

std::vector<Target> find_targets(const std::vector<std::string>& names) {
    const std::vector<DeviceInfo> infos = enumerate_devices();
    if (infos.empty()) {
        std::string reasons;
        for (const std::string& note : enumeration_notes()) reasons += "; " + note;
        throw Error(ErrorCategory::Unsupported, "no device was found" + reasons);
    }
    std::vector<Target> targets;
    if (names.empty())
        for (const DeviceInfo& info : infos) add(targets, info, default_shapes(info.backend));
    for (const std::string& name : names) {
        if (is_embree(name)) continue;
        const std::size_t slash = name.find('/');
        const auto info = std::ranges::find(infos, name.substr(0, slash), &DeviceInfo::id);
        if (info == infos.end()) {
            std::string ids;
            for (const DeviceInfo& other : infos) ids += (ids.empty() ? "" : ", ") + other.id;
            throw Error(ErrorCategory::InvalidArgument,
                        "device '" + name + "' is not here; accepted: " + ids);
        }
        const std::string shape = slash == std::string::npos ? "" : name.substr(slash + 1);
        add(targets, *info, parse_shapes(name, shape, info->backend));
    }
    if (targets.empty())
        throw Error(ErrorCategory::InvalidArgument,
                    "no device of setka is named, only Embree, whose rays and hits one of them has to give; "
                    "accepted: one of them too, such as " +
                        infos.front().id);
    return targets;
}

}  // namespace setka::bench
