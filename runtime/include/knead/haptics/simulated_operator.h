// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "knead/formats/result.h"
#include "knead/haptics/device.h"
#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// Where the hand wants to be at one moment, device frame. Between two of them: straight lines, shortest
/// turns; before the first and after the last one: at rest there.
struct HandTarget {
    double time_s = 0;
    Pose pose;
};

/// A device in a hand, as numbers. SI units, device frame. Every number is >= 0 unless said otherwise.
struct OperatorConfig {
    // The device.
    double device_mass_kg = 0.045;          ///< apparent at the tool; with the hand's > 0
    double device_damping_n_s_per_m = 0.0;  ///< viscous
    double coulomb_friction_n = 0.0;        ///< dry, of the translation
    double position_resolution_m = 0.0;     ///< of each coordinate read() returns; zero: exact
    double angle_resolution_rad = 0.0;      ///< of the rotation vector read() returns; zero: exact
    double max_force_n = 0.0;               ///< norm that the motors reach; zero: no limit
    double max_torque_nm = 0.0;             ///< likewise; zero: no limit

    // The hand on it.
    double hand_mass_kg = 0.1;                 ///< moves with the device
    double hand_stiffness_n_per_m = 300.0;     ///< between the hand's wish and the device
    double hand_damping_n_s_per_m = 3.0;       ///< likewise
    double inertia_kg_m2 = 0.0;                ///< device and hand; zero: the orientation is the hand's wish
    double hand_stiffness_nm_per_rad = 1.0;    ///< of the rotation, used with an inertia
    double hand_damping_nm_s_per_rad = 0.005;  ///< likewise
    std::vector<HandTarget> path;              ///< times never decrease; empty: rests at the origin

    // Between device and loop.
    double period_s = 1e-3;       ///< between two read(), [0.1 ms, 10 ms]
    double jitter_periods = 0.0;  ///< each sample is taken within +- half of this around its time, <= 0.9
    double force_delay_periods = 0.0;  ///< from write() to the motors; need not be whole; <= 64
    std::uint32_t velocity_window =
        1;                   ///< samples back that the measured velocity is a difference to, 1 to 64
    std::uint64_t seed = 1;  ///< of the jitter
};

/// A press along one line: at rest for `wait_s`, in by `travel_m` in `press_s`, then a hold without end.
[[nodiscard]] KNEAD_HAPTICS_API std::vector<HandTarget> press_path(const Pose& start, const Vec3& travel_m,
                                                                   double wait_s, double press_s);

/// The device and the hand themselves, which no application sees.
struct OperatorState {
    double time_s = 0;  ///< of the last read()
    Pose pose;          ///< not quantised
    Vec3 velocity_m_per_s{};
    Vec3 angular_velocity_rad_per_s{};
    Vec3 force_n{};  ///< what the motors exert now: delayed and limited
    Vec3 torque_nm{};
};

/// Where energy went since the start, joules. kinetic = port + hand - damping - friction, as far as the
/// quadrature of the last three goes.
struct OperatorEnergy {
    /// Sum of force . dx (and torque . turn) of the motors over the true motion: what the virtual object gave
    /// to device and hand. Exact. The object is passive as long as this never exceeds what it had stored.
    double port_j = 0;
    double port_peak_j = 0;  ///< largest value of port_j ever
    double hand_j = 0;       ///< work of the hand's spring and damper, translation only
    double damping_j = 0;    ///< lost in the device's damping
    double friction_j = 0;   ///< lost in the device's dry friction
    double kinetic_j = 0;    ///< of device and hand now, translation only
};

struct HandWish;

/// A hand and a device in virtual time: a point mass (and an inertia) between a hand's spring-damper, the
/// device's damping and dry friction, and the force of the loop.
///
/// read() advances by one period and samples; write() sets the force that is held until the next one arrives.
/// Between, the linear part is integrated exactly in pieces of at most 50 us, dry friction by an implicit
/// step after each. Deterministic: the same config and forces give the same bits; there is no clock.
class KNEAD_HAPTICS_API SimulatedOperator final : public Device {
  public:
    /// @return the device at the start of its path, at rest, or invalid_argument naming the number at fault
    static Result<SimulatedOperator> create(const OperatorConfig& config);

    /// Advances to the next sample. @return what the encoders say; time_s is when, jitter included
    [[nodiscard]] DeviceState read() noexcept override;
    /// A force that is not finite counts as zero: motors have no such thing.
    void write(const Vec3& force_n, const Vec3& torque_n_m) noexcept override;

    [[nodiscard]] const OperatorState& state() const noexcept { return state_; }
    [[nodiscard]] const OperatorEnergy& energy() const noexcept { return energy_; }
    [[nodiscard]] const OperatorConfig& config() const noexcept { return config_; }

  private:
    struct Oscillator;
    struct PendingForce {
        double time_s = 0;
        Vec3 force_n{}, torque_nm{};
    };
    struct Sample {
        double time_s = 0;
        Vec3 position_m{};
    };

    explicit SimulatedOperator(const OperatorConfig& config);
    void advance_to(double time_s) noexcept;
    void advance_held(double time_s) noexcept;
    void step(const Oscillator& motion, double dt_s) noexcept;
    void rub(double dt_s) noexcept;
    void turn(double dt_s, const HandWish& wish) noexcept;
    [[nodiscard]] double jittered() noexcept;
    [[nodiscard]] DeviceState measured() noexcept;

    OperatorConfig config_;
    OperatorState state_;
    OperatorEnergy energy_;
    std::mt19937_64 random_;
    std::uint64_t samples_ = 0;
    std::size_t path_at_ = 0;            ///< the last target that is over, or zero
    std::vector<PendingForce> pending_;  ///< ring: written, not yet at the motors
    std::size_t first_pending_ = 0, pending_count_ = 0;
    std::vector<Sample> window_;  ///< ring of the last velocity_window + 1 measured positions
};

}  // namespace knead
