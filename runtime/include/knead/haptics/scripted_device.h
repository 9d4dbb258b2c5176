// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "knead/haptics/device.h"
#include "knead/haptics/export.h"

namespace knead {

/// A press along a straight line: wait, move by `travel_m` at constant speed, wait, come back, wait.
struct PressScript {
    Pose start;            ///< where it waits first
    Vec3 travel_m{};       ///< from the start to the deepest point
    double wait_s = 0.1;   ///< at the start
    double press_s = 1.0;  ///< on the way in; zero: at once
    double hold_s = 0.5;   ///< at the deepest point
    double release_s =
        0.0;              ///< on the way back; zero: it stays at the deepest point and the script ends there
    double rest_s = 0.0;  ///< at the start again; only with a release
    double rate_hz = 1000;  ///< samples per second, > 0
};

/// The samples of a press, one per period; times start at zero. Empty if a duration is negative or not
/// finite, the rate is not above zero, or the whole has more than ten million samples.
[[nodiscard]] KNEAD_HAPTICS_API std::vector<DeviceState> press_samples(const PressScript& script);

/// A device that needs no hardware: replays samples, one per read(), and records what is written.
///
/// The same samples give the same poses, bit for bit, whatever the clock says. read() and write() do not
/// allocate: room for one force and torque per sample is set aside in the constructor, later ones are not
/// recorded.
class KNEAD_HAPTICS_API ScriptedDevice final : public Device {
  public:
    /// @param samples recorded from a device, or press_samples(); an empty script stays at the origin
    explicit ScriptedDevice(std::vector<DeviceState> samples);

    /// The next sample. After the last one: the same pose at rest, and a time that goes on in steps of the
    /// last two samples. A hand that rests is not a device that stopped.
    [[nodiscard]] DeviceState read() noexcept override;
    void write(const Vec3& force_n, const Vec3& torque_n_m) noexcept override;

    /// Starts the script again and forgets the forces.
    void rewind() noexcept;

    [[nodiscard]] bool finished() const noexcept { return next_ >= samples_.size(); }
    [[nodiscard]] const std::vector<DeviceState>& samples() const noexcept { return samples_; }
    [[nodiscard]] const std::vector<Vec3>& forces_n() const noexcept { return forces_; }
    [[nodiscard]] const std::vector<Vec3>& torques_nm() const noexcept { return torques_; }

  private:
    std::vector<DeviceState> samples_;
    std::size_t next_ = 0;
    std::vector<Vec3> forces_;
    std::vector<Vec3> torques_;
    DeviceState resting_;  ///< after the last sample
    double period_s_ = 1e-3;
};

}  // namespace knead
