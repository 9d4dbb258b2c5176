// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace knead::baseline {

/// What times were measured on.
struct Machine {
    std::string cpu, compiler, os;
    double load_average = 0;  ///< of the last minute, when asked
};
[[nodiscard]] Machine describe_machine();

}  // namespace knead::baseline
