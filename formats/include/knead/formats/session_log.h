// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "knead/formats/result.h"

namespace knead {

/// Every input and output of a haptic session: enough to run it again with the same bits.
///
/// Plain data, so that who reads a log needs neither the simulation nor the loop. Written by
/// write_session_log(), filled and replayed by knead/haptics/session.h. On disk: group "/knead/session"
/// (docs/format.md), kind "session".
///
/// Index meanings: entry i of every `ticks` array is the i-th recorded period of the haptic loop, entry i of
/// every `steps` array the i-th recorded step of the simulation. Numbers of ticks and steps start at 1; 0
/// means none.
///
/// Invariants, checked by validate() and again by every reader:
///   - arrays of one struct have the same length
///   - settings have unique names of 1 to 128 printable ASCII characters without blanks, in the order of
///     their bytes; values are finite
///   - asset_content_hash is 64 lowercase hexadecimal digits
///   - tick numbers strictly increase, and so do step numbers
///   - ticks.used_step never decreases; it is 0 or the number of a recorded step, in a two-rate session
///   - steps.hand_tick never decreases; it is 0 or the number of a recorded tick
///   - a step does not use a tick that came after one that used the step
///   - what the loop wrote (ticks.force_n, ticks.torque_nm) is finite; every other number of a tick or step
///   is
///     as it was, whatever it was: a log of a device gone wrong is a log worth having
struct SessionLog {
    using Triple = std::array<double, 3>;
    using Quaternion = std::array<double, 4>;

    /// One number of the configuration under the name of its field: "haptic.rate_hz".
    struct Setting {
        std::string name;
        double value = 0;
    };

    /// What one haptic period read, used and wrote. Device frame, SI units.
    struct Ticks {
        std::vector<std::uint64_t> number;
        std::vector<double> dt_s;  ///< as given to the loop
        std::vector<double> device_time_s;
        std::vector<Triple> device_position_m;
        std::vector<Quaternion> device_orientation_wxyz;
        std::vector<Triple> device_velocity_m_per_s;
        std::vector<std::uint32_t> device_buttons;
        std::vector<std::uint64_t> used_step;  ///< number of the step whose result it rendered from
        std::vector<Triple> tool_position_m;   ///< where the loop had the tool, scene frame
        std::vector<Quaternion> tool_orientation_wxyz;
        std::vector<Triple> scene_force_n;  ///< before scaling and safety, scene frame
        std::vector<Triple> scene_torque_nm;
        std::vector<Triple> force_n;  ///< as written to the device
        std::vector<Triple> torque_nm;
        std::vector<std::uint32_t> status;         ///< HapticStatus bits
        std::vector<std::uint32_t> step_status;    ///< StepStatus bits of the result it rendered from
        std::vector<std::uint32_t> touched_nodes;  ///< likewise
    };

    /// What one step of a two-rate session's simulation used and yielded. Scene frame.
    struct Steps {
        std::vector<std::uint64_t> number;
        std::vector<std::uint64_t> hand_tick;  ///< number of the tick whose pose it used
        std::vector<double> dt_s;
        std::vector<Triple> force_n;
        std::vector<Triple> torque_nm;
        std::vector<std::uint32_t> status;  ///< StepStatus bits
        std::vector<std::uint32_t> touched_nodes;
        std::vector<std::uint32_t> solver_iterations;
    };

    std::string asset_content_hash;
    std::vector<Setting> settings;
    Ticks ticks;
    Steps steps;                   ///< empty in a synchronous session
    std::uint64_t lost_ticks = 0;  ///< came when the recorder was full
    std::uint64_t lost_steps = 0;
};

/// Checks every invariant above.
[[nodiscard]] Status validate(const SessionLog& log);

}  // namespace knead
