// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/formats/asset.h"
#include "knead/formats/result.h"

namespace knead {

/// What a step multiplies must neither vanish nor overflow in float32: volume, mass, stiffness and energy of
/// every tetrahedron are in [1e-30, 1e30]. Objects outside of it are mistakes of units.
/// @return invalid_data, with the first tetrahedra concerned
[[nodiscard]] Status check_numbers(const Asset& asset);

}  // namespace knead
