// SPDX-License-Identifier: Apache-2.0
#include "knead/knead_haptics.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "capi/give.h"
#include "knead/haptics/haptic_loop.h"
#include "knead/runtime/simulation.h"

namespace {

using knead::capi::give;
using knead::capi::to_c;

constexpr std::size_t kErrorBytes = 1024;

knead_device_state to_c(const knead::DeviceState& state) noexcept {
    knead_device_state result{};
    std::copy_n(state.pose.position_m.begin(), 3, result.position_m);
    std::copy_n(state.pose.orientation_wxyz.begin(), 4, result.orientation_wxyz);
    std::copy_n(state.velocity_m_per_s.begin(), 3, result.velocity_m_per_s);
    result.time_s = state.time_s;
    result.buttons = state.buttons;
    return result;
}

/// The caller's two functions as a device.
class CallbackDevice final : public knead::Device {
  public:
    explicit CallbackDevice(const knead_device& functions) noexcept : functions_(functions) {}

    [[nodiscard]] knead::DeviceState read() noexcept override {
        knead_device_state state = to_c(knead::DeviceState{});
        functions_.read(functions_.user, &state);
        knead::DeviceState result;
        std::copy_n(state.position_m, 3, result.pose.position_m.begin());
        std::copy_n(state.orientation_wxyz, 4, result.pose.orientation_wxyz.begin());
        std::copy_n(state.velocity_m_per_s, 3, result.velocity_m_per_s.begin());
        result.time_s = state.time_s;
        result.buttons = state.buttons;
        return result;
    }
    void write(const knead::Vec3& force_n, const knead::Vec3& torque_nm) noexcept override {
        functions_.write(functions_.user, force_n.data(), torque_nm.data());
    }

  private:
    knead_device functions_;
};

}  // namespace

/// Stays where it is: the loop keeps references to device and simulation.
struct knead_haptic_loop {
    knead_haptic_loop(const knead_device& functions, knead::Simulation object) noexcept
        : device(functions), simulation(std::move(object)) {}

    CallbackDevice device;
    knead::Simulation simulation;
    std::optional<knead::HapticLoop> loop;
    bool two_rate = false;
    char last_error[kErrorBytes] = "";
};

namespace {

/// Of the first version of each struct: less was not filled in by its init function.
constexpr std::size_t kFirstConfigBytes = sizeof(knead_haptic_config);
constexpr std::size_t kFirstTickBytes = sizeof(knead_haptic_tick);
constexpr std::size_t kFirstStatisticsBytes = sizeof(knead_run_statistics);
thread_local char load_error[kErrorBytes] = "";

knead_error fail_load(knead_error code, const char* text) noexcept {
    std::strncpy(load_error, text, kErrorBytes - 1);
    return code;
}

knead_error fail_load(const knead::Error& error) {
    return fail_load(static_cast<knead_error>(error.code), error.text().c_str());
}

knead_error fail(knead_haptic_loop& handle, knead_error code, const char* text) noexcept {
    std::strncpy(handle.last_error, text, kErrorBytes - 1);
    return code;
}

knead_error fail(knead_haptic_loop& handle, const char* text) noexcept {
    return fail(handle, KNEAD_ERROR_INVALID_ARGUMENT, text);
}

const char* problem_of(const knead_haptic_config& config) noexcept {
    if (config.struct_size < kFirstConfigBytes)
        return "knead_haptic_loop_load: config->struct_size is not set; call knead_haptic_config_init()";
    if (config.mode != KNEAD_HAPTIC_SYNCHRONOUS && config.mode != KNEAD_HAPTIC_TWO_RATE)
        return "knead_haptic_loop_load: config->mode is none of KNEAD_HAPTIC_SYNCHRONOUS, _TWO_RATE";
    if (config.rendering < KNEAD_RENDER_REDUCED_OBJECT || config.rendering > KNEAD_RENDER_HOLD)
        return "knead_haptic_loop_load: config->rendering is none of KNEAD_RENDER_*";
    return nullptr;
}

knead::HapticConfig to_cpp(const knead_haptic_config& config) {
    knead::HapticConfig result;
    result.workspace.scale = config.workspace_scale;
    std::copy_n(config.workspace_rotation_wxyz, 4, result.workspace.rotation_wxyz.begin());
    std::copy_n(config.workspace_offset_m, 3, result.workspace.offset_m.begin());
    result.force_scale = config.force_scale;
    result.rate_hz = config.rate_hz;
    result.simulation_rate_hz = config.simulation_rate_hz;
    result.mode = static_cast<knead::HapticMode>(config.mode);
    result.rendering = static_cast<knead::LocalRendering>(config.rendering);
    result.coupling.stiffness_n_per_m = config.coupling_stiffness_n_per_m;
    result.coupling.damping_n_s_per_m = config.coupling_damping_n_s_per_m;
    result.coupling.rotation_stiffness_nm_per_rad = config.coupling_rotation_stiffness_nm_per_rad;
    result.coupling.rotation_damping_nm_s_per_rad = config.coupling_rotation_damping_nm_s_per_rad;
    result.safety.max_force_n = config.max_force_n;
    result.safety.max_torque_nm = config.max_torque_nm;
    result.safety.slew_n_per_ms = config.slew_n_per_ms;
    result.safety.ramp_n_per_s = config.ramp_n_per_s;
    result.safety.passivity = config.passivity_control != 0;
    result.realtime_priority = config.realtime_priority != 0;
    return result;
}

knead_error load(const char* asset_path, const knead_haptic_config& config, const knead_device& device,
                 knead_haptic_loop** out) {
    const knead::HapticConfig haptic = to_cpp(config);
    knead::SimulationConfig base;
    base.tools = {config.tool};
    auto simulation =
        knead::Simulation::load(std::filesystem::u8path(asset_path), simulation_config(haptic, base));
    if (!simulation) return fail_load(simulation.error());
    auto handle = std::make_unique<knead_haptic_loop>(device, std::move(simulation).value());
    auto loop = knead::HapticLoop::create(handle->device, handle->simulation, haptic);
    if (!loop) return fail_load(loop.error());
    handle->loop.emplace(std::move(loop).value());
    handle->two_rate = haptic.mode == knead::HapticMode::two_rate;
    *out = handle.release();
    load_error[0] = '\0';
    return KNEAD_OK;
}

static_assert(KNEAD_HAPTIC_SATURATED == int{knead::kHapticSaturated});
static_assert(KNEAD_HAPTIC_NOT_FINITE == int{knead::kHapticNotFinite});
static_assert(KNEAD_HAPTIC_PASSIVITY == int{knead::kHapticPassivity});
static_assert(KNEAD_HAPTIC_SLEW_LIMITED == int{knead::kHapticSlewLimited});
static_assert(KNEAD_HAPTIC_RAMPING == int{knead::kHapticRamping});
static_assert(KNEAD_HAPTIC_STALE_MODEL == int{knead::kHapticStaleModel});
static_assert(KNEAD_HAPTIC_STALE_DEVICE == int{knead::kHapticStaleDevice});
static_assert(KNEAD_HAPTIC_BAD_POSE == int{knead::kHapticBadPose});
static_assert(KNEAD_HAPTIC_POSE_JUMP == int{knead::kHapticPoseJump});
static_assert(KNEAD_HAPTIC_TIME_JUMP == int{knead::kHapticTimeJump});
static_assert(KNEAD_HAPTIC_STEP_FAILED == int{knead::kHapticStepFailed});
static_assert(KNEAD_HAPTIC_TWO_RATE == static_cast<int>(knead::HapticMode::two_rate));
static_assert(KNEAD_RENDER_LINEAR == static_cast<int>(knead::LocalRendering::linear));
static_assert(KNEAD_RENDER_HOLD == static_cast<int>(knead::LocalRendering::hold));

}  // namespace

