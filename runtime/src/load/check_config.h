// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/formats/asset.h"
#include "knead/runtime/config.h"

namespace knead {

/// @return invalid_argument, with the name and value of the first member that is out of its documented range
Status check_config(const SimulationConfig& config, const Asset& asset);

}  // namespace knead
