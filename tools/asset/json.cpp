// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset/json.h"

#include <charconv>

namespace knead::tools {
namespace {

template <class T>
std::string digits(T value) {
    char buffer[64];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

/// Bytes of the UTF-8 character at `i`, or 0 when there is none (RFC 3629).
std::size_t utf8_length(std::string_view text, std::size_t i) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned char first = byte(i);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                               : (first & 0xf0) == 0xe0        ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    if (length == 0 || i + length > text.size()) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(i + k) & 0xc0) != 0x80) return 0;
    const unsigned char second = byte(i + 1);
    const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const bool outside = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
    return overlong || outside ? 0 : length;
}

}  // namespace

std::string json_string(std::string_view text) {
    std::string quoted = "\"";
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        const std::size_t length = utf8_length(text, i);
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || c == '\x7f') {
            const char* const hex = "0123456789abcdef";
            quoted += "\\u00";
            quoted += hex[c >> 4];
            quoted += hex[c & 15];
        } else {
            quoted += length == 0 ? std::string_view("\\ufffd") : text.substr(i, length);
        }
        i += length == 0 ? 1 : length;
    }
    return quoted + '"';
}

void JsonWriter::start(std::string_view key) {
    if (!first_) text_ += ',';
    if (depth_ > 0) text_ += '\n';
    text_.append(2 * depth_, ' ');
    if (!key.empty()) text_.append(json_string(key)).append(": ");
    first_ = false;
}

JsonWriter& JsonWriter::open(std::string_view key, char bracket) {
    start(key);
    text_ += bracket;
    ++depth_;
    first_ = true;
    return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
    --depth_;
    if (!first_) {
        text_ += '\n';
        text_.append(2 * depth_, ' ');
    }
    text_ += bracket;
    first_ = false;
    return *this;
}

JsonWriter& JsonWriter::text(std::string_view key, std::string_view value) {
    start(key);
    text_ += json_string(value);
    return *this;
}

JsonWriter& JsonWriter::number(std::string_view key, std::uint64_t value) {
    start(key);
    text_ += digits(value);
    return *this;
}

JsonWriter& JsonWriter::number(std::string_view key, double value) {
    start(key);
    text_ += digits(value);
    return *this;
}

JsonWriter& JsonWriter::boolean(std::string_view key, bool value) {
    start(key);
    text_ += value ? "true" : "false";
    return *this;
}

}  // namespace knead::tools
