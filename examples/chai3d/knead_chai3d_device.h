// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chai3d.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "knead/haptics/device.h"
#include "knead/haptics/haptic_loop.h"

namespace knead_examples {

/// Rotation matrix to unit quaternion w, x, y, z: from the largest of its components, so that nothing is
/// lost.
inline std::array<double, 4> to_quaternion(const chai3d::cMatrix3d& r) {
    const double trace = r(0, 0) + r(1, 1) + r(2, 2);
    if (trace > 0) {
        const double s = 2 * std::sqrt(1 + trace);
        return {s / 4, (r(2, 1) - r(1, 2)) / s, (r(0, 2) - r(2, 0)) / s, (r(1, 0) - r(0, 1)) / s};
    }
    unsigned int i = 0;
    if (r(1, 1) > r(i, i)) i = 1;
    if (r(2, 2) > r(i, i)) i = 2;
    const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2 * std::sqrt(1 + r(i, i) - r(j, j) - r(k, k));
    std::array<double, 4> q{};
    q[0] = (r(k, j) - r(j, k)) / s;
    q[1 + i] = s / 4;
    q[1 + j] = (r(j, i) + r(i, j)) / s;
    q[1 + k] = (r(k, i) + r(i, k)) / s;
    return q;
}

/// Any device that CHAI3D drives, as one of Knead's. CHAI3D's axes (x towards the operator, y to the right, z
/// up) are right-handed as the scene's: turn them with HapticConfig::workspace if the scene's z is not up.
///
/// The device must be open. A read that fails keeps the time stamp, so that the loop takes the device for
/// dead and lets the force fade.
class Chai3dDevice final : public knead::Device {
  public:
    explicit Chai3dDevice(chai3d::cGenericHapticDevicePtr device) : device_(std::move(device)) {}

    [[nodiscard]] knead::DeviceState read() noexcept override {
        chai3d::cVector3d position, velocity;
        chai3d::cMatrix3d rotation;
        if (!device_->getPosition(position) || !device_->getRotation(rotation)) return state_;
        state_.pose.position_m = {position.x(), position.y(), position.z()};
        state_.pose.orientation_wxyz = to_quaternion(rotation);
        if (device_->getLinearVelocity(velocity))
            state_.velocity_m_per_s = {velocity.x(), velocity.y(), velocity.z()};
        unsigned int buttons = 0;
        if (device_->getUserSwitches(buttons)) state_.buttons = buttons;
        state_.time_s = std::chrono::duration<double>(Clock::now() - start_).count();
        return state_;
    }

    void write(const knead::Vec3& force_n, const knead::Vec3& torque_nm) noexcept override {
        device_->setForceAndTorqueAndGripperForce(chai3d::cVector3d(force_n[0], force_n[1], force_n[2]),
                                                  chai3d::cVector3d(torque_nm[0], torque_nm[1], torque_nm[2]),
                                                  0.0);
    }

  private:
    using Clock = std::chrono::steady_clock;
    chai3d::cGenericHapticDevicePtr device_;
    knead::DeviceState state_;
    Clock::time_point start_ = Clock::now();
};

/// A loop's configuration within what CHAI3D says of the device: force, torque, and the stiffness it renders.
inline knead::HapticConfig config_for(const chai3d::cHapticDeviceInfo& info) {
    knead::HapticConfig config;
    config.safety.max_force_n = info.m_maxLinearForce;
    config.safety.max_torque_nm = info.m_actuatedRotation ? info.m_maxAngularTorque : 0;
    config.coupling.stiffness_n_per_m = info.m_maxLinearStiffness;
    return config;
}

}  // namespace knead_examples
