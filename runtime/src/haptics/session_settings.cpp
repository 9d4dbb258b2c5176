// SPDX-License-Identifier: Apache-2.0
#include "haptics/session_settings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <type_traits>

#include "knead/haptics/session.h"

namespace knead {
namespace {

// The structured bindings below stop compiling when a configuration gains or loses a member: give it a name
// here then, or a log would not hold it.

template <class Visit>
void visit_axes(const std::string& name, double* values, std::size_t count, Visit& visit) {
    for (std::size_t i = 0; i < count; ++i)
        visit(name + "." + std::to_string(i), values[i]);
}

template <class Visit>
void visit_all(const std::string& name, WorkspaceMap& map, Visit& visit) {
    auto& [scale, rotation_wxyz, offset_m] = map;
    visit(name + ".scale", scale);
    visit_axes(name + ".rotation_wxyz", rotation_wxyz.data(), rotation_wxyz.size(), visit);
    visit_axes(name + ".offset_m", offset_m.data(), offset_m.size(), visit);
}

template <class Visit>
void visit_all(const std::string& name, CouplingConfig& coupling, Visit& visit) {
    auto& [stiffness, damping, mass, turn_stiffness, turn_damping, inertia] = coupling;
    visit(name + ".stiffness_n_per_m", stiffness);
    visit(name + ".damping_n_s_per_m", damping);
    visit(name + ".tool_mass_kg", mass);
    visit(name + ".rotation_stiffness_nm_per_rad", turn_stiffness);
    visit(name + ".rotation_damping_nm_s_per_rad", turn_damping);
    visit(name + ".tool_inertia_kg_m2", inertia);
}

template <class Visit>
void visit_all(const std::string& name, Watchdog& watchdog, Visit& visit) {
    auto& [stale, zero] = watchdog;
    visit(name + ".stale_after_s", stale);
    visit(name + ".zero_after_s", zero);
}

template <class Visit>
void visit_all(const std::string& name, MotionLimits& motion, Visit& visit) {
    auto& [speed, turn_speed, slack_m, slack_rad, dt_ratio] = motion;
    visit(name + ".max_hand_speed_m_per_s", speed);
    visit(name + ".max_turn_speed_rad_per_s", turn_speed);
    visit(name + ".slack_m", slack_m);
    visit(name + ".slack_rad", slack_rad);
    visit(name + ".max_dt_ratio", dt_ratio);
}

template <class Visit>
void visit_all(const std::string& name, PassivityLimits& passivity, Visit& visit) {
    auto& [damping, resolution, softest, travel, debt, free_energy] = passivity;
    visit(name + ".max_damping", damping);
    visit(name + ".resolution", resolution);
    visit(name + ".softest", softest);
    visit(name + ".travel", travel);
    visit(name + ".max_debt_j", debt);
    visit(name + ".free_energy_j", free_energy);
}

template <class Visit>
void visit_all(const std::string& name, SafetyConfig& safety, Visit& visit) {
    auto& [force, torque, slew_n, slew_nm, ramp_n, ramp_nm, device_watchdog, model_watchdog, motion,
           passivity, force_passivity, torque_passivity] = safety;
    visit(name + ".max_force_n", force);
    visit(name + ".max_torque_nm", torque);
    visit(name + ".slew_n_per_ms", slew_n);
    visit(name + ".slew_nm_per_ms", slew_nm);
    visit(name + ".ramp_n_per_s", ramp_n);
    visit(name + ".ramp_nm_per_s", ramp_nm);
    visit_all(name + ".device_watchdog", device_watchdog, visit);
    visit_all(name + ".model_watchdog", model_watchdog, visit);
    visit_all(name + ".motion", motion, visit);
    visit(name + ".passivity", passivity);
    visit_all(name + ".force_passivity", force_passivity, visit);
    visit_all(name + ".torque_passivity", torque_passivity, visit);
}

template <class Visit>
void visit_all(HapticConfig& config, Visit& visit) {
    const std::string name = "haptic";
    auto& [workspace, force_scale, rate_hz, mode, simulation_rate_hz, rendering, correction_gain, coupling,
           safety, realtime_priority] = config;
    visit_all(name + ".workspace", workspace, visit);
    visit(name + ".force_scale", force_scale);
    visit(name + ".rate_hz", rate_hz);
    visit(name + ".mode", mode, HapticMode::two_rate);
    visit(name + ".simulation_rate_hz", simulation_rate_hz);
    visit(name + ".rendering", rendering, LocalRendering::hold);
    visit(name + ".correction_gain", correction_gain);
    visit_all(name + ".coupling", coupling, visit);
    visit_all(name + ".safety", safety, visit);
    visit(name + ".realtime_priority", realtime_priority);
}

template <class Visit>
void visit_all(SimulationConfig& config, Visit& visit) {
    const std::string name = "simulation";
    auto& [tools, expected_dt_s, arithmetic, force_tolerance, solver_iterations, contact_passes,
           linearisations, with_torque, with_local_model, stiffness, damping, mass] = config;
    tools.resize(1);
    visit(name + ".tool", tools[0]);
    visit(name + ".expected_dt_s", expected_dt_s);
    visit(name + ".arithmetic", arithmetic, Arithmetic::mixed);
    visit(name + ".force_tolerance", force_tolerance);
    visit(name + ".max_solver_iterations", solver_iterations);
    visit(name + ".max_contact_passes", contact_passes);
    visit(name + ".max_linearisations", linearisations);
    visit(name + ".with_torque", with_torque);
    visit(name + ".with_local_model", with_local_model);
    visit(name + ".coupling_stiffness_n_per_m", stiffness);
    visit(name + ".coupling_damping_n_s_per_m", damping);
    visit(name + ".tool_mass_kg", mass);
}

struct Save {
    std::vector<SessionLog::Setting> settings;
    template <class T>
    void operator()(const std::string& name, T value, T /*last*/ = {}) {
        settings.push_back({name, static_cast<double>(value)});
    }
};

/// Fills members from a log. The first problem stays in `problem`.
struct Restore {
    std::map<std::string, double> values;
    std::string problem;

