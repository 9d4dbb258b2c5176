// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "common/error.h"

namespace knead::tools {
namespace {

struct Line {
    std::size_t number;  ///< from 1
    std::string_view text;
};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    while (true) {
        const std::size_t comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

bool is_header(std::string_view line) {
    const auto fields = fields_of(line);
    return std::none_of(fields.begin(), fields.end(),
                        [](std::string_view field) { return parse_number(field).has_value(); });
}

/// The rows of a text, without the header and the blank end.
std::vector<Line> rows_of(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
    std::vector<Line> lines;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        lines.push_back({number, trimmed(text.substr(0, end))});
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    while (!lines.empty() && lines.back().text.empty())
        lines.pop_back();
    if (!lines.empty() && !lines[0].text.empty() && is_header(lines[0].text)) lines.erase(lines.begin());
    if (lines.empty()) fail_input("there are no values");
    return lines;
}

double number_of(std::string_view field, std::size_t line) {
    const auto number = parse_number(field);
    if (!number) fail_input(fmt::format("line {}: \"{}\" is not a number", line, field));
    return *number;
}

std::string_view unquoted(std::string_view name) {
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') return name.substr(1, name.size() - 2);
    return name;
}

[[noreturn]] void refuse_region_option(std::string_view text) {
    fail_usage(fmt::format("--region \"{}\" is not NAME=E,NU,DENSITY", text));
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
    text = trimmed(text);
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

ValueTable parse_value_csv(std::string_view text) {
    ValueTable table;
    std::size_t columns = 0;
    for (const Line& line : rows_of(text)) {
        if (line.text.empty()) fail_input(fmt::format("line {}: is empty", line.number));
        const auto fields = fields_of(line.text);
        if (columns == 0) columns = fields.size();
        if (columns != 1 && columns != 3)
            fail_input(fmt::format("line {}: {} columns; there must be one (E) or three (E, nu, density)",
                                   line.number, fields.size()));
        if (fields.size() != columns)
            fail_input(fmt::format("line {}: {} columns where the lines before have {}", line.number,
                                   fields.size(), columns));
        table.youngs_modulus_pa.push_back(number_of(fields[0], line.number));
        if (columns == 1) continue;
        table.poissons_ratio.push_back(number_of(fields[1], line.number));
        table.density_kg_per_m3.push_back(number_of(fields[2], line.number));
    }
    return table;
}

std::vector<RegionValues> parse_region_csv(std::string_view text) {
    std::vector<RegionValues> regions;
    for (const Line& line : rows_of(text)) {
        if (line.text.empty()) fail_input(fmt::format("line {}: is empty", line.number));
        // The numbers are the last three fields; what is left in front of them is the name.
        std::string_view rest = line.text;
        std::array<double, 3> values{};
        for (std::size_t i = values.size(); i-- > 0;) {
            const std::size_t comma = rest.rfind(',');
            if (comma == std::string_view::npos)
                fail_input(fmt::format("line {}: must be region,E,nu,density", line.number));
            values[i] = number_of(trimmed(rest.substr(comma + 1)), line.number);
            rest = rest.substr(0, comma);
        }
        regions.push_back({std::string(unquoted(trimmed(rest))), values[0], values[1], values[2]});
    }
    return regions;
}

RegionValues parse_region_option(std::string_view text) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string_view::npos || equals == 0) refuse_region_option(text);
    const auto fields = fields_of(text.substr(equals + 1));
    if (fields.size() != 3) refuse_region_option(text);
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto number = parse_number(fields[i]);
        if (!number) refuse_region_option(text);
        values[i] = *number;
    }
    return {std::string(text.substr(0, equals)), values[0], values[1], values[2]};
}

}  // namespace knead::tools
