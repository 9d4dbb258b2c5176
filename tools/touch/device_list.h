// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "touch/device_presets.h"

namespace knead::tools {

/// A table of devices for a person, one a line; "~" stands before numbers that are assumed.
[[nodiscard]] std::string device_list_text(const std::vector<DevicePreset>& presets);

}  // namespace knead::tools
