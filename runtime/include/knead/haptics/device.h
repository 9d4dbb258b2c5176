// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// What a haptic device says at one moment, in the device's own frame. SI units.
struct DeviceState {
    Pose pose;
    Vec3 velocity_m_per_s{};    ///< as the device measures it; zero if it does not
    std::uint32_t buttons = 0;  ///< one bit each
    double time_s = 0;          ///< on the device's clock
};

/// A haptic device: gives a pose, takes a force (impedance causality). Adapters of real devices implement it.
///
/// Both functions are called by the haptic loop once a period: they must not block, allocate or throw.
class KNEAD_HAPTICS_API Device {
  public:
    virtual ~Device() = default;
    [[nodiscard]] virtual DeviceState read() noexcept = 0;
    /// @param force_n, torque_n_m on the hand, device frame; always finite and within the loop's limit
    virtual void write(const Vec3& force_n, const Vec3& torque_n_m) noexcept = 0;

  protected:
    Device() = default;
    Device(const Device&) = default;
    Device& operator=(const Device&) = default;
};

}  // namespace knead
