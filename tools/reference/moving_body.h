// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/free_system.h"
#include "reference/implicit_euler.h"
#include "reference/newton.h"

namespace knead::tools {

/// An implicit Euler step of a body, posed but not solved.
struct PosedStep {
    double dt_s = 0;
    Eigen::VectorXd start_m;        ///< [3 nodes] positions
    Eigen::VectorXd start_m_per_s;  ///< [3 nodes] velocities
    /// All terms but the elastic one are springs to where they alone would lead.
    Objective objective;

    /// [3 nodes] where velocity alone leads.
    [[nodiscard]] Eigen::VectorXd ahead_m() const { return start_m + dt_s * start_m_per_s; }
    [[nodiscard]] MotionState end(const Eigen::VectorXd& positions_m) const;
};

/// An elastic body with mass, gravity and damping: what the problems of motion have in common.
///
/// What it hands out points into it. @thread-safety one thread at a time
class MovingBody {
  public:
    /// @throws ToolError(bad_input) as ImplicitEuler
    MovingBody(const TetMesh& mesh, const Material& material, const BodyForces& forces);
    MovingBody(const MovingBody&) = delete;
    MovingBody& operator=(const MovingBody&) = delete;

    [[nodiscard]] const ElasticBody& elastic() const { return elastic_; }
    [[nodiscard]] MotionState rest() const;
    /// [3 nodes] what gravity pulls with, or empty without gravity.
    [[nodiscard]] Eigen::VectorXd weight_n() const;
    /// @throws ToolError(bad_input) for a state that is not one of this body, or a bad time step
    [[nodiscard]] PosedStep step_from(const MotionState& from, double dt_s) const;
    [[nodiscard]] FreeSystem& system_for(const std::vector<bool>& is_prescribed) {
        return system_.of(elastic_, is_prescribed);
    }

  private:
    ElasticBody elastic_;
    Eigen::VectorXd mass_kg_, gravity_m_per_s2_;  // [3 nodes]
    double damping_per_s_;
    KeptSystem system_;
};

}  // namespace knead::tools
