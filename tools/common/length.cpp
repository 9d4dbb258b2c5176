// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/length.h"

#include <cmath>
#include <exception>
#include <utility>

#include "common/error.h"

namespace knead::tools {

double metres_per_unit(const std::string& unit) {
    static const std::pair<const char*, double> kUnits[] = {
        {"m", 1.0}, {"dm", 1e-1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}, {"ft", 0.3048}};
    for (const auto& [name, metres] : kUnits)
        if (unit == name) return metres;
    fail_usage("\"" + unit + "\" is not a length unit (m, dm, cm, mm, um, in, ft)");
}

double parse_length_m(const std::string& text) {
    std::size_t used = 0;
    double number = 0;
    try {
        number = std::stod(text, &used);
    } catch (const std::exception&) {
        fail_usage("\"" + text + "\" is not a length (a number and a unit, such as 4mm)");
    }
    while (used < text.size() && text[used] == ' ')
        ++used;
    const double metres = number * (used == text.size() ? 1.0 : metres_per_unit(text.substr(used)));
    if (!std::isfinite(metres)) fail_usage("\"" + text + "\" is not a finite length");
    return metres;
}

}  // namespace knead::tools
