// SPDX-License-Identifier: MIT
/// What of an OBJ file does assimp get to see? Vertices, normals, faces, groups and materials, with indices
/// that were checked. assimp 5.2 refuses faces whose texture coordinates are missing, which are common and
/// never needed here; and it cannot say in which line an index is wrong.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <vector>

#include "io/file.hpp"
#include "io/readers.hpp"
#include "io/text.hpp"

namespace setka::io::detail {

namespace {

constexpr std::string_view kept_as_they_are[] = {"v", "vn", "o", "g", "usemtl", "mtllib"};

/// assimp compares the name at each use of a material with those before: this many comparisons take it some
/// seconds.
constexpr std::uint64_t max_name_comparisons = 100'000'000;

/// A backslash at the end of a line joins it with the next.
void join_lines(std::string& text) {
    for (std::size_t at = text.find('\\'); at != text.npos; at = text.find('\\', at + 1)) {
        const bool two = at + 2 < text.size() && text[at + 1] == '\r';
        const std::size_t end = at + (two ? 3 : 2);
        if (end <= text.size() && text[end - 1] == '\n') std::fill_n(&text[at], end - at, ' ');
    }
}

class ObjFilter {
  public:
    ObjFilter(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text) {}

    [[nodiscard]] std::string filter() {
        // Faces may come before their vertices, so all are counted first.
        for (TextCursor lines(text_); !lines.at_end();) {
            TextCursor words(lines.line(), '#');
            const std::string_view keyword = words.word();
            total_vertices_ += keyword == "v";
            total_normals_ += keyword == "vn";
            if (keyword == "v" && !has_colours_) has_colours_ = has_colour(words);
        }
        output_.reserve(text_.size());
        output_ = "# reduced to what is read\n";  // and longer than what assimp takes for a file
        for (TextCursor lines(text_); !lines.at_end();) {
            const std::string_view line = lines.line();
            ++line_number_;
            TextCursor words(line, '#');
            const std::string_view keyword = words.word();
            vertices_ += keyword == "v";
            normals_ += keyword == "vn";
            if (keyword == "usemtl") {
                TextCursor ahead = words;
                materials_.insert(name(ahead));
                name_comparisons_ += materials_.size();
                if (name_comparisons_ > max_name_comparisons)
                    fail("too many changes (" + std::to_string(material_changes_) +
                         ") between too many materials (" + std::to_string(materials_.size()) + ")");
                ++material_changes_;
            }
            if (keyword == "f") {
                add_face(words);
            } else if (std::ranges::find(kept_as_they_are, keyword) != std::end(kept_as_they_are)) {
                output_.append(keyword).append(" ").append(keyword[0] == 'v' ? number_words(words, keyword)
                                                                             : name(words));
                output_ += '\n';
            }
        }
        if (!has_face_) fail_read(file_, no_triangle);
        return std::move(output_);
    }

  private:
    [[noreturn]] void fail(const std::string& reason) const {
        fail_read(file_, "line " + std::to_string(line_number_) + ": " + reason);
    }

    /// What assimp 5.2 counts as a number, once a 0 is put before a point.
    [[nodiscard]] static bool is_counted(std::string_view word) {
        return (word[0] >= '0' && word[0] <= '9') || word[0] == '-' || word[0] == '+' || word[0] == '.';
    }

    [[nodiscard]] static bool has_colour(TextCursor& words) {
        std::size_t count = 0;
        for (std::string_view word = words.word(); !word.empty() && is_counted(word); word = words.word())
            ++count;
        return count >= 6;
    }

    /// assimp numbers the colours of a file one after the other, with none for a vertex that has no colour,
    /// but looks them up by the number of the vertex: so if one has a colour, all have. There is no form
    /// with both a weight and a colour.
    void add_white(std::vector<std::string>& numbers) const {
        if (numbers.size() == 4) {
            for (std::size_t i = 0; i < 3; ++i) numbers[i] = divide(numbers[i], numbers[3]);
            numbers.pop_back();
        }
        numbers.resize(6, "1");
    }

    [[nodiscard]] std::string divide(const std::string& number, const std::string& weight) const {
        const float divisor = parse_float(weight).value_or(0);
        if (divisor == 1) return number;
        const float quotient = parse_float(number).value_or(NAN) / divisor;
        if (!std::isfinite(quotient))
            fail("'v' stands at " + in_quotes(number, 40) + " / " + in_quotes(weight, 40) +
                 ", which is not finite");
        char text[32];
        return {text, std::to_chars(text, std::end(text), quotient).ptr};
    }

