// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types.h"

namespace knead::core {

/// The part of `v` at right angles to the unit vector `normal`.
inline Vec in_plane(const Vec& v, const Vec& normal) {
    return v - normal.dot(v) * normal;
}

/// `v` with the given length; zero stays zero.
inline Vec with_length(const Vec& v, Real length) {
    const Real norm = v.norm();
    return norm > 0 ? Vec(v * (length / norm)) : Vec::Zero();
}

/// The friction on a slipping node in the solve under way, and what the solve before said. In the tool's
/// frame.
struct Slip {
    Vec friction_n = Vec::Zero();
    Vec slip_m = Vec::Zero();  ///< how far it moved over the tool in this step, under that friction
    Vec friction_before_n = Vec::Zero();
    Vec slip_before_m = Vec::Zero();
    bool compared = false;       ///< the two above are known
    Vec wanted_n = Vec::Zero();  ///< the friction for the next solve, if there is one
    bool judged = false;         ///< the one above is known

    void take_wanted() noexcept;
};

/// How much force it takes to move slipping nodes over the tool in a step, from what solves with different
/// friction said: the Rayleigh quotient of their change (Barzilai and Borwein 1988), in units of mass / dt^2.
/// Inertia alone is 1; elasticity makes it more, a coupled tool that gives way less. A friction update with
/// this stiffness does not overshoot.
class SlipStiffness {
  public:
    void reset() noexcept { factor_ = 1; }
    void begin_step() noexcept { passes_ = 0; }
    void begin_pass() noexcept { moved_ = forced_ = 0; }
    /// @param mobility_m_per_n dt^2 / mass of the node
    void add(const Slip& slip, Real mobility_m_per_n) noexcept;
    void finish_pass() noexcept;
    [[nodiscard]] Real factor() const noexcept { return factor_; }

  private:
    Real factor_ = 1;
    Real moved_ = 0, forced_ = 0;
    int passes_ = 0;
};

/// Coulomb's law for a node that slipped by slip.slip_m: the friction that would have held it, if that is not
/// more than `most_n`; else that direction with the length `most_n`. At the fixed point it opposes the slip.
/// @param stiffness_n_per_m how the holding force grows with the slip
Vec friction_of(const Slip& slip, Real stiffness_n_per_m, Real most_n, bool& holds) noexcept;

}  // namespace knead::core
