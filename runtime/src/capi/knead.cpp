// SPDX-License-Identifier: Apache-2.0
#include "knead/knead.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "knead/formats/version.h"
#include "knead/runtime/simulation.h"

/// A simulation and the text of what went wrong with it last.
struct knead_simulation {
    knead::Simulation simulation;
    const char* last_error = "";  ///< a literal: steps must not allocate
};

namespace {

constexpr std::size_t kErrorBytes = 1024;
constexpr std::size_t kFirstConfigBytes = offsetof(knead_config, tool_mass_kg) + sizeof(double);
constexpr std::size_t kFirstResultBytes = offsetof(knead_step_result, touched_nodes) + sizeof(std::uint32_t);

thread_local char load_error[kErrorBytes] = "";

knead_error fail_load(knead_error code, const char* text) noexcept {
    std::strncpy(load_error, text, kErrorBytes - 1);
    return code;
}

knead_error fail(knead_simulation& handle, const char* text) noexcept {
    handle.last_error = text;
    return KNEAD_ERROR_INVALID_ARGUMENT;
}

knead::SimulationConfig to_cpp(const knead_config& config) {
    knead::SimulationConfig result;
    result.tools = {config.tool};
    result.force_tolerance = config.force_tolerance;
    result.max_solver_iterations = config.max_solver_iterations;
    result.max_contact_passes = config.max_contact_passes;
    result.coupling_stiffness_n_per_m = config.coupling_stiffness_n_per_m;
    result.coupling_damping_n_s_per_m = config.coupling_damping_n_s_per_m;
    result.tool_mass_kg = config.tool_mass_kg;
    if (config.struct_size >= offsetof(knead_config, expected_dt_s) + sizeof(double))
        result.expected_dt_s = config.expected_dt_s;
    return result;
}

knead_error load(const char* asset_path, const knead_config& config, knead_simulation** out) {
    auto loaded = knead::Simulation::load(std::filesystem::u8path(asset_path), to_cpp(config));
    if (!loaded)
        return fail_load(static_cast<knead_error>(loaded.error().code), loaded.error().text().c_str());
    *out = new knead_simulation{std::move(loaded).value()};
    load_error[0] = '\0';
    return KNEAD_OK;
}

static_assert(KNEAD_STEP_NOT_CONVERGED == int{knead::kStepNotConverged});
static_assert(KNEAD_STEP_NOT_FINITE == int{knead::kStepNotFinite});
static_assert(KNEAD_STEP_BAD_INPUT == int{knead::kStepBadInput});
static_assert(KNEAD_STEP_CONTACT_CAP == int{knead::kStepContactCap});
static_assert(KNEAD_ERROR_INVALID_ARGUMENT == static_cast<int>(knead::ErrorCode::invalid_argument));

}  // namespace

void knead_config_init(knead_config* config) noexcept {
    if (config == nullptr) return;
    const knead::SimulationConfig defaults;
    config->struct_size = sizeof(knead_config);
    config->tool = defaults.tools.front();
    config->force_tolerance = defaults.force_tolerance;
    config->max_solver_iterations = defaults.max_solver_iterations;
    config->max_contact_passes = defaults.max_contact_passes;
    config->coupling_stiffness_n_per_m = defaults.coupling_stiffness_n_per_m;
    config->coupling_damping_n_s_per_m = defaults.coupling_damping_n_s_per_m;
    config->tool_mass_kg = defaults.tool_mass_kg;
    config->expected_dt_s = defaults.expected_dt_s;
}

void knead_step_result_init(knead_step_result* result) noexcept {
    if (result == nullptr) return;
    std::memset(result, 0, sizeof(knead_step_result));
    result->struct_size = sizeof(knead_step_result);
}

knead_error knead_simulation_load(const char* asset_path, const knead_config* config,
                                  knead_simulation** out) noexcept {
    if (out == nullptr) return fail_load(KNEAD_ERROR_INVALID_ARGUMENT, "knead_simulation_load: out is NULL");
    *out = nullptr;
    if (asset_path == nullptr) {
        return fail_load(KNEAD_ERROR_INVALID_ARGUMENT, "knead_simulation_load: asset_path is NULL");
    }
    knead_config used;
    knead_config_init(&used);
    if (config != nullptr) {
        if (config->struct_size < kFirstConfigBytes) {
            return fail_load(
                KNEAD_ERROR_INVALID_ARGUMENT,
                "knead_simulation_load: config->struct_size is not set; call knead_config_init()");
        }
        std::memcpy(&used, config, std::min(config->struct_size, sizeof(used)));
    }
    try {
        return load(asset_path, used, out);
    } catch (const std::bad_alloc&) {
        return fail_load(KNEAD_ERROR_OUT_OF_MEMORY, "knead_simulation_load: out of memory");
    } catch (const std::exception& exception) {
        return fail_load(KNEAD_ERROR_IO, exception.what());
    } catch (...) {
        return fail_load(KNEAD_ERROR_IO, "knead_simulation_load: unknown failure");
    }
}

