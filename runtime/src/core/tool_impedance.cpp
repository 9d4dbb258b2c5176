// SPDX-License-Identifier: Apache-2.0
#include "core/tool_impedance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knead::core {
namespace {

/// Of an object that nothing supports: what it does within this time is all that a tool feels of it.
constexpr Real kUnsupported_s = 50e-3;
/// Time scale at which mass and damping are fitted: the middle of what passes between two steps at 120 Hz.
/// Of 2 to 8 ms it reproduces the object best over 8 and 16 ms (docs/simulation.md).
constexpr Real kFitted_s = 4e-3;
/// Nodes that must be out of the object's own reach to support it: fewer leave it to turn about them.
constexpr std::size_t kSupports = 3;
/// Relative error of a stiffness, as far as the last iterations tell.
constexpr Real kTolerance = 1e-3;
/// Iterations that are looked back on where the preconditioner says nothing.
constexpr std::size_t kLookBack = 3;
/// Iterations of a call for each of its shapes: on average, and what each gets at least. What is left to do
/// is done in the next call.
constexpr std::uint32_t kMeanIterations = 10;
constexpr std::uint32_t kFewestIterations = 6;

/// One of the tool's directions as a motion of a point.
Vec motion_of(const Vec& arm_m, std::size_t direction) {
    const Vec axis = Vec::Unit(static_cast<int>(direction % 3));
    return direction < 3 ? axis : Vec(axis.cross(arm_m));
}

bool supported(const Model& model) {
    std::size_t supports = model.rest_m.size() - model.moving_count;
    for (const Model::Range& bonded : model.bonded)
        supports += bonded.end - bonded.begin;
    return supports >= kSupports;
}

}  // namespace

template <class S>
ToolImpedance<S>::ToolImpedance(const Model& model, std::size_t tools, std::size_t directions)
    : directions_(directions), still_(tools), at_rest_(tools), fitted_(tools), product_(model.rest_m.size()) {
    for (Unknowns<S>* u : {&residual_, &direction_, &preconditioned_})
        *u = {NodeField<S>(model.rest_m.size()), std::vector<Vec>(tools, Vec::Zero())};
    for (std::vector<std::vector<Shape>>* all : {&at_rest_, &fitted_}) {
        for (std::size_t k = 0; k < tools * directions; ++k) {
            (*all)[k / directions].push_back(
                {{NodeField<S>(model.rest_m.size()), std::vector<Vec>(tools, Vec::Zero())},
                 NodeField<S>(model.rest_m.size())});
        }
    }
}

template <class S>
void ToolImpedance<S>::reset() noexcept {
    for (std::vector<std::vector<Shape>>* all : {&at_rest_, &fitted_}) {
        for (std::vector<Shape>& shapes : *all) {
            for (Shape& shape : shapes)
                shape.motion.nodes.fill_zero();
        }
    }
}

/// Everything that tools hold goes where `tool` takes it in a direction, or stays.
template <class S>
void ToolImpedance<S>::follow(const System<S>& system, std::uint32_t tool, const std::vector<HeldPart>& held,
                              std::size_t direction, Unknowns<S>& motion) const noexcept {
    for (const Constraint& c : system.constraints) {
        if (c.tool == tool) continue;
        const Vec u = motion.nodes.get(c.node);
        motion.nodes.set(c.node, u - c.held * u);
    }
    for (const HeldPart& part : held) {
        const Vec u = motion.nodes.get(part.node);
        motion.nodes.set(part.node, u + part.held * (motion_of(part.arm_m, direction) - u));
    }
}

template <class S>
void ToolImpedance<S>::free_part(const System<S>& system, NodeField<S>& rows) const noexcept {
    for (const Constraint& c : system.constraints) {
        const Vec row = rows.get(c.node);
        rows.set(c.node, row - c.held * row);
    }
}

/// Condition number of a preconditioned system if the preconditioner is the inverse of M + dt^2 K: its
/// eigenvalues are between 1 and (inertia + dt^2 w^2) / (1 + dt^2 w^2), w the lowest frequency. For that, the
/// frequency that the shape would have on its own.
template <class S>
Real ToolImpedance<S>::condition(const System<S>& system, const Shape& shape, Real energy) noexcept {
    const std::size_t free = run_of(system.model.free_count);
    const Real mass = static_cast<Real>(
        system.fields.weighted_square(free, system.masses.kg.data(), shape.motion.nodes.data()));
    const Real stiffness = std::max<Real>(0, energy / mass - system.inertia);  // dt^2 w^2
    const Real least = (system.inertia + stiffness) / (1 + stiffness);
    return std::max(least, 1 / least);
}

