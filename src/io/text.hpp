// SPDX-License-Identifier: MIT
/// How are numbers and words read from text? A cursor over bytes in memory, the same in every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace setka::io::detail {

/// The number that the whole of `word` spells, rounded to the nearest float; infinite if it is too large.
[[nodiscard]] std::optional<float> parse_float(std::string_view word);
/// The integer that the whole of `word` spells, with an optional sign.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);
/// Equality that ignores the case of ASCII letters.
[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);

/// Walks through text by words and lines.
class TextCursor {
  public:
    /// Text after `comment` up to the end of its line is skipped; 0: there are no comments.
    explicit TextCursor(std::string_view text, char comment = 0) : text_(text), comment_(comment) {}

    /// The next word, across lines; empty at the end.
    [[nodiscard]] std::string_view word();
    /// The next word of this line; empty at its end, which stays unread.
    [[nodiscard]] std::string_view word_of_line();
    /// The rest of this line without its end, which is passed.
    std::string_view line();
    [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }
    [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }

  private:
    enum class Skip { Blanks, BlanksAndLines };
    void skip(Skip what);
    std::string_view text_;
    std::size_t at_ = 0;
    char comment_;
};

}  // namespace setka::io::detail