void knead_simulation_free(knead_simulation* simulation) noexcept {
    delete simulation;
}

knead_error knead_simulation_step(knead_simulation* simulation, const double position_m[3],
                                  const double orientation_wxyz[4], double dt_s,
                                  knead_step_result* result) noexcept {
    if (simulation == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    if (position_m == nullptr) return fail(*simulation, "knead_simulation_step: position_m is NULL");
    if (result == nullptr) return fail(*simulation, "knead_simulation_step: result is NULL");
    if (result->struct_size < kFirstResultBytes) {
        return fail(*simulation,
                    "knead_simulation_step: result->struct_size is not set; call knead_step_result_init()");
    }
    knead::Pose pose = simulation->simulation.tool_rest_pose();
    std::copy_n(position_m, 3, pose.position_m.begin());
    if (orientation_wxyz != nullptr) std::copy_n(orientation_wxyz, 4, pose.orientation_wxyz.begin());
    const knead::StepResult step = simulation->simulation.step(pose, dt_s);
    std::copy_n(step.force_n.begin(), 3, result->force_n);
    std::copy_n(step.tool_position_m.begin(), 3, result->tool_position_m);
    result->status = step.status;
    result->solver_iterations = step.solver_iterations;
    result->touched_nodes = step.touched_nodes;
    return KNEAD_OK;
}

knead_error knead_simulation_reset(knead_simulation* simulation) noexcept {
    if (simulation == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    simulation->simulation.reset();
    return KNEAD_OK;
}

knead_error knead_simulation_rest_pose(const knead_simulation* simulation, double position_m[3],
                                       double orientation_wxyz[4]) noexcept {
    if (simulation == nullptr || position_m == nullptr || orientation_wxyz == nullptr) {
        return KNEAD_ERROR_INVALID_ARGUMENT;
    }
    const knead::Pose pose = simulation->simulation.tool_rest_pose();
    std::copy_n(pose.position_m.begin(), 3, position_m);
    std::copy_n(pose.orientation_wxyz.begin(), 4, orientation_wxyz);
    return KNEAD_OK;
}

size_t knead_simulation_node_count(const knead_simulation* simulation) noexcept {
    return simulation == nullptr ? 0 : simulation->simulation.node_count();
}

size_t knead_simulation_tetrahedron_count(const knead_simulation* simulation) noexcept {
    return simulation == nullptr ? 0 : simulation->simulation.tetrahedron_count();
}

const double* knead_simulation_positions_m(const knead_simulation* simulation) noexcept {
    return simulation == nullptr ? nullptr : simulation->simulation.positions_m();
}

const char* knead_last_error(const knead_simulation* simulation) noexcept {
    return simulation == nullptr ? load_error : simulation->last_error;
}

const char* knead_error_name(knead_error error) noexcept {
    static constexpr const char* kNames[] = {"ok",
                                             "io_error",
                                             "not_knead",
                                             "version_unsupported",
                                             "feature_unsupported",
                                             "wrong_kind",
                                             "missing",
                                             "wrong_type",
                                             "wrong_extent",
                                             "too_large",
                                             "forbidden",
                                             "corrupt",
                                             "invalid_data",
                                             "cannot_write",
                                             "out_of_memory",
                                             "invalid_argument"};
    const auto index = static_cast<std::size_t>(error);
    return index < std::size(kNames) ? kNames[index] : "unknown";
}

const char* knead_step_status_name(uint32_t status) noexcept {
    if (status == 0) return "ok";
    if ((status & KNEAD_STEP_NOT_CONVERGED) != 0) return "not_converged";
    if ((status & KNEAD_STEP_NOT_FINITE) != 0) return "not_finite";
    if ((status & KNEAD_STEP_BAD_INPUT) != 0) return "bad_input";
    if ((status & KNEAD_STEP_CONTACT_CAP) != 0) return "contact_cap";
    return "unknown";
}

const char* knead_version(void) noexcept {
    return knead::kLibraryVersion;
}
