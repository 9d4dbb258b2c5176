// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "core/contact.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {

using core::Frame;
using core::Vec;

/// A small linear-elastic body in implicit Euler steps, solved densely and exactly: the body under the tools
/// when contact is tested without the solver, and the source of the oracles' matrices.
class DenseBody {
  public:
    DenseBody(const Asset& asset, double dt_s, core::BondedNodes bonded = core::BondedNodes::listed)
        : model(core::build_model(asset, {})),
          contact(asset.tools, model, bonded),
          positions(model.rest_m),
          velocities(model.rest_m.size(), Vec::Zero()),
          dt(dt_s),
          dofs_(3 * model.free_count) {
        assemble();
        for (std::size_t t = 0; t < asset.tools.size(); ++t)
            rest_frames.push_back(contact.rest_frame(t));
    }

    struct Report {
        core::Contact::Revision revision = core::Contact::Revision::changed;
        int passes = 0;
    };

    /// One step with the tools at `frames`. @param tolerance relative, as the solver's force tolerance
    Report step(const std::vector<Frame>& frames, double tolerance = 1e-9, int most_passes = 100) {
        core::Field predicted = positions;
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            predicted[i] += dt * velocities[i];
        load_ = -dt * dt * stiffness_ * displacement(predicted);
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            load_.segment<3>(3 * i) += dt * dt * model.mass_kg[i] * gravity;
        contact.begin_step(frames, core::NodeReader(predicted), dt);
        const std::vector<Vec> still(frames.size(), Vec::Zero());
        core::Field solved;
        Report report;
        double travel = 0;
        while (report.revision == core::Contact::Revision::changed && report.passes < most_passes) {
            ++report.passes;
            constraints = contact.constraints();
            const Eigen::VectorXd d = solve();
            solved = predicted;
            travel = 0;
            for (std::uint32_t i = 0; i < model.free_count; ++i) {
                solved[i] += d.segment<3>(3 * i);
                travel = std::max(travel, (solved[i] - positions[i]).norm());
            }
            double total = 0;
            for (const Vec& row : rows_n)
                total += row.norm();
            const core::NodeReader before(predicted), now(solved);
            if (glance_error > 0 && glance(before, predicted, solved, still)) {
                ++glances;
                --report.passes;
                continue;
            }
            pull_tolerance_n = tolerance * total / std::max<double>(1, static_cast<double>(rows_n.size()));
            report.revision = contact.revise(
                {before, now, still, rows_n, travel_factor * travel, pull_tolerance_n, 10 * tolerance});
        }
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            velocities[i] = (solved[i] - positions[i]) / dt;
        positions = solved;
        contact.end_step(frames, core::NodeReader(positions), travel_factor * travel);
        return report;
    }

    /// The same, but the state stays as it is.
    void try_and_abandon(const std::vector<Frame>& frames) {
        core::Field predicted = positions;
        load_ = -dt * dt * stiffness_ * displacement(predicted);
        contact.begin_step(frames, core::NodeReader(predicted), dt);
        const std::vector<Vec> still(frames.size(), Vec::Zero());
        for (int pass = 0; pass < 4; ++pass) {
            constraints = contact.constraints();
            const Eigen::VectorXd d = solve();
            core::Field solved = predicted;
            for (std::uint32_t i = 0; i < model.free_count; ++i)
                solved[i] += d.segment<3>(3 * i);
            const core::NodeReader before(predicted), now(solved);
            if (contact.revise({before, now, still, rows_n, 1.0, 0, 1e-3}) !=
                core::Contact::Revision::changed)
                break;
        }
        contact.abandon_step();
    }

    /// Compliance: response of all free degrees of freedom to forces on them within a step, m/N.
    [[nodiscard]] const Eigen::MatrixXd& mobility() const { return mobility_; }
    /// d of the step with nothing held, for the state as it is, beyond positions.
    [[nodiscard]] Eigen::VectorXd free_motion() const {
        core::Field predicted = positions;
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            predicted[i] += dt * velocities[i];
        Eigen::VectorXd motion = mobility_ * (-stiffness_ * displacement(predicted));
        for (std::uint32_t i = 0; i < model.free_count; ++i) {
            motion.segment<3>(3 * i) +=
                predicted[i] - positions[i] + mobility_.middleRows<3>(3 * i) * gravity_load();
        }
        return motion;
    }

    core::Model model;
    core::Contact contact;
    core::Field positions, velocities;
    double dt;
    Vec gravity = Vec::Zero();
    /// Above zero: before contact judges a solve, it is shown one that is wrong by this share, as if it were
    /// on its way.
    double glance_error = 0;
    int glances = 0;           ///< that changed something
    double travel_factor = 1;  ///< large: contact looks at every node every time
    std::vector<Frame> rest_frames;
    // Of the last solve.
    std::vector<core::Constraint> constraints;
    std::vector<Vec> rows_n;
    double pull_tolerance_n = 0;

