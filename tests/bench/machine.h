// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "baseline/machine.h"

namespace knead::bench {

/// What the figures were measured on, and with which instructions.
struct Machine : baseline::Machine {
    std::string isa, flags;
    int core = -1;  ///< that the process is pinned to; -1: none
};

/// @param core to pin this process to, or nothing
/// @throws std::runtime_error when the system refuses
[[nodiscard]] Machine describe_machine(std::optional<int> core);

}  // namespace knead::bench
