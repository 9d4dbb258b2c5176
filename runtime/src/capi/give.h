// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "knead/knead.h"
#include "knead/runtime/pose.h"

namespace knead::capi {

inline knead_pose to_c(const Pose& pose) noexcept {
    knead_pose result;
    std::copy_n(pose.position_m.begin(), 3, result.position_m);
    std::copy_n(pose.orientation_wxyz.begin(), 4, result.orientation_wxyz);
    return result;
}

/// Into the caller's struct, which may be of an older or newer version: what both know.
template <class T>
void give(T ours, std::size_t their_size, void* theirs) noexcept {
    ours.struct_size = their_size;
    std::memcpy(theirs, &ours, std::min(their_size, sizeof(T)));
}

}  // namespace knead::capi
