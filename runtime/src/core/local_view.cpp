// SPDX-License-Identifier: Apache-2.0
#include "core/local_view.h"

#include <algorithm>
#include <cmath>

namespace knead::core {
namespace {

/// Share of the mean edge beyond which the tetrahedra at the tool are another linear object.
constexpr Real kFairEdges = 0.25;
/// Share of the held nodes (one at least) that may be caught or let go within a fair view.
constexpr std::size_t kFairChange = 4;
/// Pivots below this share of the largest diagonal entry of their kind are rounding.
constexpr Real kPivot = 1e-12;

Vec3 to_array(const Vec& v) {
    return {v.x(), v.y(), v.z()};
}

/// The next pivot: the diagonal entry that is left the most of, and what it was before.
int next_pivot(const Gram& left, const Vec6& before) {
    int pivot = -1;
    Real most = kPivot;
    for (std::size_t i = 0; i < 6; ++i) {
        if (!(before[i] > 0) || !(left[i][i] > most * before[i])) continue;
        most = left[i][i] / before[i];
        pivot = static_cast<int>(i);
    }
    return pivot;
}

}  // namespace

void make_semidefinite(Gram& matrix) noexcept {
    Gram left = matrix;
    Vec6 before{};
    for (std::size_t i = 0; i < 6; ++i)
        before[i] = matrix[i][i];
    matrix = {};
    for (int round = 0; round < 6; ++round) {
        const int pivot = next_pivot(left, before);
        if (pivot < 0) return;
        const auto p = static_cast<std::size_t>(pivot);
        const Vec6 column = left[p];
        for (std::size_t i = 0; i < 6; ++i) {
            for (std::size_t j = 0; j < 6; ++j) {
                const Real part = column[i] * column[j] / column[p];
                matrix[i][j] += part;
                left[i][j] -= part;
            }
        }
    }
}

void fit(const Gram& at_rest, const Energies& fitted, Real time_s, Real damping_per_s,
         Impedance& out) noexcept {
    const Real rate = 1 / time_s, inertia = rate * (rate + damping_per_s);
    const auto each = [](Gram& matrix, auto&& entry) {
        for (std::size_t i = 0; i < 6; ++i) {
            for (std::size_t j = 0; j < 6; ++j)
                matrix[i][j] = entry(i, j);
        }
        make_semidefinite(matrix);
    };
    out.stiffness = at_rest;
    make_semidefinite(out.stiffness);
    each(out.mass, [&](std::size_t i, std::size_t j) {
        return fitted.mass[i][j] - (fitted.elastic[i][j] - at_rest[i][j]) / (rate * rate);
    });
    each(out.damping, [&](std::size_t i, std::size_t j) {
        const Real felt = fitted.elastic[i][j] + inertia * fitted.mass[i][j] - at_rest[i][j];
        return felt / rate - out.mass[i][j] * rate;
    });
}

LocalModel view_of(const Frame& tool, const Impedance& impedance) noexcept {
    LocalModel out;
    out.origin.position_m = to_array(tool.position);
    const Quat turn(tool.rotation);
    out.origin.orientation_wxyz = {turn.w(), turn.x(), turn.y(), turn.z()};
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j) {
            out.stiffness[6 * i + j] = impedance.stiffness[i][j];
            out.mass[6 * i + j] = impedance.mass[i][j];
            out.damping[6 * i + j] = impedance.damping[i][j];
        }
    }
    out.converged = impedance.converged;
    out.solver_iterations = impedance.iterations;
    return out;
}

ToolReach::ToolReach(const ToolSet& tool, Real mean_edge_m)
    : surface_(tool), unilateral_(tool.contact != ToolContact::bonded), mean_edge_m_(mean_edge_m) {
    if (unilateral_) nodes_ = tool.nodes;
    events_m_.reserve(2 * nodes_.size());
}

Vec ToolReach::outward(const Frame& tool, const Vec& place) const noexcept {
    return tool.rotation * surface_.closest(tool.to_local(place)).outward;
}

void ToolReach::describe(const Frame& tool, const std::vector<HeldPart>& held, const NodeReader& positions,
                         LocalModel& out) noexcept {
    find_load(held, out);
    const Vec push = normal(held, Vec(out.force_n[0], out.force_n[1], out.force_n[2]));
    out.normal = to_array(push);
    out.unilateral = unilateral_;
    out.touched_nodes = static_cast<std::uint32_t>(held.size());
    out.radius_m = radius(tool, held, push, positions);
}

void ToolReach::find_load(const std::vector<HeldPart>& held, LocalModel& out) const noexcept {
    Vec force = Vec::Zero(), torque = Vec::Zero();
    for (const HeldPart& part : held) {
        force += part.force_n;
        torque += part.arm_m.cross(part.force_n);
    }
    out.force_n = to_array(force);
    out.torque_nm = to_array(torque);
}

Vec ToolReach::normal(const std::vector<HeldPart>& held, const Vec& load_n) const noexcept {
    Vec weighted = Vec::Zero(), plain = Vec::Zero();
    for (const HeldPart& part : held) {
        weighted -= std::max<Real>(0, -part.outward.dot(part.force_n)) * part.outward;
        plain -= part.outward;
    }
    Vec sum = unilateral_ ? weighted : load_n;
    if (sum.isZero(0)) sum = plain;
    const Real length = sum.norm();
    return length > 0 && std::isfinite(length) ? Vec(sum / length) : Vec(Vec::Zero());
}

Real ToolReach::radius(const Frame& tool, const std::vector<HeldPart>& held, const Vec& normal,
                       const NodeReader& positions) noexcept {
    const Real most = kFairEdges * mean_edge_m_;
    if (!unilateral_) return most;
    events_m_.clear();
    auto part = held.begin();
    for (const std::uint32_t node : nodes_) {
        while (part != held.end() && part->node < node)
            ++part;
        if (part != held.end() && part->node == node) continue;
        const Vec local = tool.to_local(positions(node));
        const Real gap = -surface_.depth(local);
        if (gap >= 0 && gap < most && !surface_.beside(local)) events_m_.push_back(gap);
    }
    for (const HeldPart& node : held) {
        const Real falls = -node.outward.dot(node.rate * normal);
        const Real push = std::max<Real>(0, -node.outward.dot(node.force_n));
        if (push < falls * most) events_m_.push_back(push / falls);
    }
    const std::size_t fair = std::max<std::size_t>(1, held.size() / kFairChange);
    if (events_m_.size() < fair) return most;
    const auto at = events_m_.begin() + static_cast<std::ptrdiff_t>(fair - 1);
    std::nth_element(events_m_.begin(), at, events_m_.end());
    return *at;
}

}  // namespace knead::core
