// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>

#include "knead/runtime/pose.h"

namespace knead::test {

/// A mass with viscous friction between a hand that pushes steadily and a one-sided spring that is sampled
/// and held: the textbook case in which a wall gives more than it takes once friction < stiffness * period /
/// 2 (Colgate & Schenkel 1997). Between samples the motion is solved exactly, so all gain is the sampling's.
///
/// Axis x; the wall is at x < 0 and pushes towards +x.
struct VirtualWall {
    double mass_kg = 0.1;
    double friction_n_s_per_m = 0.05;
    double stiffness_n_per_m = 1000;
    double period_s = 1e-3;
    double hand_n = -0.5;  ///< steady
    double quantum_m = 0;  ///< of the position sensor; 0: none
    double x_m = 0;
    double v_m_per_s = -0.1;
    double given_j = 0;  ///< from the wall to the mass, of true motion

    [[nodiscard]] double seen_m() const {
        return quantum_m > 0 ? quantum_m * std::floor(x_m / quantum_m) : x_m;
    }
    [[nodiscard]] double wish_n() const { return seen_m() < 0 ? -stiffness_n_per_m * seen_m() : 0; }

    /// One period under a held force: m a + b v = f, solved.
    void move(double held_n) {
        const double f = held_n + hand_n;
        const double rate = friction_n_s_per_m / mass_kg;
        const double terminal = f / friction_n_s_per_m;
        const double decay = std::exp(-rate * period_s);
        const double moved = terminal * period_s + (v_m_per_s - terminal) * (1 - decay) / rate;
        v_m_per_s = terminal + (v_m_per_s - terminal) * decay;
        x_m += moved;
        given_j += held_n * moved;
    }
};

}  // namespace knead::test
