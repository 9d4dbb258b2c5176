// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/formats/result.h"
#include "knead/haptics/export.h"
#include "knead/haptics/passivity.h"
#include "knead/haptics/safety/engage_ramp.h"
#include "knead/haptics/safety/motion_check.h"
#include "knead/haptics/safety/slew_limit.h"
#include "knead/haptics/safety/watchdog.h"
#include "knead/haptics/status.h"
#include "knead/runtime/pose.h"

namespace knead {

/// Limits of what reaches the hand; docs/safety.md says why each default is what it is. They suit a small
/// desktop device (Geomagic Touch: 3.3 N, 400 N/m, no torque motors). Torque limits are the force limits at
/// 45 mm.
struct SafetyConfig {
    double max_force_n = 3.3;              ///< largest norm of the force, > 0
    double max_torque_nm = 0.15;           ///< largest norm of the torque, >= 0; 0: no torque is written
    double slew_n_per_ms = 1;              ///< largest change of the force, norm of the difference, > 0
    double slew_nm_per_ms = 0.05;          ///< likewise of the torque
    double ramp_n_per_s = 10;              ///< how fast the ceiling of the force rises after engaging, > 0
    double ramp_nm_per_s = 0.5;            ///< likewise of the torque
    Watchdog device_watchdog{0.02, 0.05};  ///< age of the device's sample
    Watchdog model_watchdog{0.035, 0.05};  ///< age of the simulation's result
    MotionLimits motion;
    bool passivity = true;            ///< whether the passivity controller acts; it observes in any case
    PassivityLimits force_passivity;  ///< N, m
    PassivityLimits torque_passivity{0.01, 5e-3, 0.1, 1, 0.05, 2e-4};  ///< N m, rad
};

/// What the chain is given each period. Device frame, SI units, force and torque mapped and scaled already.
struct SafetyInput {
    Vec3 force_n{};               ///< wanted on the hand; anything, also not finite
    Vec3 torque_nm{};             ///< likewise
    Pose pose;                    ///< the device's newest, as read
    double dt_s = 0;              ///< since the apply() before
    double expected_dt_s = 1e-3;  ///< the loop's period, 1e-5 to 0.1; anything else is a jump of time
    double sample_age_s = 0;      ///< since the device's time_s last advanced, >= 0
    double model_age_s = 0;       ///< since the newest good result was taken up, >= 0; 0: synchronous
    bool step_failed = false;     ///< the force stands on a step that was not finite or had bad input
};

/// What may be written to the device.
struct SafeForce {
    Vec3 force_n{};                    ///< finite, norm at most max_force_n
    Vec3 torque_nm{};                  ///< finite, norm at most max_torque_nm
    std::uint32_t status = kHapticOk;  ///< HapticStatus bits of the stages that acted
};

/// The safety chain: between the scaled force and the device, every period, in this order.
///
///   0. Unknown is zero, and the ramp starts again: force not finite, bad pose, failed step, jump of pose or
///      time.
///   1. The wish is shortened to the limit, so that all that follows works on what can be felt.
///   2. Passivity observer and controller (PassivityController), one each for force and torque; before it, in
///      a contact that goes on after the ramp began, its share of the wish.
///   3. Slew limit (SlewLimit): at most the allowed change of one expected period, also after a late one.
///   4. Norm limit (limit_norm): the last word on the length. Nothing after it lengthens.
///   5. Ramp (EngageRamp): after engaging, after step 0 and after step 6.
///   6. Watchdog (Watchdog): share of the older of sample and model at the end of the period to come.
///   7. Not finite is zero, once more.
///
/// The force that leaves is what the slew limit and the observer go on from. It therefore rises by at most
/// the slew limit in a period, always; it falls faster only by steps 0 and 6.
///
/// Deterministic: only what it is given counts, no clock. Never allocates, locks or throws.
class KNEAD_HAPTICS_API SafetyChain {
  public:
    /// @return the chain, armed, or invalid_argument for a number out of the documented ranges
    static Result<SafetyChain> create(const SafetyConfig& config = {});

    /// One period.
    [[nodiscard]] SafeForce apply(const SafetyInput& input) noexcept;

    /// Starts from zero again, as if new; absorbed_j() goes on.
    void rearm() noexcept;

    /// Energy from the hand into the object, less what came back, since construction, both ports; J. Passive:
    /// it never falls far below zero.
    [[nodiscard]] double absorbed_j() const noexcept {
        return force_.passivity.absorbed_j() + torque_.passivity.absorbed_j();
    }
    [[nodiscard]] const SafetyConfig& config() const noexcept { return config_; }

  private:
    /// The stages of force or torque and what left them last.
    struct Port {
        double limit;
        PassivityController passivity;
        SlewLimit slew;
        EngageRamp ramp;
        Vec3 written{};
    };
    explicit SafetyChain(const SafetyConfig& config) noexcept;
    void restart() noexcept;
    [[nodiscard]] double watchdog_share(const SafetyInput& input, std::uint32_t& status) noexcept;
    [[nodiscard]] static Vec3 run(Port& port, const Vec3& wish, const SafetyInput& input, double share,
                                  std::uint32_t& status) noexcept;

    SafetyConfig config_;
    MotionCheck motion_;
    Port force_;
    Port torque_;
    double share_ = 1;  ///< of the watchdogs in the period before
};

}  // namespace knead
