// SPDX-License-Identifier: MIT
/// What of an OBJ file can differ from frame to frame? See the header. The text was filtered: indices are
/// absolute and in range.
#include "io/obj_frame.hpp"

#include "io/text.hpp"

namespace setka::io::detail {

namespace {

constexpr std::uint32_t digit_base = 4096;  // exact in the floats of any reader

Float3 vector_of(TextCursor& words) {
    float values[3] = {};
    for (float& value : values) value = parse_float(words.word()).value_or(0);
    return {values[0], values[1], values[2]};
}

/// A number from 1 up, as one from 0 up.
std::uint32_t index_of(std::string_view word) {
    return static_cast<std::uint32_t>(parse_integer(word).value_or(1) - 1);
}

}  // namespace

ObjFrame parse_obj_frame(std::string_view filtered) {
    ObjFrame frame;
    for (TextCursor lines(filtered); !lines.at_end();) {
        TextCursor words(lines.line(), '#');
        const std::string_view keyword = words.word();
        if (keyword == "v") frame.positions.push_back(vector_of(words));
        if (keyword == "vn") frame.normals.push_back(vector_of(words));
        if (keyword != "f") continue;
        for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
            const std::size_t slash = word.find("//");
            frame.corners.push_back(index_of(word.substr(0, slash)));
            frame.corner_normals.push_back(slash == word.npos ? ObjFrame::no_normal
                                                              : index_of(word.substr(slash + 2)));
        }
        frame.face_ends.push_back(static_cast<std::uint32_t>(frame.corners.size()));
    }
    return frame;
}

std::string corner_numbers(std::string_view filtered) {
    std::string text = "# the corners of all faces, numbered\n";
    std::uint32_t corner = 0;
    for (TextCursor lines(filtered); !lines.at_end();) {
        const std::string_view line = lines.line();
        TextCursor words(line);
        const std::string_view keyword = words.word();
        if (keyword == "v" || keyword == "vn") continue;
        if (keyword != "f") {
            text.append(line).append("\n");
            continue;
        }
        std::string face = "f";
        for (std::string_view word = words.word(); !word.empty(); word = words.word(), ++corner) {
            text.append("v ").append(std::to_string(corner / digit_base / digit_base)).append(" ");
            text.append(std::to_string(corner / digit_base % digit_base)).append(" ");
            text.append(std::to_string(corner % digit_base)).append("\n");
            face.append(" ").append(std::to_string(corner + 1));
        }
        text.append(face).append("\n");
    }
    return text;
}

std::uint32_t corner_of(float x, float y, float z) {
    return (static_cast<std::uint32_t>(x) * digit_base + static_cast<std::uint32_t>(y)) * digit_base +
           static_cast<std::uint32_t>(z);
}

}  // namespace setka::io::detail
