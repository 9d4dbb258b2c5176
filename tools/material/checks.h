// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "knead/formats/material.h"

namespace knead::tools {

// Why a value is none of an elastic solid; nothing when it may be one. The text completes "values of ...
// are".
[[nodiscard]] std::optional<std::string> why_not_poissons_ratio(double value);
/// For Young's modulus, density and mass alike.
[[nodiscard]] std::optional<std::string> why_not_positive(double value);

/// Refuses values that no elastic solid has, with the reason and the first tetrahedra (counted from 0):
/// E not finite or <= 0, nu outside (-1, 0.5), density not finite or <= 0.
/// @throws bad_input
void require_physical(const Material& material);

}  // namespace knead::tools
