// SPDX-License-Identifier: Apache-2.0
#include "knead/knead.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "capi/give.h"
#include "knead/formats/version.h"
#include "knead/runtime/simulation.h"

/// A simulation and the text of what went wrong with it last.
struct knead_simulation {
    knead::Simulation simulation;
    std::vector<knead::Pose> poses;  ///< [tools] of the step under way
    const char* last_error = "";     ///< a literal: steps must not allocate
};

namespace {

using knead::capi::give;
using knead::capi::to_c;

constexpr std::size_t kErrorBytes = 1024;
/// Of the first version of each struct: less was not filled in by its init function.
constexpr std::size_t kFirstConfigBytes = sizeof(knead_config);
constexpr std::size_t kFirstResultBytes = sizeof(knead_step_result);
constexpr std::size_t kFirstModelBytes = sizeof(knead_local_model);

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
    if (config.tools != nullptr) result.tools.assign(config.tools, config.tools + config.tool_count);
    result.expected_dt_s = config.expected_dt_s;
    result.arithmetic = static_cast<knead::Arithmetic>(config.arithmetic);
    result.force_tolerance = config.force_tolerance;
    result.max_solver_iterations = config.max_solver_iterations;
    result.max_contact_passes = config.max_contact_passes;
    result.max_linearisations = config.max_linearisations;
    result.with_torque = config.with_torque != 0;
    result.coupling_stiffness_n_per_m = config.coupling_stiffness_n_per_m;
    result.coupling_damping_n_s_per_m = config.coupling_damping_n_s_per_m;
    result.tool_mass_kg = config.tool_mass_kg;
    result.with_local_model = config.with_local_model != 0;
    return result;
}

knead::Pose to_cpp(const knead_pose& pose) noexcept {
    knead::Pose result;
    std::copy_n(pose.position_m, 3, result.position_m.begin());
    std::copy_n(pose.orientation_wxyz, 4, result.orientation_wxyz.begin());
    return result;
}

void give(const knead::StepResult& step, const knead::ToolResult& tool, std::size_t their_size,
          void* theirs) noexcept {
    knead_step_result result{};
    std::copy_n(tool.force_n.begin(), 3, result.force_n);
    std::copy_n(tool.torque_nm.begin(), 3, result.torque_nm);
    std::copy_n(tool.tool_position_m.begin(), 3, result.tool_position_m);
    result.touched_nodes = tool.touched_nodes;
    result.status = step.status;
    result.solver_iterations = step.solver_iterations;
    give(result, their_size, theirs);
}

void give(const knead::LocalModel& model, std::size_t their_size, void* theirs) noexcept {
    knead_local_model result{};
    result.origin = to_c(model.origin);
    std::copy_n(model.force_n.begin(), 3, result.force_n);
    std::copy_n(model.torque_nm.begin(), 3, result.torque_nm);
    std::copy_n(model.stiffness.begin(), 36, result.stiffness);
    std::copy_n(model.damping.begin(), 36, result.damping);
    std::copy_n(model.mass.begin(), 36, result.mass);
    std::copy_n(model.normal.begin(), 3, result.normal);
    result.radius_m = model.radius_m;
    result.step = model.step;
    result.touched_nodes = model.touched_nodes;
    result.unilateral = model.unilateral ? 1 : 0;
    give(result, their_size, theirs);
}

/// Whether the config can be read at all; what it says is checked when loading.
const char* problem_of(const knead_config& config) noexcept {
    if (config.struct_size < kFirstConfigBytes)
        return "knead_simulation_load: config->struct_size is not set; call knead_config_init()";
    if (config.tools == nullptr && config.tool_count != 0)
        return "knead_simulation_load: config->tools is NULL, but tool_count is not 0";
    if (config.arithmetic < KNEAD_ARITHMETIC_AUTOMATIC || config.arithmetic > KNEAD_ARITHMETIC_MIXED)
        return "knead_simulation_load: config->arithmetic is none of KNEAD_ARITHMETIC_*";
    return nullptr;
}

knead_error load(const char* asset_path, const knead_config& config, knead_simulation** out) {
    auto loaded = knead::Simulation::load(std::filesystem::u8path(asset_path), to_cpp(config));
    if (!loaded)
        return fail_load(static_cast<knead_error>(loaded.error().code), loaded.error().text().c_str());
    const std::size_t tools = loaded.value().tool_count();
    *out = new knead_simulation{std::move(loaded).value(), std::vector<knead::Pose>(tools)};
    load_error[0] = '\0';
    return KNEAD_OK;
}

static_assert(KNEAD_STEP_NOT_CONVERGED == int{knead::kStepNotConverged});
static_assert(KNEAD_STEP_NOT_FINITE == int{knead::kStepNotFinite});
static_assert(KNEAD_STEP_BAD_INPUT == int{knead::kStepBadInput});
static_assert(KNEAD_STEP_CONTACT_CAP == int{knead::kStepContactCap});
static_assert(KNEAD_STEP_INSIDE_OUT == int{knead::kStepInsideOut});
static_assert(KNEAD_ERROR_INVALID_ARGUMENT == static_cast<int>(knead::ErrorCode::invalid_argument));

}  // namespace

