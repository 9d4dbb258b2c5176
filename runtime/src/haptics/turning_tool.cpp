// SPDX-License-Identifier: Apache-2.0
#include "haptics/turning_tool.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "haptics/twist.h"

namespace knead {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Map3 = Eigen::Map<const Vector3d>;
using Map33 = Eigen::Map<const Matrix3d>;

std::array<double, 9> rotational_block(const Mat6& whole) noexcept {
    std::array<double, 9> block{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            block[3 * row + column] = whole[6 * (row + 3) + column + 3];
    return block;
}

}  // namespace

void TurningTool::reset(const Pose& hand) noexcept {
    tool_ = hand_ = hand;
    velocity_ = torque_ = felt_ = {};
    stiffness_ = damping_ = inertia_ = {};
}

void TurningTool::touch(const Vec3& torque_nm, const LocalModel& model) noexcept {
    torque_ = torque_nm;
    stiffness_ = rotational_block(model.stiffness);
    damping_ = rotational_block(model.damping);
    inertia_ = rotational_block(model.mass);
}

void TurningTool::advance(const Pose& hand, double dt) noexcept {
    const Vector3d hand_velocity = twist(hand_, hand).tail<3>() / dt;
    const Vector3d stretch = twist(tool_, hand).tail<3>();
    const double spring = config_.rotation_stiffness_nm_per_rad;
    const double damper = config_.rotation_damping_nm_s_per_rad;
    const double own = config_.tool_inertia_kg_m2 + dt * damper + dt * dt * spring;
    const Matrix3d object =
        Map33(inertia_.data()) + dt * Map33(damping_.data()) + dt * dt * Map33(stiffness_.data());
    const Vector3d momentum =
        (config_.tool_inertia_kg_m2 * Matrix3d::Identity() + Map33(inertia_.data())) * Map3(velocity_.data());
    const Vector3d push = Map3(torque_.data()) + spring * stretch + damper * hand_velocity;
    const Matrix3d whole = object + own * Matrix3d::Identity();
    const Vector3d velocity = whole.llt().solve(momentum + dt * push);
    Vec6 way = Vec6::Zero();
    way.tail<3>() = dt * velocity;
    const Vector3d felt = -(spring * (stretch - dt * velocity) + damper * (hand_velocity - velocity));
    if (!felt.allFinite()) return reset(hand);
    tool_.orientation_wxyz = moved(tool_, way).orientation_wxyz;
    hand_ = hand;
    Eigen::Map<Vector3d>(velocity_.data()) = velocity;
    Eigen::Map<Vector3d>(felt_.data()) = felt;
}

}  // namespace knead