void knead_haptic_config_init(knead_haptic_config* config) noexcept {
    if (config == nullptr) return;
    const knead::HapticConfig defaults;
    *config = knead_haptic_config{};
    config->struct_size = sizeof(knead_haptic_config);
    config->workspace_scale = defaults.workspace.scale;
    std::copy_n(defaults.workspace.rotation_wxyz.begin(), 4, config->workspace_rotation_wxyz);
    std::copy_n(defaults.workspace.offset_m.begin(), 3, config->workspace_offset_m);
    config->force_scale = defaults.force_scale;
    config->rate_hz = defaults.rate_hz;
    config->simulation_rate_hz = defaults.simulation_rate_hz;
    config->mode = static_cast<std::int32_t>(defaults.mode);
    config->rendering = static_cast<std::int32_t>(defaults.rendering);
    config->coupling_stiffness_n_per_m = defaults.coupling.stiffness_n_per_m;
    config->coupling_damping_n_s_per_m = defaults.coupling.damping_n_s_per_m;
    config->coupling_rotation_stiffness_nm_per_rad = defaults.coupling.rotation_stiffness_nm_per_rad;
    config->coupling_rotation_damping_nm_s_per_rad = defaults.coupling.rotation_damping_nm_s_per_rad;
    config->max_force_n = defaults.safety.max_force_n;
    config->max_torque_nm = defaults.safety.max_torque_nm;
    config->slew_n_per_ms = defaults.safety.slew_n_per_ms;
    config->ramp_n_per_s = defaults.safety.ramp_n_per_s;
    config->passivity_control = defaults.safety.passivity ? 1 : 0;
    config->realtime_priority = defaults.realtime_priority ? 1 : 0;
}

void knead_haptic_tick_init(knead_haptic_tick* tick) noexcept {
    if (tick == nullptr) return;
    *tick = knead_haptic_tick{};
    tick->struct_size = sizeof(knead_haptic_tick);
}

void knead_run_statistics_init(knead_run_statistics* statistics) noexcept {
    if (statistics == nullptr) return;
    *statistics = knead_run_statistics{};
    statistics->struct_size = sizeof(knead_run_statistics);
}

