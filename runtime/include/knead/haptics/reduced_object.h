// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "knead/haptics/coupling.h"
#include "knead/haptics/export.h"
#include "knead/runtime/local_model.h"
#include "knead/runtime/pose.h"

namespace knead {

/// The object as one tool feels it, small enough for the haptic rate: mass, damping and stiffness in the
/// space of the contact (LocalModel), driven by the hand through the coupling.
///
/// In contact, proxy and contact patch are one body at q. With d its twist from the model's origin, v its
/// velocity, h the hand's pose, w the hand's velocity:
///
///     (m + M) v' = load + bias - K d - B v + k (h - q) + b (w - v)
///
/// by one implicit Euler step a haptic period: positive definite, bounded for any dt. The wrench on the hand
/// is the coupling's, k (q - h) + b (v - w): it follows q, which never jumps.
///
/// `bias` takes up the difference between the old model and a new one where the proxy is, and then fades by
/// `correction_gain` every simulation period: a result corrects the object without a step of the force.
///
/// A tool that may leave (unilateral) does where the object would have to pull it along the normal. Then the
/// patch goes back on its own, with its own mass and damping, and the two may meet again: the surface of the
/// last contact is remembered until a result contradicts it.
///
/// Nothing here allocates, locks or throws. One thread at a time. Source: docs/haptics.md.
class KNEAD_HAPTICS_API ReducedObject {
  public:
    struct Config {
        CouplingConfig coupling;
        double correction_gain = 0.2;  ///< of the difference, gone one simulation period later, (0, 1]
    };
    explicit ReducedObject(const Config& config) noexcept;

    /// Proxy at the hand, at rest; no object.
    void reset(const Pose& hand) noexcept;
    /// Takes a result. One that is not finite or has step 0 is ignored.
    /// @param period_s expected until the next one  @return whether it was taken
    bool correct(const LocalModel& model, double period_s) noexcept;
    /// One haptic period. @param hand at its end  @return on the hand, scene frame
    Wrench advance(const Pose& hand, double dt_s) noexcept;

    [[nodiscard]] const Pose& tool() const noexcept { return tool_; }  ///< where the proxy is
    [[nodiscard]] bool in_contact() const noexcept { return in_contact_; }

  private:
    void lower_to(const LocalModel& model) noexcept;
    void meet(const LocalModel& model) noexcept;
    template <int N>
    Wrench advance_by(const Pose& hand, double dt_s) noexcept;

    Config config_;
    LocalModel model_;  ///< step 0: no object
    double period_s_ = 0;
    Pose hand_, tool_;
    std::array<double, 6> velocity_{};  ///< of the proxy: m/s, rad/s
    std::array<double, 6> bias_{};      ///< N, N m
    bool in_contact_ = false;
    double patch_m_ = 0;  ///< from the model's origin along its normal, while proxy and patch are apart
    double patch_m_per_s_ = 0;
};

/// The classical local model, as engines with a VRPN-style force feedback take it:
/// force = force_n - stiffness * (position - origin), fair up to radius_m from the origin and while the stamp
/// is young. Its stiffness is symmetric and positive semidefinite: it gives out no energy of its own.
struct LinearView {
    Vec3 origin_m{};
    Vec3 force_n{};
    std::array<double, 9> stiffness_n_per_m{};  ///< [3][3]
    Mat6 stiffness{};                           ///< [6][6], with the rotations
    Vec3 normal{};                              ///< LocalModel::normal
    double radius_m = 0;
    bool unilateral = false;
    std::uint64_t stamp = 0;  ///< LocalModel::step; 0: no model
};

/// Of the object alone.
[[nodiscard]] KNEAD_HAPTICS_API LinearView linear_view(const LocalModel& model) noexcept;
/// As a hand feels the object through the translation's spring, at rest.
/// @param hand_m where the hand is  @param coupling_force_n what it feels there
[[nodiscard]] KNEAD_HAPTICS_API LinearView linear_view(const LocalModel& model, double coupling_n_per_m,
                                                       const Vec3& hand_m,
                                                       const Vec3& coupling_force_n) noexcept;
/// Beyond the radius as on it; never a pull along the normal where the tool may leave.
[[nodiscard]] KNEAD_HAPTICS_API Vec3 force_at(const LinearView& view, const Vec3& position_m) noexcept;

}  // namespace knead
