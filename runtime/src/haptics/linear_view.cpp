// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "knead/haptics/reduced_object.h"

namespace knead {
namespace {

using Eigen::Vector3d;
using Mat33 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Mat66 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

Vector3d vector(const Vec3& v) noexcept {
    return {v[0], v[1], v[2]};
}
Vec3 array(const Vector3d& v) noexcept {
    return {v[0], v[1], v[2]};
}

}  // namespace

LinearView linear_view(const LocalModel& model) noexcept {
    LinearView view;
    view.origin_m = model.origin.position_m;
    view.force_n = model.force_n;
    view.stiffness = model.stiffness;
    Eigen::Map<Mat33>(view.stiffness_n_per_m.data()) =
        Eigen::Map<const Mat66>(model.stiffness.data()).topLeftCorner<3, 3>();
    view.normal = model.normal;
    view.radius_m = model.radius_m;
    view.unilateral = model.unilateral;
    view.stamp = model.step;
    return view;
}

LinearView linear_view(const LocalModel& model, double coupling_n_per_m, const Vec3& hand_m,
                       const Vec3& coupling_force_n) noexcept {
    LinearView view = linear_view(model);
    view.origin_m = hand_m;
    view.force_n = coupling_force_n;
    // Two springs in a row: k - k (K + k)^-1 k, which is symmetric and positive semidefinite as K is.
    const double k = coupling_n_per_m;
    const Mat33 object = Eigen::Map<const Mat66>(model.stiffness.data()).topLeftCorner<3, 3>();
    Mat33 sum = object;
    sum.diagonal().array() += k;
    const Mat33 shared = sum.llt().solve(Mat33::Identity());
    Eigen::Map<Mat33> stiffness(view.stiffness_n_per_m.data());
    stiffness = k * Mat33::Identity() - k * k * shared;
    stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
    view.stiffness = {};
    Eigen::Map<Mat66>(view.stiffness.data()).topLeftCorner<3, 3>() = stiffness;
    return view;
}

Vec3 force_at(const LinearView& view, const Vec3& position_m) noexcept {
    Vector3d way = vector(position_m) - vector(view.origin_m);
    const double length = way.norm();
    if (length > view.radius_m) way *= view.radius_m / length;
    Vector3d force = vector(view.force_n) - Eigen::Map<const Mat33>(view.stiffness_n_per_m.data()) * way;
    const Vector3d n = vector(view.normal);
    if (view.unilateral) force -= std::min(0.0, n.dot(force)) * n;
    return array(force);
}

}  // namespace knead
