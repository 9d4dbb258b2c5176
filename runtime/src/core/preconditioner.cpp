// SPDX-License-Identifier: Apache-2.0
#include "core/preconditioner.h"

namespace knead::core {
namespace {

/// Inverse of a symmetric positive definite block by its cofactors.
Mat inverse(const Mat& m) {
    Mat result;
    result.row(0) = m.col(1).cross(m.col(2));
    result.row(1) = m.col(2).cross(m.col(0));
    result.row(2) = m.col(0).cross(m.col(1));
    return result / result.row(0).dot(m.col(0));
}

}  // namespace

BlockJacobi::BlockJacobi(const Model& model)
    : inverse_blocks_(model.rest_m.size(), Mat::Zero()),
      columns_(model.rest_m.size(), Mat::Zero()),
      marked_(model.rest_m.size(), 0) {}

void BlockJacobi::refresh(const System& system) noexcept {
    system.pass.diagonal_blocks(system.model, inverse_blocks_);
    const Real dt2 = system.dt_s * system.dt_s;
    for (std::uint32_t i = 0; i < system.model.free_count; ++i) {
        Mat block = dt2 * inverse_blocks_[i];
        block.diagonal().array() += system.inertia * system.model.mass_kg[i];
        inverse_blocks_[i] = inverse(block);
    }
}

void BlockJacobi::hold(const System& system) noexcept {
    tool_stiffness_.setZero();
    Mat tool_block = system.tool_diagonal_kg() * Mat::Identity();
    for (const Constraint& c : system.constraints) {
        columns_[c.node] = c.held;
        marked_[c.node] = 1;
        tool_block += (system.inertia * system.model.mass_kg[c.node]) * c.held;
    }
    if (!system.constraints.empty()) {
        tool_stiffness_ = system.pass.reduced_stiffness(system.model, columns_, marked_);
    }
    for (const Constraint& c : system.constraints) {
        columns_[c.node].setZero();
        marked_[c.node] = 0;
    }
    if (system.tool.moves) tool_inverse_ = inverse(tool_block + system.dt_s * system.dt_s * tool_stiffness_);
}

void BlockJacobi::apply(const System& system, const Unknowns& residual, Unknowns& out) const noexcept {
    for (std::uint32_t i = 0; i < system.model.free_count; ++i) {
        out.nodes[i].noalias() = inverse_blocks_[i] * residual.nodes[i];
    }
    out.tool = system.tool.moves ? Vec(tool_inverse_ * residual.tool) : Vec::Zero();
    system.expand(out);
}

}  // namespace knead::core
