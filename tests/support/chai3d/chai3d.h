// SPDX-License-Identifier: Apache-2.0
// What the CHAI3D example uses of CHAI3D 3.2, with the same names and signatures and nothing behind it:
// enough to compile the example and to drive its device from a test, on machines without CHAI3D.
#pragma once

#include <array>
#include <memory>

namespace chai3d {

class cVector3d {
  public:
    cVector3d() = default;
    cVector3d(double x, double y, double z) : values_{x, y, z} {}
    [[nodiscard]] double x() const { return values_[0]; }
    [[nodiscard]] double y() const { return values_[1]; }
    [[nodiscard]] double z() const { return values_[2]; }

  private:
    std::array<double, 3> values_{};
};

class cMatrix3d {
  public:
    double& operator()(unsigned int row, unsigned int column) { return values_[3 * row + column]; }
    const double& operator()(unsigned int row, unsigned int column) const {
        return values_[3 * row + column];
    }

  private:
    std::array<double, 9> values_{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

struct cHapticDeviceInfo {
    double m_maxLinearForce = 0;
    double m_maxAngularTorque = 0;
    double m_maxLinearStiffness = 0;
    bool m_actuatedRotation = false;
};

class cGenericHapticDevice {
  public:
    virtual ~cGenericHapticDevice() = default;
    virtual bool open() { return false; }
    virtual bool close() { return false; }
    virtual bool calibrate(bool /*a_forceCalibration*/ = false) { return false; }
    virtual bool getPosition(cVector3d& /*a_position*/) { return false; }
    virtual bool getLinearVelocity(cVector3d& /*a_linearVelocity*/) { return false; }
    virtual bool getRotation(cMatrix3d& /*a_rotation*/) { return false; }
    virtual bool getUserSwitches(unsigned int& /*a_userSwitches*/) { return false; }
    virtual bool setForceAndTorqueAndGripperForce(const cVector3d& /*a_force*/, const cVector3d& /*a_torque*/,
                                                  double /*a_gripperForce*/) {
        return false;
    }
    [[nodiscard]] cHapticDeviceInfo getSpecifications() const { return m_specifications; }
    cHapticDeviceInfo m_specifications;
};

using cGenericHapticDevicePtr = std::shared_ptr<cGenericHapticDevice>;

class cHapticDeviceHandler {
  public:
    bool getDevice(cGenericHapticDevicePtr& /*a_hapticDevice*/, unsigned int /*a_index*/ = 0) {
        return false;
    }
};

}  // namespace chai3d
