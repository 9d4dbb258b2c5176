// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// What the passivity controller may do at one port: in newtons and metres, or in newton metres and radians.
struct PassivityLimits {
    double max_damping = 5;    ///< force per speed of the damper, at most; >= 0; 0: it only observes
    double resolution = 1e-4;  ///< motion that is surely more than the sensors' noise: two counts; > 0
    double softest = 50;       ///< force per motion of the softest spring that gives all its energy back; > 0
    double travel = 0.05;      ///< the longest way along which the full force may push back; > 0
    double max_debt_j = 0.05;  ///< most energy that is remembered as still to be taken out; >= 0
    double free_energy_j = 2e-4;  ///< debt that is let pass, once and for all; >= 0
};

/// Passivity observer and controller of one port (three components, one energy), impedance causality.
///
/// The observer counts the energy that went from the hand into the virtual object. A force is held from one
/// sample to the next, so the count is exact whatever moved in between: E += -held . moved. The controller is
/// a damper along the motion. It is there only while the count, looked at one period ahead, would fall below
/// -free_energy_j, and as strong as that takes, at most max_damping. The motion is that of the shortest time,
/// from half a period to 10 samples, in which the hand moved by `resolution`: one sample if it is fast.
///
/// What was paid in long ago must not pay for what is active now: the stock never exceeds
/// wish^2 / (2 softest), the energy of the softest spring under the present force, nor full force x travel;
/// without a force it is gone. Debt stays, up to max_debt_j: what cannot be taken out of a hand at rest is
/// taken out later. Where there is no force, none is made.
///
/// A damper is too weak for a restart in contact: the hand sank in while there was no force, and what brings
/// the force back pushes it out with energy that nobody put in. From reset() until the object wants no force
/// any more, the force therefore fades with the debt: whole as long as there is none, a last kLeast of it
/// from twice free_energy_j on. To a hand that holds still nothing is given and nothing fades; one that
/// pushes in pays, and has the whole force again.
///
/// Never allocates or throws. Source: Hannaford & Ryu, IEEE Trans. Robotics and Automation 18 (2002) 1-10;
/// exact count for a held force: Ryu, Kim, Hannaford, IEEE Trans. Robotics 20 (2004) 772-776.
class KNEAD_HAPTICS_API PassivityController {
  public:
    /// @param full_force the largest norm that is ever written, >= 0
    PassivityController(const PassivityLimits& limits, double full_force) noexcept
        : limits_(limits), full_force_(full_force) {}

    /// Counts one period. @param held force on the hand during it  @param moved by the hand during it
    /// @param dt_s how long it took, > 0
    void observe(const Vec3& held, const Vec3& moved, double dt_s) noexcept;

    /// @param force that would be felt, finite, within the full force
    /// @param wish norm of the same before it was shortened to the full force; may be infinite
    /// @param hold_s how long it will be held, > 0  @param status gets kHapticPassivity if the damper acts by
    /// more than a thousandth of the full force
    /// @return force with as much damping as needed
    [[nodiscard]] Vec3 damp(const Vec3& force, double wish, double hold_s, std::uint32_t& status) noexcept;

    /// What of the force may be felt after reset(). @param wish as in damp()  @return kLeast to 1; 1 in any
    /// contact that began after it, and always with max_damping 0
    [[nodiscard]] double share(double wish) noexcept;

    /// The force was cut and will come back: forgets stock, debt and motion; absorbed_j() goes on. A large
    /// old debt would keep the force away from a hand that cannot pay it.
    void reset() noexcept;

    /// Stock if positive, debt if negative, J.
    [[nodiscard]] double energy_j() const noexcept { return energy_j_; }
    /// All that went from the hand into the object, less all that came back, since construction, J: nothing
    /// forgotten.
    [[nodiscard]] double absorbed_j() const noexcept { return absorbed_j_; }

    /// Where all was given that may be: something to push against, else a hand that pushes in could not pay.
    static constexpr double kLeast = 0.02;

  private:
    static constexpr std::size_t kWindow = 10;
    struct Sample {
        Vec3 moved{};
        double dt_s = 0;
    };
    [[nodiscard]] Vec3 velocity(double hold_s) const noexcept;

    PassivityLimits limits_;
    double full_force_;
    double energy_j_ = 0;
    double absorbed_j_ = 0;
    bool recovering_ = true;                ///< since reset() the object never was without force
    std::array<Sample, kWindow> window_{};  ///< a ring, newest at newest_
    std::size_t newest_ = 0;
    std::size_t filled_ = 0;  ///< samples in the ring
};

}  // namespace knead
