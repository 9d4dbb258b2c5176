// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "baseline/body.h"

namespace knead::bench {

using baseline::Body;
using baseline::Columns;
using baseline::make_body;
using baseline::State;

/// What a step ends in.
struct Step {
    State state;
    Eigen::Vector3d force_n = Eigen::Vector3d::Zero();  ///< of the object on the plate
    int iterations = 0;                                 ///< of conjugate gradients
};

/// The step that the runtime approximates, in double precision and solved to rounding.
///
/// Linearised implicit Euler: with p the prediction (Body::predict()), R the rotation of each tetrahedron
/// there (singular value decomposition, a rotation under inversion too) and f the elastic force there,
///     (M (1 + c dt) + dt^2 K(R)) d = dt^2 (f(p) + M g - c M v)    for the active nodes, x = p + d,
/// velocities (x - x_old) / dt. The force on the plate is minus the sum over its nodes of the elastic
/// gradient linearised to x, their own inertia, and damping less gravity.
///
/// Direct factor (or block Jacobi, for objects whose factor takes minutes) inside conjugate gradients, which
/// tolerate a factor of an earlier step, refined on the true residual until nothing changes.
/// @thread-safety one thread at a time
class ExactStep {
  public:
    explicit ExactStep(const Body& body);  ///< keeps a reference
    ~ExactStep();

    [[nodiscard]] Step step(const State& from, const Pose& plate_pose, double dt_s);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace knead::bench
