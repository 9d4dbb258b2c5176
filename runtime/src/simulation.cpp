// SPDX-License-Identifier: Apache-2.0
#include "knead/runtime/simulation.h"

#include <new>
#include <utility>
#include <vector>

#include "core/step.h"
#include "load/check_config.h"
#include "load/check_numbers.h"

namespace knead {

/// The core, and what of the asset its caller may ask for.
struct Simulation::Impl {
    Impl(const Asset& asset, const SimulationConfig& config)
        : stepper(core::make_stepper(asset, config)),
          tetrahedra(asset.tetrahedra.size()),
          positions_m(3 * stepper->node_count()) {
        for (const std::size_t k : config.tools)
            rest_poses.push_back({asset.tools[k].rest_position_m, asset.tools[k].rest_orientation_wxyz});
    }

    std::unique_ptr<core::Stepper> stepper;
    std::vector<Pose> rest_poses;
    std::size_t tetrahedra;
    std::vector<double> positions_m;  ///< as last asked for
};

Simulation::Simulation(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Result<Simulation> Simulation::create(const Asset& asset, const SimulationConfig& config) {
    try {
        if (Status status = validate(asset); !status) return status.error();
        if (Status status = check_numbers(asset); !status) return status.error();
        if (Status status = check_config(config, asset); !status) return status.error();
        return Simulation(std::make_unique<Impl>(asset, config));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "the simulation does not fit into memory", asset.name};
    }
}

StepResult Simulation::step(const Pose& pose, double dt_s) noexcept {
    if (tool_count() != 1) {
        StepResult refused;
        refused.status = kStepBadInput;
        return refused;
    }
    return impl_->stepper->step(&pose, dt_s);
}

StepResult Simulation::step(const Pose* poses, double dt_s) noexcept {
    return impl_->stepper->step(poses, dt_s);
}

const ToolResult& Simulation::tool(std::size_t index) const noexcept {
    return impl_->stepper->tool(index);
}

bool Simulation::local_model(std::size_t tool, LocalModel& out) noexcept {
    return impl_->stepper->local_model(tool, out);
}

void Simulation::reset() noexcept {
    impl_->stepper->reset();
}

std::size_t Simulation::tool_count() const noexcept {
    return impl_->stepper->tool_count();
}

std::size_t Simulation::node_count() const noexcept {
    return impl_->stepper->node_count();
}

std::size_t Simulation::tetrahedron_count() const noexcept {
    return impl_->tetrahedra;
}

const double* Simulation::positions_m() const noexcept {
    impl_->stepper->positions_m(impl_->positions_m.data());
    return impl_->positions_m.data();
}

void Simulation::velocities_m_per_s(double* out) const noexcept {
    impl_->stepper->velocities_m_per_s(out);
}

Pose Simulation::tool_rest_pose(std::size_t index) const noexcept {
    return impl_->rest_poses[index];
}

std::size_t Simulation::preconditioner_bytes() const noexcept {
    return impl_->stepper->factor_bytes();
}

}  // namespace knead