knead_error knead_haptic_loop_load(const char* asset_path, const knead_haptic_config* config,
                                   const knead_device* device, knead_haptic_loop** out) noexcept {
    if (out == nullptr) return fail_load(KNEAD_ERROR_INVALID_ARGUMENT, "knead_haptic_loop_load: out is NULL");
    *out = nullptr;
    if (asset_path == nullptr)
        return fail_load(KNEAD_ERROR_INVALID_ARGUMENT, "knead_haptic_loop_load: asset_path is NULL");
    if (device == nullptr || device->read == nullptr || device->write == nullptr) {
        return fail_load(KNEAD_ERROR_INVALID_ARGUMENT,
                         "knead_haptic_loop_load: device, its read or its write is NULL");
    }
    knead_haptic_config used;
    knead_haptic_config_init(&used);
    if (config != nullptr) {
        if (const char* problem = problem_of(*config); problem != nullptr)
            return fail_load(KNEAD_ERROR_INVALID_ARGUMENT, problem);
        std::memcpy(&used, config, std::min(config->struct_size, sizeof(used)));
    }
    try {
        return load(asset_path, used, *device, out);
    } catch (const std::bad_alloc&) {
        return fail_load(KNEAD_ERROR_OUT_OF_MEMORY, "knead_haptic_loop_load: out of memory");
    } catch (const std::exception& exception) {
        return fail_load(KNEAD_ERROR_IO, exception.what());
    } catch (...) {
        return fail_load(KNEAD_ERROR_IO, "knead_haptic_loop_load: unknown failure");
    }
}

void knead_haptic_loop_free(knead_haptic_loop* loop) noexcept {
    delete loop;
}

knead_error knead_haptic_loop_rest_pose(const knead_haptic_loop* loop, knead_pose* pose) noexcept {
    if (loop == nullptr || pose == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    *pose = to_c(loop->simulation.tool_rest_pose());
    return KNEAD_OK;
}

knead_error knead_haptic_loop_start(knead_haptic_loop* loop) noexcept {
    if (loop == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    try {
        const knead::Status status = loop->loop->start();
        if (status) return KNEAD_OK;
        return fail(*loop, static_cast<knead_error>(status.error().code), status.error().text().c_str());
    } catch (const std::exception&) {
        return fail(*loop, KNEAD_ERROR_OUT_OF_MEMORY, "knead_haptic_loop_start: out of memory");
    }
}

knead_error knead_haptic_loop_stop(knead_haptic_loop* loop) noexcept {
    if (loop == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    loop->loop->stop();
    return KNEAD_OK;
}

knead_error knead_haptic_loop_tick(knead_haptic_loop* loop, double dt_s, knead_haptic_tick* tick) noexcept {
    if (loop == nullptr) return KNEAD_ERROR_INVALID_ARGUMENT;
    if (tick != nullptr && tick->struct_size < kFirstTickBytes)
        return fail(*loop,
                    "knead_haptic_loop_tick: tick->struct_size is not set; call knead_haptic_tick_init()");
    if (loop->two_rate) return fail(*loop, "knead_haptic_loop_tick: a two-rate loop needs start");
    if (loop->loop->running()) return fail(*loop, "knead_haptic_loop_tick: the loop runs on its own");
    const knead::HapticTick done = loop->loop->tick(dt_s);
    if (tick == nullptr) return KNEAD_OK;
    knead_haptic_tick result{};
    result.number = done.number;
    result.dt_s = done.dt_s;
    result.device = to_c(done.device);
    result.hand = to_c(done.hand);
    result.tool = to_c(done.tool);
    std::copy_n(done.device_force_n.begin(), 3, result.device_force_n);
    std::copy_n(done.device_torque_nm.begin(), 3, result.device_torque_nm);
    result.haptic_status = done.status;
    result.step_status = done.step.status;
    result.touched_nodes = done.step.touched_nodes;
    give(result, tick->struct_size, tick);
    return KNEAD_OK;
}

knead_error knead_haptic_loop_statistics(const knead_haptic_loop* loop,
                                         knead_run_statistics* statistics) noexcept {
    if (loop == nullptr || statistics == nullptr || statistics->struct_size < kFirstStatisticsBytes)
        return KNEAD_ERROR_INVALID_ARGUMENT;
    const knead::RunStatistics run = loop->loop->statistics();
    knead_run_statistics result{};
    result.ticks = run.ticks;
    result.seconds = run.seconds;
    result.rate_hz = run.rate_hz;
    result.jitter_s = run.jitter_s;
    result.tick_p50_s = run.tick.p50_s;
    result.tick_p99_s = run.tick.p99_s;
    result.tick_p999_s = run.tick.p999_s;
    result.tick_max_s = run.tick.max_s;
    result.misses = run.misses;
    result.misses_preempted = run.misses_preempted;
    result.haptic_status = run.haptic_status;
    result.step_status = run.step_status;
    result.realtime_priority = run.realtime_priority ? 1 : 0;
    give(result, statistics->struct_size, statistics);
    return KNEAD_OK;
}

const char* knead_haptic_last_error(const knead_haptic_loop* loop) noexcept {
    return loop == nullptr ? load_error : loop->last_error;
}
