// SPDX-License-Identifier: MIT
/// What value does an animated property of glTF have at a time? See the header.
#include "io/gltf_track.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "io/file.hpp"

namespace setka::io::detail {

namespace {

using Quaternion = std::array<double, 4>;

double dot(const Quaternion& a, const Quaternion& b) {
    return ((a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]) + a[3] * b[3];
}

Quaternion unit(const Quaternion& q) {
    const double length = std::sqrt(dot(q, q));
    if (!(length > 0)) return {0, 0, 0, 1};
    return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

Quaternion blend(const Quaternion& a, const Quaternion& b, double share) {
    Quaternion q;
    for (std::size_t i = 0; i < 4; ++i) q[i] = a[i] + share * (b[i] - a[i]);
    return unit(q);
}

Quaternion quaternion_of(std::span<const double> values) {
    return unit({values[0], values[1], values[2], values[3]});
}

/// Where between two keys a time lies.
struct Place {
    std::size_t key;
    double share;    ///< 0 at the key, 1 at the next
    double seconds;  ///< from the key to the next
};

Place place(const std::vector<double>& times, double seconds) {
    if (!(seconds > times.front())) return {0, 0, 0};
    if (seconds >= times.back()) return {times.size() - 1, 0, 0};
    const auto next = std::ranges::upper_bound(times, seconds);
    const auto key = static_cast<std::size_t>(next - times.begin()) - 1;
    const double length = times[key + 1] - times[key];
    return {key, (seconds - times[key]) / length, length};
}

/// Hermite's cubic through two values with the tangents between them, which are per second.
double hermite(double a, double tangent_a, double b, double tangent_b, double share, double seconds) {
    const double s2 = share * share, s3 = s2 * share;
    return (((2 * s3 - 3 * s2 + 1) * a + seconds * (s3 - 2 * s2 + share) * tangent_a) +
            (3 * s2 - 2 * s3) * b) +
           seconds * (s3 - s2) * tangent_b;
}

}  // namespace

Quaternion slerp(const Quaternion& from, Quaternion to, double share) {
    if (dot(from, to) < 0)
        for (double& component : to) component = -component;
    Quaternion low = from, high = to;
    // The halves of an arc are equal, so this is bisection of the angle. After 20 halvings an arc and its
    // chord differ by less than doubles resolve.
    for (int i = 0; i < 20; ++i) {
        const Quaternion middle = blend(low, high, 0.5);
        share *= 2;
        if (share < 1) {
            high = middle;
        } else {
            low = middle;
            share -= 1;
        }
    }
    return blend(low, high, share);
}

std::vector<double> Track::at(double seconds) const {
    const Place at = place(keys->values, seconds);
    const bool is_spline = interpolation == Interpolation::CubicSpline;
    const std::size_t stride = is_spline ? 3 * width : width;
    const auto part = [&](std::size_t key, std::size_t which) {
        return std::span(values->values).subspan(key * stride + which * width, width);
    };
    const auto value = part(at.key, is_spline ? 1 : 0);
    std::vector<double> result(value.begin(), value.end());
    const bool is_between = at.share > 0 && interpolation != Interpolation::Step;
    if (is_between && is_spline) {
        const auto out = part(at.key, 2), in = part(at.key + 1, 0), next = part(at.key + 1, 1);
        for (std::size_t i = 0; i < width; ++i)
            result[i] = hermite(value[i], out[i], next[i], in[i], at.share, at.seconds);
    } else if (is_between && kind == Values::Quaternions) {
        const Quaternion q = slerp(quaternion_of(value), quaternion_of(part(at.key + 1, 0)), at.share);
        return {q.begin(), q.end()};
    } else if (is_between) {
        const auto next = part(at.key + 1, 0);
        for (std::size_t i = 0; i < width; ++i) result[i] = value[i] + at.share * (next[i] - value[i]);
    }
    if (kind != Values::Quaternions) return result;
    const Quaternion q = quaternion_of(result);
    return {q.begin(), q.end()};
}

Track read_track(const GltfDocument& document, const nlohmann::json& sampler, std::size_t width, Values kind,
                 const std::string& what) {
    const auto fail = [&](const std::string& reason) { fail_read(document.file(), what + reason); };
    for (const char* key : {"input", "output"})
        if (!sampler.contains(key)) fail(std::string(" has a sampler without '") + key + "'");
    Track track;
    track.width = width;
    track.kind = kind;
    const std::string word = sampler.value("interpolation", std::string("LINEAR"));
    if (word == "STEP") track.interpolation = Interpolation::Step;
    else if (word == "CUBICSPLINE") track.interpolation = Interpolation::CubicSpline;
    else if (word != "LINEAR")
        fail(" has the interpolation " + in_quotes(word, 40) + "; known are LINEAR, STEP and CUBICSPLINE");
    track.keys = document.numbers(sampler["input"].get<std::uint64_t>(), "SCALAR");
    const std::vector<double>& times = track.keys->values;
    if (times.empty()) fail(" has no key");
    if (const std::size_t i = track.keys->first_no_time; i < times.size())
        fail(": key " + std::to_string(i) + " is at " + std::to_string(times[i]) +
             " s; times must be finite, 0 or more, and must not fall");
    const char* type = kind == Values::Weights ? "SCALAR" : kind == Values::Quaternions ? "VEC4" : "VEC3";
    track.values = document.numbers(sampler["output"].get<std::uint64_t>(), type);
    const std::size_t count = track.values->values.size();
    const std::size_t needed =
        times.size() * width * (track.interpolation == Interpolation::CubicSpline ? 3 : 1);
    if (count != needed)
        fail(" has " + std::to_string(count) + " numbers for " + std::to_string(times.size()) + " keys; " +
             std::to_string(needed) + " are needed");
    if (track.values->first_not_finite < count)
        fail(": value " + std::to_string(track.values->first_not_finite) + " is not finite");
    return track;
}

}  // namespace setka::io::detail
