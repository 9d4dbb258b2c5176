// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/step_model.h"

#include <utility>

namespace knead::tools {

StepModel::StepModel(Objective objective, Eigen::VectorXd load_n,
                     std::optional<Eigen::VectorXd> linearised_at_m)
    : objective_(std::move(objective)), load_n_(std::move(load_n)), point_(std::move(linearised_at_m)) {
    if (point_) gradient_at_point_ = objective_.body->gradient_n(*point_);
}

double StepModel::elastic_j(const Eigen::VectorXd& positions_m) const {
    if (!point_) return objective_.body->energy_j(positions_m);
    const Eigen::VectorXd moved = positions_m - *point_;
    return gradient_at_point_.dot(moved) +
           knead::tools::stiffness_times(*objective_.body, *point_, Curvature::rotation_frozen, moved)
                   .dot(moved) /
               2;
}

double StepModel::value_j(const Eigen::VectorXd& positions_m) const {
    double value = elastic_j(positions_m);
    if (objective_.weight_n_per_m.size() > 0)
        value += objective_.weight_n_per_m.dot((positions_m - objective_.anchor_m).cwiseAbs2()) / 2;
    if (load_n_.size() > 0) value -= load_n_.dot(positions_m - objective_.body->rest_positions_m());
    return value;
}

Eigen::VectorXd StepModel::gradient_n(const Eigen::VectorXd& positions_m) const {
    Eigen::VectorXd gradient;
    if (point_) {
        gradient = gradient_at_point_ + knead::tools::stiffness_times(*objective_.body, *point_,
                                                                      Curvature::rotation_frozen,
                                                                      positions_m - *point_);
        if (objective_.weight_n_per_m.size() > 0)
            gradient += objective_.weight_n_per_m.cwiseProduct(positions_m - objective_.anchor_m);
    } else {
        gradient = objective_.gradient_n(positions_m);
    }
    if (load_n_.size() > 0) gradient -= load_n_;
    return gradient;
}

bool StepModel::factorise(FreeSystem& system, const Eigen::VectorXd& positions_m, Curvature curvature,
                          const std::vector<NodeBlock>& blocks) {
    used_ = point_ ? Curvature::rotation_frozen : curvature;
    return system.factorise(point_ ? *point_ : positions_m, used_, objective_.weight_n_per_m,
                            point_ ? std::vector<NodeBlock>{} : blocks);
}

Eigen::VectorXd StepModel::stiffness_times(const Eigen::VectorXd& positions_m,
                                           const Eigen::VectorXd& direction) const {
    return knead::tools::stiffness_times(*objective_.body, point_ ? *point_ : positions_m, used_, direction);
}

}  // namespace knead::tools
