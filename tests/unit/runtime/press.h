// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>

#include "core/simd/kernels.h"
#include "core/step.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {

/// A core::Stepper with its state at hand. Asset node order.
class Stepper {
  public:
    Stepper(const Asset& asset, const SimulationConfig& config)
        : stepper_(core::make_stepper(asset, config)), rest_(to_field(asset.nodes_m)) {
        for (std::size_t i = 0; i < rest_.size(); ++i)
            mass_kg_.push_back(0);
        for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
            const Tetrahedron& n = asset.tetrahedra[t];
            const core::Vec a = rest_[n[1]] - rest_[n[0]], b = rest_[n[2]] - rest_[n[0]],
                            c = rest_[n[3]] - rest_[n[0]];
            const double mass =
                a.cross(b).dot(c) / 6 * asset.palette[asset.palette_index[t]].density_kg_per_m3;
            for (const std::uint32_t node : n)
                mass_kg_[node] += mass / 4;
        }
    }

    StepResult step(const Pose& pose, double dt_s) { return stepper_->step(&pose, dt_s); }
    StepResult step(const std::vector<Pose>& poses, double dt_s) {
        return stepper_->step(poses.data(), dt_s);
    }
    [[nodiscard]] const ToolResult& tool(std::size_t index) const { return stepper_->tool(index); }
    void reset() { stepper_->reset(); }

    [[nodiscard]] core::Field positions_m() const {
        core::Field result(rest_.size());
        stepper_->positions_m(result.front().data());
        return result;
    }
    [[nodiscard]] core::Field velocities_m_per_s() const {
        core::Field result(rest_.size());
        stepper_->velocities_m_per_s(result.front().data());
        return result;
    }
    [[nodiscard]] const core::Field& rest_m() const { return rest_; }
    [[nodiscard]] const std::vector<double>& mass_kg() const { return mass_kg_; }

  private:
    static core::Field to_field(const std::vector<Point>& points) {
        core::Field result;
        for (const Point& p : points)
            result.emplace_back(p[0], p[1], p[2]);
        return result;
    }

    std::unique_ptr<core::Stepper> stepper_;
    core::Field rest_;
    std::vector<double> mass_kg_;
};

/// The tool's pose when it has moved from its rest pose by `move_m`.
inline Pose moved(const Asset& asset, const Vec3& move_m, std::size_t tool = 0) {
    Pose pose{asset.tools[tool].rest_position_m, asset.tools[tool].rest_orientation_wxyz};
    for (std::size_t axis = 0; axis < 3; ++axis)
        pose.position_m[axis] += move_m[axis];
    return pose;
}

/// Moves the tool to `move_m` in `ramp` steps of 20 ms and holds it for `hold`: to equilibrium.
inline StepResult settle(Stepper& stepper, const Asset& asset, const Vec3& move_m, int ramp = 50,
                         int hold = 250) {
    StepResult result;
    std::uint32_t status = 0;
    for (int i = 1; i <= ramp + hold; ++i) {
        const double share = std::min(1.0, static_cast<double>(i) / ramp);
        result = stepper.step(moved(asset, {share * move_m[0], share * move_m[1], share * move_m[2]}), 20e-3);
        status |= result.status;
    }
    result.status = status;
    return result;
}

/// Tight enough that a force is good to more digits than any check here asks.
inline SimulationConfig precise() {
    SimulationConfig config;
    config.arithmetic = Arithmetic::float64;
    config.force_tolerance = 1e-9;
    config.max_solver_iterations = 5000;
    return config;
}

/// Motion of the nodes that are `in`, by where they rest: of one body that flies free.
struct Flight {
    core::Vec momentum = core::Vec::Zero();  ///< kg m/s
    core::Vec spin = core::Vec::Zero();      ///< about their centre of mass, kg m^2/s
};
inline Flight flight_of(const Stepper& stepper, const std::function<bool(const core::Vec& rest_m)>& in) {
    const core::Field x = stepper.positions_m(), v = stepper.velocities_m_per_s();
    core::Vec middle = core::Vec::Zero();
    double mass = 0;
    Flight flight;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!in(stepper.rest_m()[i])) continue;
        const double m = stepper.mass_kg()[i];
        middle += m * x[i];
        mass += m;
        flight.momentum += m * v[i];
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!in(stepper.rest_m()[i])) continue;
        flight.spin += stepper.mass_kg()[i] * (x[i] - middle / mass).cross(v[i]);
    }
    return flight;
}
inline Flight flight_of(const Stepper& stepper) {
    return flight_of(stepper, [](const core::Vec&) { return true; });
}

/// What implicit Euler, solved to the end, makes of the spin of what flies free: dt sum m v1 x v0 in a step.
inline core::Vec spin_of_implicit_euler(const Stepper& stepper, const core::Field& v0, double dt_s) {
    const core::Field v1 = stepper.velocities_m_per_s();
    core::Vec sum = core::Vec::Zero();
    for (std::size_t i = 0; i < v0.size(); ++i)
        sum += (dt_s * stepper.mass_kg()[i]) * v1[i].cross(v0[i]);
    return sum;
}

}  // namespace knead::test
