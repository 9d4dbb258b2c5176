// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "touch/device_presets.h"
#include "touch/z_width.h"
#include "unit/runtime/block_asset.h"

namespace knead::tools::test {

// The 12 set-ups in which the renderings of a two-rate loop are compared with one rate of 1 kHz
// (docs/devices.md): object x device x latency.
inline constexpr std::array<double, 3> kYoungsModuli_pa{5.5e3, 22e3, 88e3};
inline constexpr std::array<const char*, 2> kComparedDevices{"touch", "phantom_desktop"};
inline constexpr std::array<double, 2> kLatencies{0.12, 1.0};  ///< simulation periods
inline constexpr double kKept = 0.8;  ///< of the synchronous range: what a rendering has to keep

inline std::vector<DevicePreset> read_devices(const std::string& file) {
    std::ifstream stream(file);
    return parse_device_presets(std::string{std::istreambuf_iterator<char>(stream), {}}, file);
}

/// The paper's cube with its top under a plate; 22 kPa gives about 2 kN/m. 384 tetrahedra: what is measured
/// is the loop, not the step's time. Damped as soft matter is: at 1 kHz implicit Euler damps next to nothing,
/// and a cube that rings after the press would be taken for a loop that does.
inline Asset measured_cube(double youngs_modulus_pa) {
    constexpr std::uint32_t kCells = 4;
    Asset asset = knead::test::cube_asset(kCells, ToolShape::plate, ToolContact::sticking,
                                          {youngs_modulus_pa, 0.3, 1000});
    asset.damping_per_s = 20;
    return asset;
}

/// A light grip: what is stable in it is stable in a firm one.
inline ZWidthSetup light_grip(const DevicePreset& device, bool passivity) {
    ZWidthSetup setup;
    OperatorConfig hand;
    hand.hand_mass_kg = 0.03;
    hand.hand_stiffness_n_per_m = 150;
    hand.hand_damping_n_s_per_m = 1.0;
    setup.hand = operator_on(device, hand);
    setup.haptic.safety = safety_for(device);
    setup.haptic.safety.passivity = passivity;
    return setup;
}

/// Likewise without dry friction and controller: they would hide what the rendering does.
inline ZWidthSetup compared_grip(const DevicePreset& device) {
    ZWidthSetup setup = light_grip(device, false);
    setup.hand.coulomb_friction_n = 0;
    return setup;
}

inline ZWidthSetup two_rate(ZWidthSetup setup, LocalRendering rendering, double rate_hz,
                            double latency_periods) {
    setup.haptic.mode = HapticMode::two_rate;
    setup.haptic.rendering = rendering;
    setup.haptic.simulation_rate_hz = rate_hz;
    setup.latency_periods = latency_periods;
    return setup;
}

/// Where the range of interest ends: no application asks a device for twice the stiffness that its makers'
/// software lets applications ask for; soft devices are given 2 kN/m.
inline double range_of_interest_n_per_m(const DevicePreset& device) {
    return std::max(2000.0, 2 * device.max_stiffness_n_per_m.value);
}

}  // namespace knead::tools::test
