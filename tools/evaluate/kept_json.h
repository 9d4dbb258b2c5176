// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace knead::tools {

/// Fills `result` when `read` finds all of it in a text of the cache; else leaves it as it is: the text is of
/// another version of the program, or not ours.
/// @param read  throws a std::exception where something is missing or of another type
template <class T>
[[nodiscard]] bool read_kept(const std::string& text, void (*read)(const nlohmann::ordered_json&, T&),
                             T& result) {
    T found = result;
    try {
        read(nlohmann::ordered_json::parse(text), found);
    } catch (const std::exception&) {
        return false;
    }
    result = std::move(found);
    return true;
}

}  // namespace knead::tools
