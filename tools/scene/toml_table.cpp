// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/toml_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "common/error.h"
#include "common/length.h"

namespace knead::tools {
namespace {

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j)
        d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

/// Refuses keys of many parts before the parser sees them: it makes a table of each part, and tables are
/// destroyed one inside the other. Counts dots with something before them that a key can be made of. A text
/// value or a comment with as many dots and nothing else between them is refused as well.
void require_short_keys(std::string_view text, const std::string& file) {
    constexpr int kMostDots = 64;
    constexpr std::string_view kKeyBytes = "_-\"' \t";
    std::uint32_t line = 1;
    int dots = 0;
    for (const char c : text) {
        if (c == '\n') ++line;
        if (c == '.' && ++dots > kMostDots)
            fail_input(fmt::format("{}:{}: a key of more than {} parts", file, line, kMostDots));
        const bool other = static_cast<unsigned char>(c) >= 0x80;  // letters of other scripts, in quotes
        const bool of_key = std::isalnum(static_cast<unsigned char>(c)) != 0 || other || c == '.' ||
                            kKeyBytes.find(c) != std::string_view::npos;
        if (!of_key) dots = 0;
    }
}

/// toml++'s own conversion has no answer for whole numbers that a double cannot hold exactly.
double number_of(const toml::node& node) {
    if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
    return node.as_floating_point()->get();
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file) {
    require_short_keys(text, file);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        fail_input(
            fmt::format("{}:{}: not valid TOML: {}", file, error.source().begin.line, error.description()));
    }
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
    std::string best;
    std::size_t best_distance = word.size() / 2 + 1;  // farther away is no help
    for (const std::string& candidate : known) {
        const std::size_t longer = std::max(word.size(), candidate.size());
        if (longer - std::min(word.size(), candidate.size()) >= best_distance) continue;  // at least so far
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

const toml::node* TomlTable::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
    return table_->get(key);
}

bool TomlTable::has(std::string_view key) {
    return find(key) != nullptr;
}

std::uint32_t TomlTable::line_of(std::string_view key) const {
    const toml::node* node = table_->get(key);
    return node != nullptr ? node->source().begin.line : line();
}

std::string TomlTable::name_of(std::string_view key) const {
    if (path_.empty() || key.empty()) return path_ + std::string(key);
    return path_ + "." + std::string(key);
}

void TomlTable::fail(std::string_view key, const std::string& message) const {
    fail_input(fmt::format("{}:{}: {} {}", file_, line_of(key), name_of(key), message));
}

std::optional<std::string> TomlTable::text(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_string()) fail(key, "must be text in quotes");
    return node->as_string()->get();
}

std::optional<bool> TomlTable::flag(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_boolean()) fail(key, "must be true or false");
    return node->as_boolean()->get();
}

std::optional<double> TomlTable::number(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_number() || !std::isfinite(number_of(*node))) fail(key, "must be a finite number");
    return number_of(*node);
}

std::optional<std::uint64_t> TomlTable::count(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_integer() || node->as_integer()->get() < 0) fail(key, "must be a whole number, 0 or more");
    return static_cast<std::uint64_t>(node->as_integer()->get());
}

double TomlTable::length_of(const toml::node& node, std::string_view key) const {
    if (node.is_number()) {
        const double metres = number_of(node);
        if (std::isfinite(metres)) return metres;
    } else if (node.is_string()) {
        try {
            return parse_length_m(node.as_string()->get());
        } catch (const ToolError& error) {
            fail(key, error.what());
        }
    }
    fail(key, "must be a length: a number of metres, or text with a unit such as \"4mm\"");
}

std::optional<double> TomlTable::length_m(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    return length_of(*node, key);
}

std::vector<double> TomlTable::numbers(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    if (!node->is_array()) return {*number(key)};
    std::vector<double> values;
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_number() || !std::isfinite(number_of(entry)))
            fail(key, "must be an array of finite numbers");
        values.push_back(number_of(entry));
    }
    return values;
}

std::vector<double> TomlTable::lengths_m(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    if (!node->is_array()) return {length_of(*node, key)};
    std::vector<double> values;
    for (const toml::node& entry : *node->as_array())
        values.push_back(length_of(entry, key));
    return values;
}

std::optional<Point> TomlTable::point_m(std::string_view key) {
    if (!has(key)) return std::nullopt;
    const std::vector<double> values = lengths_m(key);
    if (values.size() != 3) fail(key, "must be three lengths [x, y, z]");
    return Point{values[0], values[1], values[2]};
}

std::optional<std::string> TomlTable::choice(std::string_view key, const std::vector<std::string>& choices) {
    const auto value = text(key);
    if (!value || std::find(choices.begin(), choices.end(), *value) != choices.end()) return value;
    const std::string near = nearest_word(*value, choices);
    fail(key, fmt::format("= \"{}\" is none of {}{}", *value, fmt::join(choices, ", "),
                          near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) fail(key, "must be a table");
    return TomlTable(*node->as_table(), file_, name_of(key));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    if (!node->is_array()) fail(key, fmt::format("must be an array of tables: [[{}]]", key));
    std::vector<TomlTable> result;
    for (const toml::node& entry : *node->as_array()) {
        if (!entry.is_table()) fail(key, fmt::format("must be an array of tables: [[{}]]", key));
        result.emplace_back(*entry.as_table(), file_, fmt::format("{}[{}]", name_of(key), result.size()));
    }
    return result;
}

const toml::array* TomlTable::array(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return nullptr;
    if (!node->is_array()) fail(key, "must be an array");
    return node->as_array();
}

std::vector<std::string> TomlTable::keys() const {
    std::vector<std::string> names;
    for (const auto& [key, node] : *table_)
        names.emplace_back(key.str());
    return names;
}

void TomlTable::fail_unknown(const toml::key& key, const std::string& near) const {
    fail_input(fmt::format("{}:{}: unknown key \"{}\"{}", file_, key.source().begin.line, name_of(key.str()),
                           near.empty() ? "" : "; did you mean \"" + name_of(near) + "\"?"));
}

void TomlTable::fail_missing(std::string_view key, const std::string& message) const {
    for (const auto& [present, node] : *table_) {
        const bool known = std::find(known_.begin(), known_.end(), present.str()) != known_.end();
        if (!known && !nearest_word(present.str(), {std::string(key)}).empty())
            fail_unknown(present, std::string(key));
    }
    fail(key, message);
}

void TomlTable::finish() const {
    for (const auto& [key, node] : *table_)
        if (std::find(known_.begin(), known_.end(), key.str()) == known_.end())
            fail_unknown(key, nearest_word(key.str(), known_));
}

}  // namespace knead::tools
