// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/outline.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "common/error.h"
#include "mesh/text_reader.h"

namespace knead::tools {
namespace {

/// Each side is held against each other one: more would take minutes.
constexpr std::size_t kMostCorners = 10'000;

using Corner = std::array<double, 2>;

double side(const Corner& a, const Corner& b, const Corner& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool cross(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

void require_simple(const std::vector<Corner>& corners) {
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j)
            if (cross(corners[i], corners[(i + 1) % n], corners[j], corners[(j + 1) % n]))
                fail_input(fmt::format(
                    "the outline crosses itself: the sides after corners {} and {} (from 1)", i + 1, j + 1));
}

}  // namespace

std::vector<Corner> read_outline(std::string_view content) {
    TextReader reader(content);
    std::vector<Corner> corners;
    while (reader.bytes_left() > 0) {
        const std::size_t line = reader.line();
        std::string text(reader.rest_of_line());
        text = text.substr(0, text.find('#'));
        const std::size_t comma = text.find(',');
        if (comma != std::string::npos) text[comma] = ' ';
        TextReader words(text);
        if (words.at_end()) continue;
        Corner corner{};
        if (!to_number(words.next(), corner[0]) || !to_number(words.next(), corner[1]) || !words.at_end() ||
            !std::isfinite(corner[0]) || !std::isfinite(corner[1]))
            fail_input(fmt::format("line {}: two finite numbers, x and y, should stand here", line));
        if (!corners.empty() && corners.back() == corner)
            fail_input(fmt::format("line {}: the same corner twice in a row", line));
        if (corners.size() == kMostCorners)
            fail_input(fmt::format("line {}: more than {} corners", line, kMostCorners));
        corners.push_back(corner);
    }
    if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3) fail_input("an outline needs at least three corners");
    require_simple(corners);
    return corners;
}

}  // namespace knead::tools