template <class S>
bool ToolImpedance<S>::solve(const System<S>& system, const Preconditioner<S>& preconditioner, Shape& shape,
                             std::uint32_t most, std::uint32_t& iterations) noexcept {
    const FieldKernels<S>& fields = system.fields;
    const std::size_t moving = run_of(system.model.moving_count), free = run_of(system.model.free_count);
    const auto dot = [&](const NodeField<S>& a, const NodeField<S>& b) {
        return static_cast<Real>(fields.dot(free, a.data(), b.data()));
    };
    const auto precondition = [&] {
        preconditioner.apply(system, residual_, preconditioned_);
        free_part(system, preconditioned_.nodes);
        return dot(residual_.nodes, preconditioned_.nodes);
    };
    NodeField<S>& y = shape.motion.nodes;
    system.apply(shape.motion, shape.rows);
    Real energy = static_cast<Real>(fields.dot(moving, y.data(), shape.rows.data()));
    residual_.nodes.copy(shape.rows);
    fields.scale(moving, S(-1), residual_.nodes.data());
    free_part(system, residual_.nodes);
    Real rz = precondition();
    std::swap(direction_, preconditioned_);
    std::array<Real, kLookBack> decreases{};
    const bool close = preconditioner.is_close(system.dt_s);
    for (std::uint32_t k = 0; k < most; ++k) {
        if (rz == 0) return true;
        if (!(rz > 0)) return false;
        system.apply(direction_, product_);
        const Real curvature = dot(direction_.nodes, product_);
        if (!(curvature > 0)) return false;
        const Real alpha = rz / curvature;
        ++iterations;
        fields.add_scaled(moving, y.data(), static_cast<S>(alpha), direction_.nodes.data(), y.data());
        fields.add_scaled(moving, shape.rows.data(), static_cast<S>(alpha), product_.data(),
                          shape.rows.data());
        free_part(system, product_);
        fields.add_scaled(moving, residual_.nodes.data(), static_cast<S>(-alpha), product_.data(),
                          residual_.nodes.data());
        energy -= alpha * rz;
        decreases[k % kLookBack] = alpha * rz;
        const Real lately = std::accumulate(decreases.begin(), decreases.end(), Real(0));
        if (k + 1 >= kLookBack && lately <= kTolerance * energy) return true;
        if (close && condition(system, shape, energy) * alpha * rz <= kTolerance * energy) return true;
        const Real next = precondition();
        fields.add_scaled(free, preconditioned_.nodes.data(), static_cast<S>(next / rz),
                          direction_.nodes.data(), direction_.nodes.data());
        rz = next;
    }
    return false;
}

/// Products of the shapes with each other.
template <class S>
void ToolImpedance<S>::measure(const System<S>& system, std::uint32_t tool, const std::vector<Shape>& shapes,
                               Energies& out) noexcept {
    const FieldKernels<S>& fields = system.fields;
    const std::size_t moving = run_of(system.model.moving_count);
    const Real dt2 = system.dt_s * system.dt_s;
    const Model::Range bonded = system.model.bonded[tool];
    for (std::size_t j = 0; j < directions_; ++j) {
        const NodeField<S>& yj = shapes[j].motion.nodes;
        fields.multiply(moving, system.masses.kg.data(), S(1), yj.data(), product_.data());
        for (std::size_t i = 0; i <= j; ++i) {
            const NodeField<S>& yi = shapes[i].motion.nodes;
            Real mass = static_cast<Real>(fields.dot(moving, yi.data(), product_.data()));
            const Real rows = static_cast<Real>(fields.dot(moving, yi.data(), shapes[j].rows.data()));
            out.elastic[i][j] = out.elastic[j][i] = (rows - system.inertia * mass) / dt2;
            for (std::uint32_t n = bonded.begin; n < bonded.end; ++n)
                mass += system.model.mass_kg[n] * yi.get(n).dot(yj.get(n));
            out.mass[i][j] = out.mass[j][i] = mass;
        }
    }
}

template <class S>
void ToolImpedance<S>::find_shapes(const System<S>& system, const Preconditioner<S>& preconditioner,
                                   std::uint32_t tool, const std::vector<HeldPart>& held,
                                   std::vector<Shape>& shapes, Energies& energies, Impedance& out) noexcept {
    for (std::size_t k = 0; k < directions_; ++k) {
        follow(system, tool, held, k, shapes[k].motion);
        --shapes_left_;
        const auto kept = static_cast<std::uint32_t>(kFewestIterations * shapes_left_);
        const std::uint32_t before = out.iterations;
        if (!solve(system, preconditioner, shapes[k], iterations_left_ - kept, out.iterations))
            out.converged = false;
        iterations_left_ -= out.iterations - before;
    }
    measure(system, tool, shapes, energies);
}

template <class S>
void ToolImpedance<S>::find(const System<S>& step, const Preconditioner<S>& preconditioner,
                            std::uint32_t tool, std::vector<HeldPart>& held, Impedance& out) noexcept {
    out = {};
    if (held.empty()) return;
    const auto at = [&](Real inertia) {
        return System<S>{step.model,       step.stiffness, step.masses, step.fields,
                         step.constraints, still_,        step.dt_s,   step.dt_s * step.dt_s * inertia};
    };
    const Real damping = step.model.damping_per_s;
    Energies at_rest, fitted;
    shapes_left_ = 2 * directions_;
    iterations_left_ = static_cast<std::uint32_t>(kMeanIterations * shapes_left_);
    find_shapes(at(supported(step.model) ? 0 : 1 / (kUnsupported_s * kUnsupported_s)), preconditioner, tool,
                held, at_rest_[tool], at_rest, out);
    find_shapes(at((1 / kFitted_s + damping) / kFitted_s), preconditioner, tool, held, fitted_[tool], fitted,
                out);
    fit(at_rest.elastic, fitted, kFitted_s, damping, out);
    const Real per_dt2 = 1 / (step.dt_s * step.dt_s);
    for (HeldPart& part : held) {
        for (int axis = 0; axis < 3; ++axis) {
            const Shape& shape = at_rest_[tool][static_cast<std::size_t>(axis)];
            part.rate.col(axis) = per_dt2 * (part.held * shape.rows.get(part.node));
        }
    }
}

template class ToolImpedance<float>;
template class ToolImpedance<double>;

}  // namespace knead::core
