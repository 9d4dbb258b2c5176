// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/haptic_loop.h"

#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include "haptics/loop_impl.h"
#include "haptics/quaternion.h"

namespace knead {
namespace {

constexpr double kSlowest_hz = 500;
constexpr double kSlowestSimulation_hz = 50;  ///< Simulation::step() takes at most 20 ms
constexpr double kFastest_hz = 4000;
constexpr double kLongestRun_s = 1e7;

Error bad(const std::string& what) {
    return Error{ErrorCode::invalid_argument, what, "HapticLoop"};
}

/// What is wrong, or an empty text.
std::string fault(const WorkspaceMap& map) {
    if (!(map.scale > 0 && std::isfinite(map.scale))) return "workspace.scale must be finite and above 0";
    if (!is_unit(map.rotation_wxyz)) return "workspace.rotation_wxyz must be a unit quaternion";
    for (const double offset : map.offset_m)
        if (!std::isfinite(offset)) return "workspace.offset_m must be finite";
    return {};
}

std::string fault(const CouplingConfig& coupling) {
    const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
    const auto not_negative = [](double x) { return x >= 0 && std::isfinite(x); };
    if (!positive(coupling.stiffness_n_per_m)) return "coupling.stiffness_n_per_m must be finite and above 0";
    if (!not_negative(coupling.damping_n_s_per_m))
        return "coupling.damping_n_s_per_m must be finite and not negative";
    if (!positive(coupling.tool_mass_kg)) return "coupling.tool_mass_kg must be finite and above 0";
    if (!not_negative(coupling.rotation_stiffness_nm_per_rad))
        return "coupling.rotation_stiffness_nm_per_rad must be finite and not negative";
    if (!not_negative(coupling.rotation_damping_nm_s_per_rad))
        return "coupling.rotation_damping_nm_s_per_rad must be finite and not negative";
    if (!positive(coupling.tool_inertia_kg_m2))
        return "coupling.tool_inertia_kg_m2 must be finite and above 0";
    return {};
}

std::string fault(const HapticConfig& config) {
    if (std::string what = fault(config.workspace); !what.empty()) return what;
    if (!(config.force_scale >= 0 && std::isfinite(config.force_scale)))
        return "force_scale must be finite and not negative";
    if (!(config.rate_hz >= kSlowest_hz && config.rate_hz <= kFastest_hz))
        return "rate_hz must be 500 to 4000";
    if (config.mode != HapticMode::synchronous && config.mode != HapticMode::two_rate)
        return "mode is none of HapticMode";
    if (config.rendering > LocalRendering::hold) return "rendering is none of LocalRendering";
    if (!(config.simulation_rate_hz >= kSlowestSimulation_hz && config.simulation_rate_hz <= kFastest_hz))
        return "simulation_rate_hz must be 50 to 4000";
    if (!(config.correction_gain > 0 && config.correction_gain <= 1))
        return "correction_gain must be above 0 and at most 1";
    return fault(config.coupling);
}

}  // namespace

SimulationConfig simulation_config(const HapticConfig& config, SimulationConfig base) {
    const bool synchronous = config.mode == HapticMode::synchronous;
    const bool turns = config.coupling.rotation_stiffness_nm_per_rad > 0;
    base.expected_dt_s = 1 / (synchronous ? config.rate_hz : config.simulation_rate_hz);
    base.coupling_stiffness_n_per_m = config.coupling.stiffness_n_per_m;
    base.coupling_damping_n_s_per_m = config.coupling.damping_n_s_per_m;
    base.tool_mass_kg = config.coupling.tool_mass_kg;
    base.with_torque = base.with_torque || turns;
    base.with_local_model = base.with_local_model || turns || !synchronous;
    return base;
}

Result<HapticLoop> HapticLoop::create(Device& device, Simulation& simulation, const HapticConfig& config) {
    if (simulation.tool_count() != 1)
        return bad("the simulation must have one tool, has " + std::to_string(simulation.tool_count()));
    if (const std::string what = fault(config); !what.empty()) return bad(what);
    Result<SafetyChain> safety = SafetyChain::create(config.safety);
    if (!safety) return safety.error();
    auto* impl = new (std::nothrow) Impl(device, simulation, config, safety.value());
    if (impl == nullptr) return Error{ErrorCode::out_of_memory, "no memory for the loop", "HapticLoop"};
    return HapticLoop(std::unique_ptr<Impl>(impl));
}

HapticLoop::HapticLoop(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
HapticLoop::HapticLoop(HapticLoop&&) noexcept = default;
HapticLoop& HapticLoop::operator=(HapticLoop&&) noexcept = default;
HapticLoop::~HapticLoop() = default;

HapticTick HapticLoop::tick(double dt_s) noexcept {
    return impl_->haptic.tick(dt_s);
}

SimulationResult HapticLoop::simulate(double dt_s) noexcept {
    return impl_->simulation_side.simulate(dt_s);
}

void HapticLoop::publish(const SimulationResult& result) noexcept {
    impl_->exchange.results.write(result);
}

Result<RunStatistics> HapticLoop::run(double seconds, const std::function<void(const HapticTick&)>& observe,
                                      const std::function<void(const SimulationResult&)>& observe_result) {
    if (!(seconds >= 0 && seconds <= kLongestRun_s)) return bad("seconds must be 0 to 1e7");
    if (impl_->running.exchange(true)) return bad("the loop runs already");
    impl_->stop_ticks = false;
    if (!impl_->start_helpers(observe_result)) {
        impl_->running = false;
        return Error{ErrorCode::out_of_memory, "the system gives no thread", "HapticLoop"};
    }
    struct End {  // also when the observer throws
        Impl& impl;
        ~End() {
            impl.stop_helpers();
            impl.running = false;
        }
    };
    {
        const End end{*impl_};
        impl_->run_ticks(static_cast<std::uint64_t>(std::llround(seconds * impl_->config.rate_hz)), observe);
    }
    return statistics();
}

Status HapticLoop::start(std::function<void(const HapticTick&)> observe,
                         std::function<void(const SimulationResult&)> observe_result) {
    if (impl_->running.exchange(true)) return bad("the loop runs already");
    impl_->stop();  // the thread of a run that ended by itself
    impl_->stop_ticks = false;
    const auto no_thread = [&]() -> Status {
        impl_->running = false;
        return Error{ErrorCode::out_of_memory, "the system gives no thread", "HapticLoop"};
    };
    if (!impl_->start_helpers(std::move(observe_result))) return no_thread();
    try {
        impl_->haptic_thread = std::thread([impl = impl_.get(), seen = std::move(observe)] {
            impl->run_ticks(std::numeric_limits<std::uint64_t>::max(), seen);
            impl->stop_helpers();
            impl->running = false;
        });
    } catch (const std::exception&) {
        impl_->stop_helpers();
        return no_thread();
    }
    return Unit{};
}

void HapticLoop::stop() noexcept {
    if (!impl_) return;
    impl_->stop();
    // A run() on another thread lets go by itself.
    if (!impl_->running) impl_->haptic.let_go();
}

bool HapticLoop::running() const noexcept {
    return impl_ && impl_->running;
}

RunStatistics HapticLoop::statistics() const noexcept {
    return impl_->recorder.statistics();
}

}  // namespace knead
