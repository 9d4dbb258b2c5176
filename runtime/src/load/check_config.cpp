// SPDX-License-Identifier: Apache-2.0
#include "load/check_config.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/step.h"

namespace knead {
namespace {

using core::kLargestStep_s;
using core::kSmallestStep_s;

Error bad(const std::string& what) {
    return Error{ErrorCode::invalid_argument, what, "SimulationConfig"};
}

Error out_of_range(const char* member, double value, const char* range) {
    return bad(std::string(member) + " is " + std::to_string(value) + ", must be " + range);
}

bool finite_and_not_negative(double value) {
    return std::isfinite(value) && value >= 0;
}

Status check_tools(const std::vector<std::size_t>& tools, const Asset& asset) {
    if (tools.empty()) return bad("tools is empty: a simulation has at least one tool");
    for (std::size_t k = 0; k < tools.size(); ++k) {
        if (tools[k] >= asset.tools.size()) {
            return bad("tools has " + std::to_string(tools[k]) + ", but the asset has " +
                       std::to_string(asset.tools.size()) + " tools");
        }
        if (std::find(tools.begin(), tools.begin() + static_cast<std::ptrdiff_t>(k), tools[k]) !=
            tools.begin() + static_cast<std::ptrdiff_t>(k)) {
            return bad("tools has " + std::to_string(tools[k]) + " twice");
        }
    }
    return Unit{};
}

}  // namespace

Status check_config(const SimulationConfig& config, const Asset& asset) {
    if (Status status = check_tools(config.tools, asset); !status) return status;
    if (!(config.expected_dt_s >= kSmallestStep_s && config.expected_dt_s <= kLargestStep_s)) {
        return out_of_range("expected_dt_s", config.expected_dt_s, "0.25e-3 to 20e-3");
    }
    if (config.arithmetic > Arithmetic::mixed) {
        return out_of_range("arithmetic", static_cast<double>(config.arithmetic),
                            "automatic, float32, float64 or mixed");
    }
    if (!(config.force_tolerance > 0 && config.force_tolerance <= 0.1)) {
        return out_of_range("force_tolerance", config.force_tolerance, "above 0 and at most 0.1");
    }
    if (config.max_solver_iterations <= 0) {
        return out_of_range("max_solver_iterations", config.max_solver_iterations, "above 0");
    }
    if (config.max_contact_passes <= 0) {
        return out_of_range("max_contact_passes", config.max_contact_passes, "above 0");
    }
    if (config.max_linearisations < 0) {
        return out_of_range("max_linearisations", config.max_linearisations, "at least 0");
    }
    if (!finite_and_not_negative(config.coupling_stiffness_n_per_m)) {
        return out_of_range("coupling_stiffness_n_per_m", config.coupling_stiffness_n_per_m,
                            "finite and not negative");
    }
    if (!finite_and_not_negative(config.coupling_damping_n_s_per_m)) {
        return out_of_range("coupling_damping_n_s_per_m", config.coupling_damping_n_s_per_m,
                            "finite and not negative");
    }
    if (config.coupling_damping_n_s_per_m > 0 && config.coupling_stiffness_n_per_m == 0) {
        return bad("coupling_damping_n_s_per_m without coupling_stiffness_n_per_m: there is no coupling");
    }
    if (config.coupling_stiffness_n_per_m > 0 &&
        !(config.tool_mass_kg > 0 && std::isfinite(config.tool_mass_kg))) {
        return out_of_range("tool_mass_kg", config.tool_mass_kg, "finite and above 0");
    }
    return Unit{};
}

}  // namespace knead
