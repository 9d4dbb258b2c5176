// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "reference/newton.h"

namespace knead::tools {

/// The smooth part of a problem with contact: an objective, minus the work of a dead load, exact or as its
/// quadratic model about one point with the rotations frozen there.
class StepModel {
  public:
    /// @param load_n [3 nodes] or empty
    /// @param linearised_at_m where the elastic energy is replaced by its model, or nothing: exact
    StepModel(Objective objective, Eigen::VectorXd load_n, std::optional<Eigen::VectorXd> linearised_at_m);

    [[nodiscard]] const Objective& objective() const { return objective_; }
    [[nodiscard]] bool is_linear() const { return point_.has_value(); }

    [[nodiscard]] double value_j(const Eigen::VectorXd& positions_m) const;
    /// Elastic energy; of the quadratic model: relative to the linearisation point.
    [[nodiscard]] double elastic_j(const Eigen::VectorXd& positions_m) const;
    [[nodiscard]] Eigen::VectorXd gradient_n(const Eigen::VectorXd& positions_m) const;
    /// Factorises the second derivative plus `blocks`; the quadratic model has but one, and no blocks.
    /// @return false when it is not positive definite
    bool factorise(FreeSystem& system, const Eigen::VectorXd& positions_m, Curvature curvature,
                   const std::vector<NodeBlock>& blocks);
    /// The second derivative last factorised (without blocks), of elasticity alone, times `direction`.
    [[nodiscard]] Eigen::VectorXd stiffness_times(const Eigen::VectorXd& positions_m,
                                                  const Eigen::VectorXd& direction) const;

  private:
    Objective objective_;
    Eigen::VectorXd load_n_;
    std::optional<Eigen::VectorXd> point_;
    Eigen::VectorXd gradient_at_point_;
    Curvature used_ = Curvature::exact;
};

}  // namespace knead::tools
