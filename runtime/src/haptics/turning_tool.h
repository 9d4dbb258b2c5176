// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/haptics/coupling.h"
#include "knead/runtime/local_model.h"
#include "knead/runtime/pose.h"

namespace knead {

/// The proxy's orientation in a synchronous loop: it follows the hand's through the rotational spring and
/// damper, against the object's torque. (The translation's coupling is solved with the object, in its step.)
///
/// One implicit Euler step a period of (I + J) w' = torque - K a - B w + k (hand - a) + b (hand' - w), with
/// J, B, K the rotational blocks of the object's local model and a the turn since the torque was found:
/// bounded for any dt, where the torque of the step before alone would be unstable against a stiff object.
class TurningTool {
  public:
    explicit TurningTool(const CouplingConfig& config) noexcept : config_(config) {}

    /// Zero stiffness: the tool has the hand's orientation.
    [[nodiscard]] bool turns() const noexcept { return config_.rotation_stiffness_nm_per_rad > 0; }
    void reset(const Pose& hand) noexcept;
    /// The object at the present orientation. @param torque_nm of the step
    void touch(const Vec3& torque_nm, const LocalModel& model) noexcept;
    /// One period. @param hand at its end
    void advance(const Pose& hand, double dt_s) noexcept;

    [[nodiscard]] const std::array<double, 4>& orientation_wxyz() const noexcept {
        return tool_.orientation_wxyz;
    }
    [[nodiscard]] const Vec3& torque_nm() const noexcept { return felt_; }  ///< of the coupling on the hand

  private:
    CouplingConfig config_;
    Pose tool_, hand_;
    Vec3 velocity_{}, torque_{}, felt_{};
    std::array<double, 9> stiffness_{}, damping_{}, inertia_{};  ///< [3][3], symmetric
};

}  // namespace knead
