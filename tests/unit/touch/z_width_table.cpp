// SPDX-License-Identifier: Apache-2.0
// The tables of docs/devices.md: how stiff a coupling may be, by device, rendering and rate of the
// simulation.
//   z_width_table DEVICES.toml shares           the 12 set-ups, and how many of them keep their range
//   z_width_table DEVICES.toml others           12 others, at which nobody looked while the loop was made
//   z_width_table DEVICES.toml devices 0|1      every preset; the last: with the passivity controller
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <tuple>

#include "unit/touch/z_width_setups.h"

namespace knead::tools::test {
namespace {

constexpr LocalRendering kRenderings[] = {LocalRendering::hold, LocalRendering::linear,
                                          LocalRendering::reduced_object};
constexpr double kRates_hz[] = {60, 120, 500};

std::string text_of(const ZWidth& found) {
    char text[32];
    std::snprintf(text, sizeof text, "%s%.0f", found.at_most ? ">= " : "", found.stiffness_n_per_m);
    return text;
}

double share(double found, double synchronous, double most) {
    return std::min(found, most) / std::min(synchronous, most);
}

/// Twelve set-ups with the compared devices.
struct SetUps {
    std::array<double, 3> youngs_moduli_pa;
    std::array<double, 2> latencies;
    Asset (*cube)(double youngs_modulus_pa);
    ZWidthSetup (*grip)(const DevicePreset& device);
};

/// A ball without friction instead of the plate.
Asset cube_under_ball(double youngs_modulus_pa) {
    Asset asset = knead::test::cube_asset(4, ToolShape::sphere, ToolContact::frictionless,
                                          {youngs_modulus_pa, 0.3, 1000});
    asset.damping_per_s = 20;
    return asset;
}

ZWidthSetup firmer_grip(const DevicePreset& device) {
    ZWidthSetup setup = compared_grip(device);
    setup.hand.hand_mass_kg = 0.08;
    setup.hand.hand_stiffness_n_per_m = 300;
    setup.hand.hand_damping_n_s_per_m = 2;
    return setup;
}

const SetUps kCompared{kYoungsModuli_pa, kLatencies, measured_cube, compared_grip};
const SetUps kOthers{{11e3, 44e3, 160e3}, {0.35, 0.75}, cube_under_ball, firmer_grip};

/// Of one rendering at one rate and latency: how many set-ups keep their range.
struct Count {
    int kept = 0, kept_of_interest = 0;
};
using Counts = std::map<std::tuple<int, double, double>, Count>;

void print_counts(const SetUps& set_ups, Counts& counts) {
    std::printf("\n| rendering | latency | 60 Hz | 120 Hz | 500 Hz |\n|---|---|---|---|---|\n");
    const char* const names[] = {"hold", "linear", "reduced object"};
    for (std::size_t r = 0; r < 3; ++r)
        for (const double latency : set_ups.latencies) {
            std::printf("| %s | %.2f |", names[r], latency);
            for (const double rate_hz : kRates_hz) {
                const Count& count = counts[{static_cast<int>(r), latency, rate_hz}];
                std::printf(" %d / %d |", count.kept, count.kept_of_interest);
            }
            std::printf("\n");
        }
}

void print_shares(const std::vector<DevicePreset>& devices, const SetUps& set_ups) {
    std::printf(
        "| E, kPa | device | latency | 1 kHz | hold | linear | reduced object | share | of interest |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|\n");
    Counts counts;
    for (const double youngs_modulus_pa : set_ups.youngs_moduli_pa)
        for (const char* name : kComparedDevices) {
            const Asset asset = set_ups.cube(youngs_modulus_pa);
            const DevicePreset& device = find_device(devices, name);
            const ZWidthSetup setup = set_ups.grip(device);
            const double most = range_of_interest_n_per_m(device);
            const ZWidth synchronous = find_z_width(asset, setup);
            for (const double latency : set_ups.latencies) {
                std::map<double, std::string> cells;
                ZWidth reduced;
                for (const double rate_hz : kRates_hz)
                    for (std::size_t r = 0; r < 3; ++r) {
                        const ZWidth found =
                            find_z_width(asset, two_rate(setup, kRenderings[r], rate_hz, latency));
                        Count& count = counts[{static_cast<int>(r), latency, rate_hz}];
                        const double whole = found.stiffness_n_per_m, one = synchronous.stiffness_n_per_m;
                        count.kept += whole >= kKept * one ? 1 : 0;
                        count.kept_of_interest += share(whole, one, most) >= kKept ? 1 : 0;
                        cells[rate_hz] += " " + text_of(found) + " |";
                        if (rate_hz == 120) reduced = found;
                    }
                std::printf("| %.1f | %s | %.2f | %s |%s %.0f %% | %.0f %% |\n", youngs_modulus_pa / 1e3,
                            name, latency, text_of(synchronous).c_str(), cells[120].c_str(),
                            100 * reduced.stiffness_n_per_m / synchronous.stiffness_n_per_m,
                            100 * share(reduced.stiffness_n_per_m, synchronous.stiffness_n_per_m, most));
                std::fflush(stdout);
            }
        }
    print_counts(set_ups, counts);
}

/// The largest stiffness in kN/m; "+": the largest one tried was good.
std::string short_text(const ZWidth& found) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g%s", found.stiffness_n_per_m / 1e3, found.at_most ? "+" : "");
    return text;
}

/// "stable / passive": the largest stiffness that is the one, and the other.
void print_cell(const Asset& asset, const ZWidthSetup& setup) {
    ZWidthSearch stable, passive;
    stable.must_be_passive = false;
    passive.must_be_stable = false;
    std::printf(" %s / %s |", short_text(find_z_width(asset, setup, stable)).c_str(),
                short_text(find_z_width(asset, setup, passive)).c_str());
}

void print_devices(const std::vector<DevicePreset>& devices, bool passivity) {
    constexpr double kLatency = 0.12;
    const Asset asset = measured_cube(22e3);
    std::printf("| device | 1 kHz |");
    for (const double rate_hz : kRates_hz)
        std::printf(" hold %.0f | linear %.0f | reduced %.0f |", rate_hz, rate_hz, rate_hz);
    std::printf("\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const DevicePreset& device : devices) {
        const ZWidthSetup setup = light_grip(device, passivity);
        std::printf("| %s |", device.name.c_str());
        print_cell(asset, setup);
        for (const double rate_hz : kRates_hz)
            for (const LocalRendering rendering : kRenderings)
                print_cell(asset, two_rate(setup, rendering, rate_hz, kLatency));
        std::printf("\n");
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace knead::tools::test

int main(int argc, char** argv) {
    using namespace knead::tools::test;
    if (argc < 3) return 2;
    const auto devices = read_devices(argv[1]);
    const std::string what = argv[2];
    if (what == "shares") print_shares(devices, kCompared);
    if (what == "others") print_shares(devices, kOthers);
    if (what == "devices") print_devices(devices, argc < 4 || std::string(argv[3]) == "1");
    return 0;
}
