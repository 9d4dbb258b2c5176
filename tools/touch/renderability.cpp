// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/renderability.h"

#include <fmt/format.h>

#include <algorithm>

namespace knead::tools {
namespace {

constexpr double kHapticRate_hz = 1000;
constexpr std::array<double, 3> kSimulationRates_hz{60, 120, 500};

std::vector<RenderableRate> rates_to_try() {
    std::vector<RenderableRate> rates(1);
    for (const double simulation_rate_hz : kSimulationRates_hz)
        rates.push_back({HapticMode::two_rate, kHapticRate_hz, simulation_rate_hz, {}});
    return rates;
}

ZWidthSetup setup_of(const RenderableRate& rate, std::size_t tool, const PressLine& line,
                     const DevicePreset& preset) {
    ZWidthSetup setup;
    setup.haptic.mode = rate.mode;
    setup.haptic.rate_hz = rate.rate_hz;
    if (rate.mode == HapticMode::two_rate) setup.haptic.simulation_rate_hz = rate.simulation_rate_hz;
    setup.haptic.safety = safety_for(preset);
    setup.simulation.tools = {tool};
    setup.hand = operator_on(preset);
    setup.direction = line.direction;
    return setup;
}

std::string name_of(const RenderableRate& rate) {
    if (rate.mode == HapticMode::synchronous) return fmt::format("synchronous at {:g} Hz", rate.rate_hz);
    return fmt::format("simulation at {:g} Hz", rate.simulation_rate_hz);
}

}  // namespace

Renderability find_renderability(
    const Asset& asset, std::size_t tool, const PressLine& line, const DevicePreset& preset,
    const std::function<void(std::size_t, std::size_t, const std::string&)>& progress) {
    Renderability found;
    found.rates = rates_to_try();
    const std::size_t parts = found.rates.size() + 1;
    const auto tell = [&](std::size_t done, const std::string& what) {
        if (progress) progress(done, parts, what);
    };
    tell(0, "press");
    found.curve = press_curve(asset, tool, line);
    const double limit_n = preset.max_force_n.value;
    found.saturation_depth_m = found.curve.depth_of_force(limit_n);
    if (found.saturation_depth_m)
        found.saturation_hand_depth_m =
            *found.saturation_depth_m + limit_n / preset.max_stiffness_n_per_m.value;
    for (const PressPoint& point : found.curve.points)
        if (point.force_n > 0) found.force_scale = std::min(found.force_scale, limit_n / point.force_n);
    for (std::size_t i = 0; i < found.rates.size(); ++i) {
        tell(i + 1, name_of(found.rates[i]));
        found.rates[i].width = find_z_width(asset, setup_of(found.rates[i], tool, line, preset));
    }
    return found;
}

}  // namespace knead::tools
