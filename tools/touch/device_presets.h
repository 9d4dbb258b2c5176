// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/haptics/haptic_loop.h"
#include "knead/haptics/simulated_operator.h"

namespace knead::tools {

/// A number and where it comes from.
struct SourcedNumber {
    double value = 0;
    std::string source;  ///< what to look up, or "assumed: ..."
    std::string note;    ///< "CHAI3D application limit", or empty

    [[nodiscard]] bool assumed() const { return source.rfind("assumed: ", 0) == 0; }
};

/// A haptic device as numbers, SI units; runtime/data/devices.toml says what each means.
struct DevicePreset {
    std::string name;   ///< what users type: "omega.3"
    std::string title;  ///< what people call it
    SourcedNumber max_force_n;
    SourcedNumber max_stiffness_n_per_m;
    SourcedNumber workspace_radius_m;
    SourcedNumber position_resolution_m;
    SourcedNumber apparent_mass_kg;
    SourcedNumber friction_n;
    SourcedNumber damping_n_s_per_m;
    std::optional<SourcedNumber> max_torque_nm;  ///< absent: rotations are not driven
    std::optional<SourcedNumber> max_damping_n_s_per_m;
};

/// Reads a devices file. Unknown keys, numbers without a source, numbers out of range and names that come
/// twice are refused with "file:line: place: what".
/// @param file what messages call it
[[nodiscard]] std::vector<DevicePreset> parse_device_presets(std::string_view text, const std::string& file);

/// @return the preset of that name; fails as bad usage with the names there are, and the nearest
[[nodiscard]] const DevicePreset& find_device(const std::vector<DevicePreset>& presets,
                                              const std::string& name);

/// Where the devices file lies, installed and in the build tree alike: ../share/knead/devices.toml from the
/// folder of the program.
[[nodiscard]] std::filesystem::path devices_file_of(const std::filesystem::path& program);

/// A simulated hand on this device: the device's part of `hand` is replaced, the hand's stays.
[[nodiscard]] OperatorConfig operator_on(const DevicePreset& preset, OperatorConfig hand = {});

/// Limits of the safety chain for this device: force, torque, resolution. The force may rise to its limit in
/// a third of a second after engaging, and by a third of it in a millisecond.
[[nodiscard]] SafetyConfig safety_for(const DevicePreset& preset, SafetyConfig base = {});

}  // namespace knead::tools