void knead_config_init(knead_config* config) noexcept {
    if (config == nullptr) return;
    const knead::SimulationConfig defaults;
    config->struct_size = sizeof(knead_config);
    config->tools = nullptr;
    config->tool_count = 0;
    config->expected_dt_s = defaults.expected_dt_s;
    config->force_tolerance = defaults.force_tolerance;
    config->max_solver_iterations = defaults.max_solver_iterations;
    config->max_contact_passes = defaults.max_contact_passes;
    config->arithmetic = static_cast<std::int32_t>(defaults.arithmetic);
    config->with_torque = defaults.with_torque ? 1 : 0;
    config->coupling_stiffness_n_per_m = defaults.coupling_stiffness_n_per_m;
    config->coupling_damping_n_s_per_m = defaults.coupling_damping_n_s_per_m;
    config->tool_mass_kg = defaults.tool_mass_kg;
    config->with_local_model = defaults.with_local_model ? 1 : 0;
    config->max_linearisations = defaults.max_linearisations;
}

void knead_step_result_init(knead_step_result* result) noexcept {
    if (result == nullptr) return;
    *result = knead_step_result{};
    result->struct_size = sizeof(knead_step_result);
}

void knead_local_model_init(knead_local_model* model) noexcept {
    if (model == nullptr) return;
    *model = knead_local_model{};
    model->struct_size = sizeof(knead_local_model);
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
        if (const char* problem = problem_of(*config); problem != nullptr)
            return fail_load(KNEAD_ERROR_INVALID_ARGUMENT, problem);
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
    knead::Simulation& object = simulation->simulation;
    if (object.tool_count() != 1)
        return fail(*simulation, "knead_simulation_step: several tools; call knead_simulation_step_tools()");
    knead::Pose pose = object.tool_rest_pose();
    std::copy_n(position_m, 3, pose.position_m.begin());
    if (orientation_wxyz != nullptr) std::copy_n(orientation_wxyz, 4, pose.orientation_wxyz.begin());
    const knead::StepResult step = object.step(pose, dt_s);
    give(step, step, result->struct_size, result);
    return KNEAD_OK;
}

knead_error knead_simulation_step_tools(knead_simulation* simulation, const knead_pose* poses, double dt_s,
                                        knead_step_result* results) noexcept {
    if (simulation == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    if (poses == nullptr) return fail(*simulation, "knead_simulation_step_tools: poses is NULL");
    if (results == nullptr) return fail(*simulation, "knead_simulation_step_tools: results is NULL");
    const std::size_t size = results->struct_size;
    if (size < kFirstResultBytes) {
        return fail(*simulation,
                    "knead_simulation_step_tools: results->struct_size is not set; call "
                    "knead_step_result_init()");
    }
    knead::Simulation& object = simulation->simulation;
    for (std::size_t k = 0; k < simulation->poses.size(); ++k)
        simulation->poses[k] = to_cpp(poses[k]);
    const knead::StepResult step = object.step(simulation->poses.data(), dt_s);
    auto* bytes = reinterpret_cast<unsigned char*>(results);
    for (std::size_t k = 0; k < object.tool_count(); ++k)
        give(step, object.tool(k), size, bytes + k * size);
    return KNEAD_OK;
}

knead_error knead_simulation_local_model(knead_simulation* simulation, size_t tool,
                                         knead_local_model* model) noexcept {
    if (simulation == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    if (model == nullptr) return fail(*simulation, "knead_simulation_local_model: model is NULL");
    if (model->struct_size < kFirstModelBytes) {
        return fail(*simulation,
                    "knead_simulation_local_model: model->struct_size is not set; call "
                    "knead_local_model_init()");
    }
    if (tool >= simulation->simulation.tool_count())
        return fail(*simulation, "knead_simulation_local_model: there is no such tool");
    knead::LocalModel found;
    if (!simulation->simulation.local_model(tool, found))
        return fail(*simulation,
                    "knead_simulation_local_model: no model: not asked for in the config, or no step yet");
    give(found, model->struct_size, model);
    return KNEAD_OK;
}

knead_error knead_simulation_reset(knead_simulation* simulation) noexcept {
    if (simulation == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    simulation->simulation.reset();
    return KNEAD_OK;
}

knead_error knead_simulation_rest_pose(const knead_simulation* simulation, size_t tool,
                                       knead_pose* pose) noexcept {
    if (simulation == nullptr || pose == nullptr || tool >= simulation->simulation.tool_count())
        return KNEAD_ERROR_INVALID_ARGUMENT;
    *pose = to_c(simulation->simulation.tool_rest_pose(tool));
    return KNEAD_OK;
}

size_t knead_simulation_tool_count(const knead_simulation* simulation) noexcept {
    return simulation == nullptr ? 0 : simulation->simulation.tool_count();
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

knead_error knead_simulation_velocities_m_per_s(const knead_simulation* simulation, double* out) noexcept {
    if (simulation == nullptr || out == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    simulation->simulation.velocities_m_per_s(out);
    return KNEAD_OK;
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
    if ((status & KNEAD_STEP_INSIDE_OUT) != 0) return "inside_out";
    return "unknown";
}

const char* knead_version(void) noexcept {
    return knead::kLibraryVersion;
}
