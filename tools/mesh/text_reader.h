// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace knead::tools {

/// Reads blank-separated words and numbers of a text held in memory, and knows the line it is on.
/// Everything that does not fit is a ToolError bad_input that names the line (from 1).
class TextReader {
  public:
    /// @param comment a character that hides the rest of its line; 0 for none
    explicit TextReader(std::string_view text, char comment = 0) : text_(text), comment_(comment) {}

    /// The next word, or an empty view at the end of the text.
    std::string_view next();
    /// The next word without taking it.
    [[nodiscard]] std::string_view peek() const;
    /// The rest of the current line, without its end; moves to the next line.
    std::string_view rest_of_line();
    /// The next word, which must be there. `what` names it in the message.
    std::string_view word(const char* what);
    double number(const char* what);
    std::int64_t integer(const char* what);
    /// An integer in 0 .. (bytes left), a bound that no honest count of things to read passes.
    std::size_t count(const char* what);

    [[nodiscard]] bool at_end() const { return peek().empty(); }
    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] std::size_t bytes_left() const { return text_.size() - position_; }
    /// Moves over `bytes` raw bytes and returns them: binary blocks inside a text. Throws when too few are
    /// left.
    std::string_view raw(std::size_t bytes, const char* what);

    [[noreturn]] void fail(const std::string& message) const;

  private:
    void skip_blanks();

    std::string_view text_;
    char comment_;
    std::size_t position_ = 0;
    std::size_t line_ = 1;
};

/// The whole word as a number; false when it is none. Accepts a leading '+', nan and inf (checked later).
[[nodiscard]] bool to_number(std::string_view word, double& value);
[[nodiscard]] bool to_integer(std::string_view word, std::int64_t& value);

/// A word of a file as it may stand in a message: quoted, at most 40 characters, without control characters.
[[nodiscard]] std::string in_quotes(std::string_view word);

}  // namespace knead::tools