  private:
    bool glance(const core::NodeReader& before, const core::Field& predicted, const core::Field& solved,
                const std::vector<Vec>& still) {
        core::Field crude = predicted;
        std::vector<Vec> rows = rows_n;
        double travel = 0;
        for (std::uint32_t i = 0; i < model.free_count; ++i) {
            crude[i] += (1 + (i % 2 == 0 ? 1 : -1) * glance_error) * (solved[i] - predicted[i]);
            travel = std::max(travel, (crude[i] - positions[i]).norm());
        }
        for (std::size_t k = 0; k < rows.size(); ++k)
            rows[k] = (k % 2 == 0 ? 1 : -1) * glance_error * rows[k].norm() * Vec::UnitZ() + rows[k];
        return contact.glance(
            {before, core::NodeReader(crude), still, rows, travel_factor * travel, 0, 0, true});
    }

    [[nodiscard]] Eigen::VectorXd displacement(const core::Field& x) const {
        Eigen::VectorXd u(dofs_);
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            u.segment<3>(3 * i) = x[i] - model.rest_m[i];
        return u;
    }

    [[nodiscard]] Eigen::VectorXd gravity_load() const {
        Eigen::VectorXd load(dofs_);
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            load.segment<3>(3 * i) = model.mass_kg[i] * gravity;
        return load;
    }

    /// K = sum of mu (g_a.g_b I + g_b g_a^T) + lambda g_a g_b^T, times the volume.
    void assemble() {
        stiffness_ = Eigen::MatrixXd::Zero(dofs_, dofs_);
        for (const core::Element& element : model.elements) {
            Eigen::Matrix<double, 4, 3> g;
            g.bottomRows<3>() = element.rest_inverse;
            g.row(0) = -g.bottomRows<3>().colwise().sum();
            for (int a = 0; a < 4; ++a) {
                for (int b = 0; b < 4; ++b) {
                    const auto i = element.nodes[a], j = element.nodes[b];
                    if (i >= model.free_count || j >= model.free_count) continue;
                    stiffness_.block<3, 3>(3 * i, 3 * j) +=
                        element.mu_volume * (g.row(a).dot(g.row(b)) * core::Mat::Identity() +
                                             g.row(b).transpose() * g.row(a)) +
                        element.lambda_volume * g.row(a).transpose() * g.row(b);
                }
            }
        }
        matrix_ = dt * dt * stiffness_;
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            matrix_.diagonal().segment<3>(3 * i).array() += model.mass_kg[i];
        inverse_ = matrix_.inverse();
        mobility_ = dt * dt * inverse_;
    }

    /// Held directions by Lagrange multipliers.
    Eigen::VectorXd solve() {
        std::vector<Eigen::VectorXd> columns;
        std::vector<double> targets;
        Eigen::VectorXd load = load_;
        for (const core::Constraint& c : constraints) {
            load.segment<3>(3 * c.node) += dt * dt * c.friction_n;
            const bool whole = c.held.trace() > 2;
            Eigen::Index widest = 0;
            (void)c.held.colwise().squaredNorm().maxCoeff(&widest);
            for (int axis = 0; axis < (whole ? 3 : 1); ++axis) {
                const Vec direction = whole ? Vec(Vec::Unit(axis)) : Vec(c.held.col(widest).normalized());
                columns.push_back(Eigen::VectorXd::Zero(dofs_));
                columns.back().segment<3>(3 * c.node) = direction;
                targets.push_back(direction.dot(c.offset_m));
            }
        }
        Eigen::VectorXd d = inverse_ * load;
        const auto count = static_cast<Eigen::Index>(columns.size());
        if (count > 0) {
            Eigen::MatrixXd j(dofs_, count);
            Eigen::VectorXd target(count);
            for (Eigen::Index k = 0; k < count; ++k) {
                j.col(k) = columns[static_cast<std::size_t>(k)];
                target[k] = targets[static_cast<std::size_t>(k)];
            }
            const Eigen::MatrixXd moved = inverse_ * j;
            const Eigen::MatrixXd schur = j.transpose() * moved;
            d += moved * schur.llt().solve(target - j.transpose() * d);
        }
        const Eigen::VectorXd rows = (load_ - matrix_ * d) / (dt * dt);
        rows_n.clear();
        for (const core::Constraint& c : constraints)
            rows_n.push_back(rows.segment<3>(3 * c.node));
        return d;
    }

    Eigen::Index dofs_;
    Eigen::MatrixXd stiffness_, matrix_, inverse_, mobility_;
    Eigen::VectorXd load_;
};

/// A frame moved by `move_m` and turned about its own origin.
inline Frame placed(const Frame& rest, const Vec& move_m, const Eigen::AngleAxisd& turn = {0, Vec::UnitZ()}) {
    return {rest.position + move_m, turn.toRotationMatrix() * rest.rotation};
}

}  // namespace knead::test