    /// The numbers of a vertex or a normal, single blanks between them. assimp counts words by its own rules,
    /// leaves out a vertex that has not 3, 4 (with a weight) or 6 (with a colour), and then takes other
    /// vertices for it.
    [[nodiscard]] std::string number_words(TextCursor& words, std::string_view keyword) const {
        std::vector<std::string> numbers;
        for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
            if (const std::optional<float> value = parse_float(word); value && !std::isfinite(*value))
                fail(in_quotes(word, 40) + " is not finite");
            if (!is_counted(word)) break;
            std::string number(word[0] == '.' ? 1 : 0, '0');
            number.append(word);
            numbers.push_back(std::move(number));
        }
        if (numbers.size() < 3)
            fail("'" + std::string(keyword) + "' is followed by " + std::to_string(numbers.size()) +
                 " numbers; at least 3 are needed");
        const bool is_vertex = keyword == "v";
        numbers.resize(is_vertex && numbers.size() >= 6 ? 6 : is_vertex && numbers.size() == 4 ? 4 : 3);
        if (is_vertex && has_colours_ && numbers.size() < 6) add_white(numbers);
        std::string text;
        for (const std::string& number : numbers) text.append(text.empty() ? "" : " ").append(number);
        return text;
    }

    [[nodiscard]] static std::string name(TextCursor& words) {
        const std::string_view rest = words.rest();
        const std::size_t begin = std::min(rest.find_first_not_of(" \t"), rest.size());
        return std::string(rest.substr(begin));
    }

    /// From 1 up, or from -1 down for the latest: what an index of OBJ means, numbered from 1; 0 if there is
    /// no such thing.
    [[nodiscard]] static std::uint64_t resolve(std::int64_t index, std::uint64_t so_far,
                                               std::uint64_t total) {
        if (index < 0)
            return static_cast<std::uint64_t>(-(index + 1)) < so_far
                       ? so_far + 1 - static_cast<std::uint64_t>(-index)
                       : 0;
        return static_cast<std::uint64_t>(index) <= total ? static_cast<std::uint64_t>(index) : 0;
    }

    /// A corner is v, v/vt, v//vn or v/vt/vn.
    void add_corner(std::string_view corner) {
        const std::size_t slash = std::min(corner.find('/'), corner.size());
        const std::optional<std::int64_t> index = parse_integer(corner.substr(0, slash));
        if (!index)
            fail(in_quotes(corner, 40) + " is no corner of a face; known are v, v/vt, v//vn and v/vt/vn");
        const std::uint64_t vertex = resolve(*index, vertices_, total_vertices_);
        if (vertex == 0)
            fail("vertex index " + std::to_string(*index) + " is out of range: there are " +
                 std::to_string(total_vertices_) + " vertices, numbered from 1, or from -1 backwards");
        face_.append(" ").append(std::to_string(vertex));
        ++corner_count_;
        const std::size_t second = slash < corner.size() ? corner.find('/', slash + 1) : corner.npos;
        if (second == corner.npos) return;
        // A normal that is not there counts as none given: normals are made then.
        const std::optional<std::int64_t> normal = parse_integer(corner.substr(second + 1));
        if (const std::uint64_t known = normal ? resolve(*normal, normals_, total_normals_) : 0)
            face_.append("//").append(std::to_string(known));
    }

    void add_face(TextCursor& words) {
        face_.assign(1, 'f');
        corner_count_ = 0;
        for (std::string_view word = words.word(); !word.empty(); word = words.word()) add_corner(word);
        if (corner_count_ < 3) return;
        has_face_ = true;
        output_.append(face_).append("\n");
    }

    const std::filesystem::path& file_;
    std::string_view text_;
    std::string output_, face_;
    std::set<std::string, std::less<>> materials_;
    std::uint64_t name_comparisons_ = 0, material_changes_ = 0;
    bool has_face_ = false;
    bool has_colours_ = false;  ///< some vertex has
    std::uint64_t line_number_ = 0, corner_count_ = 0;
    std::uint64_t vertices_ = 0, normals_ = 0, total_vertices_ = 0, total_normals_ = 0;
};

}  // namespace

std::string filter_obj(const std::filesystem::path& file, std::string text) {
    join_lines(text);
    return ObjFilter(file, text).filter();
}

}  // namespace setka::io::detail
