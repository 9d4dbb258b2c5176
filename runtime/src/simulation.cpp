// SPDX-License-Identifier: Apache-2.0
#include "knead/runtime/simulation.h"

#include <new>
#include <type_traits>
#include <utility>

#include "core/step.h"
#include "load/check_config.h"

namespace knead {

/// The core, and what of the asset its caller may ask for.
struct Simulation::Impl {
    Impl(const Asset& asset, const SimulationConfig& config)
        : stepper(asset, config),
          rest_pose{asset.tools[config.tool].rest_position_m,
                    asset.tools[config.tool].rest_orientation_wxyz} {}

    core::Stepper stepper;
    Pose rest_pose;
};

Simulation::Simulation(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Result<Simulation> Simulation::create(const Asset& asset, const SimulationConfig& config) {
    if (Status status = validate(asset); !status) return status.error();
    if (Status status = check_config(config, asset); !status) return status.error();
    try {
        return Simulation(std::make_unique<Impl>(asset, config));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "the simulation does not fit into memory", asset.name};
    }
}

StepResult Simulation::step(const Pose& pose, double dt_s) noexcept {
    return impl_->stepper.step(pose, dt_s);
}

void Simulation::reset() noexcept {
    impl_->stepper.reset();
}

std::size_t Simulation::node_count() const noexcept {
    return impl_->stepper.model().rest_m.size();
}

std::size_t Simulation::tetrahedron_count() const noexcept {
    return impl_->stepper.model().elements.size();
}

const double* Simulation::positions_m() const noexcept {
    static_assert(std::is_same_v<core::Real, double> && sizeof(core::Vec) == 3 * sizeof(double),
                  "positions are handed out as they are stored");
    return impl_->stepper.positions_m().front().data();
}

Pose Simulation::tool_rest_pose() const noexcept {
    return impl_->rest_pose;
}

}  // namespace knead
