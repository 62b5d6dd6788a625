// SPDX-License-Identifier: MIT
/// What of an MTL file does assimp get to see? The statements that become a Material, complete ones only:
/// assimp 5.2 ends with a segmentation fault where a statement precedes the first material.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "io/readers.hpp"
#include "io/text.hpp"

namespace setka::io::detail {

namespace {

struct Statement {
    std::string_view keyword;
    std::size_t number_count;
};

constexpr std::array statements = {Statement{"Kd", 3}, Statement{"Ks", 3}, Statement{"Ke", 3},
                                   Statement{"Tf", 3}, Statement{"Ns", 1}, Statement{"Ni", 1},
                                   Statement{"d", 1},  Statement{"Tr", 1}, Statement{"illum", 1}};

/// As many as an OBJ file may use.
constexpr std::size_t max_materials = 10000;

/// The numbers of a statement as words; nothing if there are none or too few. "Kd 0.5" means "Kd 0.5 0.5
/// 0.5".
std::optional<std::string> numbers(TextCursor& words, std::size_t count) {
    std::vector<std::string_view> list;
    for (std::string_view word = words.word(); !word.empty() && list.size() < count; word = words.word()) {
        const std::optional<float> value = parse_float(word);
        if (!value || !std::isfinite(*value)) break;  // "d -halo 0.5", "Kd spectral file"
        list.push_back(word);
    }
    if (list.size() == 1) list.resize(count, list[0]);
    if (list.size() != count) return std::nullopt;
    std::string text;
    for (const std::string_view word : list) text.append(" ").append(word);
    return text;
}

/// The name in a statement: all that follows, since names hold blanks, or the last word after the options of
/// a texture.
std::string_view rest_of(TextCursor& words) {
    std::string_view rest = words.rest();
    rest = rest.substr(std::min(rest.find_first_not_of(" \t"), rest.size()));
    while (!rest.empty() && (rest.back() == ' ' || rest.back() == '\t')) rest.remove_suffix(1);
    const std::size_t blank = rest.find_last_of(" \t");
    return rest.starts_with('-') && blank != rest.npos ? rest.substr(blank + 1) : rest;
}

/// 3ds Max writes `d 1` and `Tr 1` for what is opaque: `Tr` is believed only where the material states no
/// `d`.
struct Transparency {
    std::string statement;  ///< the last Tr, held back
    bool has_d = false;

    [[nodiscard]] std::string_view believed() const { return has_d ? std::string_view() : statement; }
};

}  // namespace

std::string filter_mtl(std::string_view text) {
    std::string output = "# reduced to what is read\n";
    bool in_material = false;
    std::size_t count = 0;
    Transparency transparency;
    for (TextCursor lines(text); !lines.at_end();) {
        TextCursor words(lines.line());
        const std::string_view keyword = words.word();
        if (keyword == "newmtl") {
            output.append(transparency.believed());
            transparency = {};
            const std::string_view name = rest_of(words);
            in_material = !name.empty() && count++ < max_materials;
            // Defaults of our own; the exponent also tells a material that is defined from one that is only
            // used.
            if (in_material) output.append("newmtl ").append(name).append("\nKd 0.7 0.7 0.7\nNs 32\n");
        }
        if (!in_material) continue;
        if (const std::string_view name = keyword == "map_Kd" ? rest_of(words) : std::string_view();
            !name.empty())
            output.append("map_Kd ").append(name).append("\n");
        for (const Statement& statement : statements) {
            if (keyword != statement.keyword) continue;
            const auto values = numbers(words, statement.number_count);
            if (!values) continue;
            if (keyword == "Tr") {
                transparency.statement = "Tr" + *values + "\n";
                continue;
            }
            transparency.has_d = transparency.has_d || keyword == "d";
            output.append(keyword)
                .append(keyword == "Ns" && *parse_float(values->substr(1)) < 1 ? " 1" : *values)
                .append("\n");
        }
    }
    output.append(transparency.believed());
    return output;
}

}  // namespace setka::io::detail
