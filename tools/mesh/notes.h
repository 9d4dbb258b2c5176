// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace knead::tools {

/// Something the user should hear about a mesh that is good enough to go on with: a repair, cells left out,
/// an unlikely size. The libraries collect them, the main says them.
struct Note {
    bool warning = false;  ///< true: the user probably has to do something about it
    std::string text;
};

using Notes = std::vector<Note>;

}  // namespace knead::tools
