// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace knead::tools {

/// Something about an object that its maker should know. Nothing is ever repaired because of it.
struct Finding {
    bool warning = true;  ///< false: worth knowing, nothing to do
    std::string id;       ///< never changes its meaning: docs/quality.md explains each
    double number = 0;    ///< what was measured, in `unit`
    std::string unit;     ///< empty: a ratio or a count
    std::string text;     ///< what is the matter, with the number
    std::string advice;   ///< what to do about it
};

using Findings = std::vector<Finding>;

}  // namespace knead::tools
