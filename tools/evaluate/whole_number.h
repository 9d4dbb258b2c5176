// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace knead::tools {

/// A count in a file that need not be ours. json.get<T>() would take true for 1 and cut whatever T cannot
/// hold, which for numbers with a fraction or an exponent is undefined.
/// @throws std::exception when it is not a whole number of 0 to the largest T
template <class T>
[[nodiscard]] T whole_number(const nlohmann::ordered_json& json) {
    if (!json.is_number_unsigned()) throw std::invalid_argument("not a whole number");
    const auto number = json.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<T>::max()))
        throw std::out_of_range("a number is too large");
    return static_cast<T>(number);
}

}  // namespace knead::tools
