// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/runtime/pose.h"

namespace knead::baseline {

/// One column per node.
using Columns = Eigen::Matrix3Xd;

/// Where the nodes are and how fast they move: what a step starts from.
struct State {
    Columns positions_m;
    Columns velocities_m_per_s;
};

/// An asset with its first tool, a bonded plate, in double precision: what the baseline starts from, and the
/// benchmark's exact step. Their arithmetic is their own, and none of it is the runtime's.
///
/// Nodes in asset order; [0, free_count) are not held. Of these, `plate` follow the plate and `active` are
/// the unknowns of a step.
struct Body {
    struct Element {
        std::array<std::uint32_t, 4> nodes{};
        Eigen::Matrix<double, 3, 4> shape_gradients;  ///< column a: gradient of the shape function of node a
        double volume_m3 = 0;
        double mu_pa = 0;
        double lambda_pa = 0;
    };
    std::vector<Element> elements;
    Columns rest_m;
    Eigen::VectorXd mass_kg;  ///< [nodes] a quarter of the mass of every tetrahedron at each of its nodes
    std::uint32_t free_count = 0;
    std::vector<std::uint32_t> active, plate;
    Eigen::Vector3d gravity_m_per_s2 = Eigen::Vector3d::Zero();
    double damping_per_s = 0;
    Pose plate_rest;

    [[nodiscard]] State at_rest() const;
    /// Where free motion and the plate carry the nodes in a step: active x + dt v, plate nodes at their
    /// places under `plate_pose`, held nodes at rest.
    [[nodiscard]] Columns predict(const State& from, const Pose& plate_pose, double dt_s) const;
    /// Deformation gradient of one tetrahedron.
    [[nodiscard]] Eigen::Matrix3d deformation_gradient(const Element& element,
                                                       const Columns& positions_m) const;
};

/// @param asset valid, its first tool bonded
[[nodiscard]] Body make_body(const Asset& asset);

}  // namespace knead::baseline
