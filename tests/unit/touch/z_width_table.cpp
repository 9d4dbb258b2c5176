// SPDX-License-Identifier: Apache-2.0
// The tables of docs/haptics.md: how stiff a coupling may be, by device, rendering and rate of the
// simulation.
//   z_width_table DEVICES.toml shares|devices 0|1    the last: with the passivity controller
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "touch/device_presets.h"
#include "touch/z_width.h"
#include "unit/runtime/block_asset.h"

namespace knead::tools {
namespace {

constexpr std::uint32_t kCells = 4;  ///< 384 tetrahedra: what is measured is the loop, not the step's time

/// The paper's cube with its top under a plate; 22 kPa gives about 2 kN/m.
/// Damped as soft matter is: at 1 kHz implicit Euler damps next to nothing, and a cube that rings after the
/// press would be taken for a loop that does.
Asset cube(double youngs_modulus_pa) {
    Asset asset = knead::test::cube_asset(kCells, ToolShape::plate, ToolContact::sticking,
                                          {youngs_modulus_pa, 0.3, 1000});
    asset.damping_per_s = 20;
    return asset;
}

/// A light grip: what is stable in it is stable in a firm one.
ZWidthSetup light_grip(const DevicePreset& device, bool passivity) {
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

std::string text_of(const ZWidth& found) {
    char text[32];
    std::snprintf(text, sizeof text, "%s%.0f", found.at_most ? ">= " : "", found.stiffness_n_per_m);
    return text;
}

ZWidth two_rate(const Asset& asset, ZWidthSetup setup, LocalRendering rendering, double rate_hz,
                double latency_periods) {
    setup.haptic.mode = HapticMode::two_rate;
    setup.haptic.rendering = rendering;
    setup.haptic.simulation_rate_hz = rate_hz;
    setup.latency_periods = latency_periods;
    return find_z_width(asset, setup);
}

constexpr LocalRendering kRenderings[] = {LocalRendering::hold, LocalRendering::linear,
                                          LocalRendering::reduced_object};

void print_shares(const std::vector<DevicePreset>& devices, bool passivity) {
    std::printf("| E, kPa | device | latency | 1 kHz | hold | linear | reduced object | share |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    for (const double youngs_modulus_pa : {5.5e3, 22e3, 88e3})
        for (const char* name : {"touch", "phantom_desktop", "inverse3"}) {
            const Asset asset = cube(youngs_modulus_pa);
            ZWidthSetup setup = light_grip(find_device(devices, name), passivity);
            setup.hand.coulomb_friction_n = 0;  // it would hide what the rendering does
            const ZWidth synchronous = find_z_width(asset, setup);
            for (const double latency : {0.12, 1.0}) {
                std::printf("| %.1f | %s | %.2f | %s |", youngs_modulus_pa / 1e3, name, latency,
                            text_of(synchronous).c_str());
                ZWidth found;
                for (const LocalRendering rendering : kRenderings) {
                    found = two_rate(asset, setup, rendering, 120, latency);
                    std::printf(" %s |", text_of(found).c_str());
                }
                std::printf(" %.0f %% |\n", 100 * found.stiffness_n_per_m / synchronous.stiffness_n_per_m);
                std::fflush(stdout);
            }
        }
}

void print_devices(const std::vector<DevicePreset>& devices, bool passivity) {
    const Asset asset = cube(22e3);
    std::printf("| device | 1 kHz |");
    for (const int rate_hz : {60, 120, 500})
        std::printf(" hold %d | linear %d | reduced %d |", rate_hz, rate_hz, rate_hz);
    std::printf("\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const DevicePreset& device : devices) {
        const ZWidthSetup setup = light_grip(device, passivity);
        std::printf("| %s | %s |", device.name.c_str(), text_of(find_z_width(asset, setup)).c_str());
        for (const double rate_hz : {60.0, 120.0, 500.0})
            for (const LocalRendering rendering : kRenderings)
                std::printf(" %s |", text_of(two_rate(asset, setup, rendering, rate_hz, 0.12)).c_str());
        std::printf("\n");
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    if (argc < 3) return 2;
    std::ifstream stream(argv[1]);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::vector<DevicePreset> devices = parse_device_presets(text, argv[1]);
    const bool passivity = argc < 4 || std::string(argv[3]) == "1";
    if (std::string(argv[2]) == "shares") print_shares(devices, passivity);
    if (std::string(argv[2]) == "devices") print_devices(devices, passivity);
    return 0;
}
