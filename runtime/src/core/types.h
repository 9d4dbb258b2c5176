// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace knead::core {

/// The numbers of everything but fields and kernels (node_field.h), which are float or double.
using Real = double;

using Vec = Eigen::Matrix<Real, 3, 1>;
using Mat = Eigen::Matrix<Real, 3, 3>;
using Quat = Eigen::Quaternion<Real, Eigen::DontAlign>;

/// One vector per node, asset node order.
using Field = std::vector<Vec>;

/// A rigid placement: tool frame to scene frame.
struct Frame {
    Vec position = Vec::Zero();
    Mat rotation = Mat::Identity();

    [[nodiscard]] Vec to_scene(const Vec& local) const { return position + rotation * local; }
    [[nodiscard]] Vec to_local(const Vec& scene) const { return rotation.transpose() * (scene - position); }
};

}  // namespace knead::core
