// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "knead/formats/asset.h"

namespace knead {

/// How files, scenes and programs spell the enumerators of ToolShape and ToolContact, in their order.
inline constexpr std::array<const char*, 3> kToolShapes{"plate", "sphere", "capsule"};
inline constexpr std::array<const char*, 4> kToolContacts{"bonded", "sticking", "frictionless", "coulomb"};

inline const char* name_of(ToolShape shape) {
    return kToolShapes[static_cast<std::size_t>(shape)];
}

inline const char* name_of(ToolContact contact) {
    return kToolContacts[static_cast<std::size_t>(contact)];
}

}  // namespace knead
