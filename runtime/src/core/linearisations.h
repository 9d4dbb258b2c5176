// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model.h"
#include "knead/formats/numerics.h"

namespace knead::core {

/// A step is linearised again where its solution came, while that moved the free nodes by more than this
/// (root mean square, in mean edges) and linearisations are left.
inline constexpr Real kNearlyLinear = 1e-4;

/// How often a step may be linearised where the application leaves it to us: once, or more often in steps
/// longer than kLongStep_s where that is known to be too coarse.
///
/// Matter that turns in a step is turned along straight lines, which strains it by half the square of the
/// angle. That strain is far more energy than the press has given where very stiff islands turn in soft,
/// nearly incompressible matter that buckles, and a flat tetrahedron is turned inside out
/// (docs/stability.md). Forces are hardly touched by either.
class Linearisations {
  public:
    /// @param most of SimulationConfig: 0, or what the application wants whatever the step
    Linearisations(const Model& model, const Numerics& numerics, int most);

    [[nodiscard]] int most(Real dt_s) const noexcept;
    /// Whether one may overshoot: where there are such islands.
    [[nodiscard]] bool overshoot() const noexcept { return islands_; }

  private:
    int wanted_;
    bool islands_;
    bool hard_;  ///< the matter is such; not looked at where the application has said what it wants
};

}  // namespace knead::core
