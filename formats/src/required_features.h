// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace knead {

/// Required features: what a file names that readers before it would take for something else or not at all.
inline constexpr const char* kCapsuleFeature = "capsule_tool";     ///< since 1.1
inline constexpr const char* kCoulombFeature = "coulomb_contact";  ///< since 1.1
inline constexpr std::array<const char*, 2> kKnownFeatures{kCapsuleFeature, kCoulombFeature};

}  // namespace knead
