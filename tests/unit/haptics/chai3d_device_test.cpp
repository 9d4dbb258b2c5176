// SPDX-License-Identifier: Apache-2.0
// The header of examples/chai3d, against a stand-in with CHAI3D's signatures.
#include <gtest/gtest.h>

#include <cmath>

#include "knead_chai3d_device.h"

namespace knead::test {
namespace {

constexpr double kRounding = 1e-15;

class FakeDevice final : public chai3d::cGenericHapticDevice {
  public:
    bool getPosition(chai3d::cVector3d& position) override {
        position = at;
        return answers;
    }
    bool getRotation(chai3d::cMatrix3d& rotation) override {
        rotation = turned;
        return answers;
    }
    bool getLinearVelocity(chai3d::cVector3d& velocity) override {
        velocity = moving;
        return true;
    }
    bool getUserSwitches(unsigned int& switches) override {
        switches = 5;
        return true;
    }
    bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& force, const chai3d::cVector3d& torque,
                                          double gripper) override {
        force_n = force;
        torque_nm = torque;
        gripper_n = gripper;
        return true;
    }

    bool answers = true;
    chai3d::cVector3d at{0.01, -0.02, 0.03}, moving{1, 2, 3}, force_n, torque_nm;
    chai3d::cMatrix3d turned;
    double gripper_n = -1;
};

/// Rodrigues' formula: what a rotation about an axis is, without quaternions.
chai3d::cMatrix3d rotation_about(const std::array<double, 3>& unit, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double cross[3][3] = {{0, -unit[2], unit[1]}, {unit[2], 0, -unit[0]}, {-unit[1], unit[0], 0}};
    chai3d::cMatrix3d r;
    for (unsigned int i = 0; i < 3; ++i) {
        for (unsigned int j = 0; j < 3; ++j)
            r(i, j) = c * (i == j ? 1 : 0) + s * cross[i][j] + (1 - c) * unit[i] * unit[j];
    }
    return r;
}

}  // namespace

TEST(Chai3d_device, reads_pose_velocity_and_buttons) {
    auto fake = std::make_shared<FakeDevice>();
    knead_examples::Chai3dDevice device(fake);
    const DeviceState state = device.read();
    EXPECT_EQ(state.pose.position_m, (Vec3{0.01, -0.02, 0.03}));
    EXPECT_EQ(state.velocity_m_per_s, (Vec3{1, 2, 3}));
    EXPECT_EQ(state.buttons, 5u);
    EXPECT_EQ(state.pose.orientation_wxyz, (std::array<double, 4>{1, 0, 0, 0}));
}

TEST(Chai3d_device, turns_every_rotation_into_its_quaternion) {
    auto fake = std::make_shared<FakeDevice>();
    knead_examples::Chai3dDevice device(fake);
    const double third = std::sqrt(1.0 / 3);
    for (const std::array<double, 3>& axis :
         {std::array<double, 3>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {third, -third, third}, {0.6, 0, -0.8}}) {
        for (const double angle : {0.1, 1.5, 3.0, M_PI}) {
            fake->turned = rotation_about(axis, angle);
            const auto q = device.read().pose.orientation_wxyz;
            const double sign = q[1] * axis[0] + q[2] * axis[1] + q[3] * axis[2] < 0 ? -1 : 1;
            EXPECT_NEAR(sign * q[0], std::cos(angle / 2), 10 * kRounding);
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(sign * q[1 + i], std::sin(angle / 2) * axis[i], 10 * kRounding);
        }
    }
}

TEST(Chai3d_device, that_does_not_answer_keeps_its_time_so_that_the_watchdog_sees_it) {
    auto fake = std::make_shared<FakeDevice>();
    knead_examples::Chai3dDevice device(fake);
    const DeviceState first = device.read();
    const DeviceState second = device.read();
    EXPECT_GT(second.time_s, first.time_s);
    fake->answers = false;
    fake->at = {9, 9, 9};
    const DeviceState third = device.read();
    EXPECT_EQ(third.time_s, second.time_s);
    EXPECT_EQ(third.pose.position_m, second.pose.position_m);
}

TEST(Chai3d_device, writes_force_and_torque_and_leaves_the_gripper_alone) {
    auto fake = std::make_shared<FakeDevice>();
    knead_examples::Chai3dDevice device(fake);
    device.write({1, -2, 3}, {0.1, 0.2, -0.3});
    EXPECT_EQ(fake->force_n.y(), -2);
    EXPECT_EQ(fake->torque_nm.z(), -0.3);
    EXPECT_EQ(fake->gripper_n, 0);
}

TEST(Chai3d_config, stays_within_what_the_device_renders) {
    chai3d::cHapticDeviceInfo info;
    info.m_maxLinearForce = 12;
    info.m_maxLinearStiffness = 5000;
    info.m_maxAngularTorque = 0.4;
    const HapticConfig without_torque = knead_examples::config_for(info);
    EXPECT_EQ(without_torque.safety.max_force_n, 12);
    EXPECT_EQ(without_torque.safety.max_torque_nm, 0);
    EXPECT_EQ(without_torque.coupling.stiffness_n_per_m, 5000);
    info.m_actuatedRotation = true;
    EXPECT_EQ(knead_examples::config_for(info).safety.max_torque_nm, 0.4);
}

}  // namespace knead::test
