// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace knead::tools {

/// Writes JSON text piece by piece. knead-asset also builds where nlohmann-json is absent (lean preset).
/// The caller opens and closes in pairs; commas and indentation are kept here.
class JsonWriter {
  public:
    JsonWriter& open_object(std::string_view key = {}) { return open(key, '{'); }
    JsonWriter& close_object() { return close('}'); }
    JsonWriter& open_array(std::string_view key = {}) { return open(key, '['); }
    JsonWriter& close_array() { return close(']'); }
    JsonWriter& text(std::string_view key, std::string_view value);
    JsonWriter& number(std::string_view key, std::uint64_t value);
    JsonWriter& number(std::string_view key, double value);  ///< precondition: finite
    JsonWriter& boolean(std::string_view key, bool value);

    [[nodiscard]] std::string take() { return std::move(text_) + "\n"; }

  private:
    JsonWriter& open(std::string_view key, char bracket);
    JsonWriter& close(char bracket);
    void start(std::string_view key);

    std::string text_;
    std::size_t depth_ = 0;
    bool first_ = true;
};

/// `text` as a JSON string with its quotes. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_string(std::string_view text);

}  // namespace knead::tools
