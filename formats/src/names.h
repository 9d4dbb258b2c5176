// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace knead {

/// How files spell the enumerators of ToolShape and ToolContact, in their order.
inline constexpr std::array<const char*, 2> kToolShapes{"plate", "sphere"};
inline constexpr std::array<const char*, 3> kToolContacts{"bonded", "sticking", "frictionless"};

}  // namespace knead
