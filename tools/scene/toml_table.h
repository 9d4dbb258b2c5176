// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/formats/asset.h"

#include <toml++/toml.h>

namespace knead::tools {

/// A TOML table that is read strictly: a value of the wrong type, a bad length or a key that nobody asked for
/// is an error with file and line. Remembers which keys were asked for; finish() refuses the others.
class TomlTable {
  public:
    /// @param path how messages call the table: "level[2]", or empty for the root
    TomlTable(const toml::table& table, std::string file, std::string path)
        : table_(&table), file_(std::move(file)), path_(std::move(path)) {}

    [[nodiscard]] bool has(std::string_view key);
    [[nodiscard]] std::uint32_t line_of(std::string_view key) const;
    [[nodiscard]] std::uint32_t line() const { return table_->source().begin.line; }

    [[nodiscard]] std::optional<std::string> text(std::string_view key);
    [[nodiscard]] std::optional<bool> flag(std::string_view key);
    [[nodiscard]] std::optional<double> number(std::string_view key);
    [[nodiscard]] std::optional<std::uint64_t> count(std::string_view key);  ///< >= 0
    /// A number in metres, or text with a unit ("4mm").
    [[nodiscard]] std::optional<double> length_m(std::string_view key);
    [[nodiscard]] std::vector<double> numbers(std::string_view key);    ///< number or array of numbers
    [[nodiscard]] std::vector<double> lengths_m(std::string_view key);  ///< length or array of lengths
    [[nodiscard]] std::optional<Point> point_m(std::string_view key);
    /// One of `choices`; the error lists them and the nearest.
    [[nodiscard]] std::optional<std::string> choice(std::string_view key,
                                                    const std::vector<std::string>& choices);
    [[nodiscard]] std::optional<TomlTable> table(std::string_view key);
    [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);  ///< array of tables; empty if absent
    [[nodiscard]] const toml::array* array(std::string_view key);
    /// Keys of a table whose keys are names of the user's own.
    [[nodiscard]] std::vector<std::string> keys() const;

    /// Refuses keys that were never asked for.
    void finish() const;

    /// Refuses the table because `key` is not there; names a misspelling of it if there is one.
    [[noreturn]] void fail_missing(std::string_view key, const std::string& message = "is required") const;
    [[noreturn]] void fail(std::string_view key, const std::string& message) const;
    [[nodiscard]] std::string name_of(std::string_view key) const;

  private:
    [[noreturn]] void fail_unknown(const toml::key& key, const std::string& near) const;
    const toml::node* find(std::string_view key);
    double length_of(const toml::node& node, std::string_view key) const;

    const toml::table* table_;
    std::string file_;
    std::string path_;
    std::vector<std::string> known_;
};

/// Parses a whole file. Throws ToolError(bad_input) "file:line: ...": not TOML, or a key of more than 64
/// parts
/// ("a.b.c" has three), because tables in tables without end would end our stack.
/// @param file what messages call it
[[nodiscard]] toml::table parse_toml(std::string_view text, const std::string& file);

/// The entry of `known` with the smallest edit distance to `word`; empty if none is near.
[[nodiscard]] std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace knead::tools
