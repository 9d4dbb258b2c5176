// SPDX-License-Identifier: Apache-2.0
#include "load/check_config.h"

#include <cmath>
#include <string>

namespace knead {
namespace {

Error bad(const std::string& what) {
    return Error{ErrorCode::invalid_argument, what, "SimulationConfig"};
}

Error out_of_range(const char* member, double value, const char* range) {
    return bad(std::string(member) + " is " + std::to_string(value) + ", must be " + range);
}

bool finite_and_not_negative(double value) {
    return std::isfinite(value) && value >= 0;
}

}  // namespace

Status check_config(const SimulationConfig& config, const Asset& asset) {
    if (config.tool >= asset.tools.size()) {
        return bad("tool is " + std::to_string(config.tool) + ", but the asset has " +
                   std::to_string(asset.tools.size()) + " tools");
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
