// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "knead/formats/session_log.h"
#include "knead/haptics/haptic_loop.h"
#include "knead/runtime/config.h"

namespace knead {

/// Every number of both configurations by name, in the order of the names. Precondition: exactly one tool.
[[nodiscard]] std::vector<SessionLog::Setting> settings_of(const HapticConfig& haptic,
                                                           const SimulationConfig& simulation);

}  // namespace knead
