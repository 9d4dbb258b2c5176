// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace knead::bench {

/// What the figures were measured on.
struct Machine {
    std::string cpu, isa, compiler, flags, os;
    int core = -1;  ///< that the process is pinned to; -1: none
};

/// @param core to pin this process to, or nothing
/// @throws std::runtime_error when the system refuses
[[nodiscard]] Machine describe_machine(std::optional<int> core);

}  // namespace knead::bench