    void operator()(const std::string& name, double& member) { take(name, member); }
    void operator()(const std::string& name, bool& member) { whole(name, member, 1); }
    void operator()(const std::string& name, int& member) {
        whole(name, member, std::numeric_limits<int>::max());
    }
    void operator()(const std::string& name, std::size_t& member) { whole(name, member, 1e6); }
    template <class Enum>
    void operator()(const std::string& name, Enum& member, Enum last) {
        whole(name, member, static_cast<double>(last));
    }

  private:
    void take(const std::string& name, double& member) {
        const auto found = values.find(name);
        if (found == values.end()) return fail(name + " is missing");
        member = found->second;
        values.erase(found);
    }
    template <class T>
    void whole(const std::string& name, T& member, double most) {
        double value = 0;
        take(name, value);
        if (!(value >= 0 && value <= most) || value != std::floor(value))
            return fail(name + " is " + std::to_string(value) + ", not a whole number from 0 to " +
                        std::to_string(static_cast<long long>(most)));
        member = static_cast<T>(value);
    }
    void fail(const std::string& what) {
        if (problem.empty()) problem = what;
    }
};

/// @param prefix of the names that belong to this configuration
template <class Config>
Result<Config> config_of(const SessionLog& log, const std::string& prefix) {
    Restore restore;
    for (const SessionLog::Setting& setting : log.settings)
        if (setting.name.compare(0, prefix.size(), prefix) == 0) restore.values[setting.name] = setting.value;
    Config config;
    visit_all(config, restore);
    if (restore.problem.empty() && !restore.values.empty())
        restore.problem = restore.values.begin()->first + " is not a setting that this version of Knead has";
    if (!restore.problem.empty())
        return Error{ErrorCode::invalid_data, restore.problem, "/knead/session/settings"};
    return config;
}

}  // namespace

std::vector<SessionLog::Setting> settings_of(const HapticConfig& haptic, const SimulationConfig& simulation) {
    Save save;
    HapticConfig h = haptic;
    SimulationConfig s = simulation;
    visit_all(h, save);
    visit_all(s, save);
    std::sort(save.settings.begin(), save.settings.end(),
              [](const auto& a, const auto& b) { return a.name < b.name; });
    return save.settings;
}

Result<HapticConfig> haptic_config_of(const SessionLog& log) {
    return config_of<HapticConfig>(log, "haptic.");
}

Result<SimulationConfig> simulation_config_of(const SessionLog& log) {
    return config_of<SimulationConfig>(log, "simulation.");
}

}  // namespace knead
