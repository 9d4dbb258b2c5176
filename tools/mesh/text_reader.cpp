// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/text_reader.h"

#include <algorithm>
#include <charconv>

#include "common/error.h"

namespace knead::tools {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

template <class T>
bool convert(std::string_view word, T& value) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && end == word.data() + word.size();
}

}  // namespace

bool to_number(std::string_view word, double& value) {
    return convert(word, value);
}
bool to_integer(std::string_view word, std::int64_t& value) {
    return convert(word, value);
}

std::string in_quotes(std::string_view word) {
    constexpr std::size_t kMaxShown = 40;
    std::string shown = "\"";
    for (const char c : word.substr(0, kMaxShown))
        shown += (c >= ' ' && c <= '~') ? c : '?';
    return shown + (word.size() > kMaxShown ? "...\"" : "\"");
}

void TextReader::skip_blanks() {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (comment_ != 0 && c == comment_) {
            position_ = std::min(text_.find('\n', position_), text_.size());
            continue;
        }
        if (!is_blank(c)) return;
        if (c == '\n') ++line_;
        ++position_;
    }
}

std::string_view TextReader::next() {
    skip_blanks();
    const std::size_t start = position_;
    while (position_ < text_.size() && !is_blank(text_[position_]) &&
           (comment_ == 0 || text_[position_] != comment_))
        ++position_;
    return text_.substr(start, position_ - start);
}

std::string_view TextReader::peek() const {
    TextReader copy = *this;
    return copy.next();
}

std::string_view TextReader::rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view rest = text_.substr(position_, end - position_);
    if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
    if (end < text_.size()) ++line_;
    position_ = std::min(end + 1, text_.size());
    return rest;
}

std::string_view TextReader::word(const char* what) {
    const std::string_view found = next();
    if (found.empty()) fail(std::string("the file ends where ") + what + " should follow");
    return found;
}

double TextReader::number(const char* what) {
    const std::string_view found = word(what);
    double value = 0;
    if (!to_number(found, value)) fail(in_quotes(found) + " is not a number (" + what + ")");
    return value;
}

std::int64_t TextReader::integer(const char* what) {
    const std::string_view found = word(what);
    std::int64_t value = 0;
    if (!to_integer(found, value)) fail(in_quotes(found) + " is not an integer (" + what + ")");
    return value;
}

std::size_t TextReader::count(const char* what) {
    const std::int64_t value = integer(what);
    if (value < 0 || static_cast<std::uint64_t>(value) > bytes_left())
        fail(std::to_string(value) + " is not possible here (" + what + "): the file is too short for it");
    return static_cast<std::size_t>(value);
}

std::string_view TextReader::raw(std::size_t bytes, const char* what) {
    if (bytes > bytes_left()) fail(std::string("the file ends inside ") + what);
    const std::string_view block = text_.substr(position_, bytes);
    position_ += bytes;
    return block;
}

void TextReader::fail(const std::string& message) const {
    fail_input("line " + std::to_string(line_) + ": " + message);
}

}  // namespace knead::tools
