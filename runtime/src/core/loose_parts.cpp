// SPDX-License-Identifier: Apache-2.0
#include "core/loose_parts.h"

#include <algorithm>
#include <numeric>

namespace knead::core {
namespace {

/// Beyond this the turn is not linear in its effect any more (rad); in free flight it is the square of what a
/// body turns by in a step.
constexpr Real kSmallTurn = 0.1;

/// The first node of its part, for every node (union-find).
std::vector<std::uint32_t> first_nodes(const Model& model) {
    std::vector<std::uint32_t> first(model.rest_m.size());
    std::iota(first.begin(), first.end(), 0U);
    const auto find = [&](std::uint32_t node) {
        while (first[node] != node)
            node = first[node] = first[first[node]];
        return node;
    };
    for (const Element& element : model.elements) {
        for (const std::uint32_t node : element.nodes) {
            const std::uint32_t a = find(element.nodes[0]), b = find(node);
            first[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::uint32_t& node : first)
        node = find(node);
    return first;
}

}  // namespace

std::vector<LoosePart> find_loose_parts(const Model& model) {
    const std::vector<std::uint32_t> first = first_nodes(model);
    std::vector<bool> held(first.size(), false);
    for (std::size_t i = model.free_count; i < first.size(); ++i)
        held[first[i]] = true;
    std::vector<LoosePart> parts;
    std::vector<std::size_t> part_of(first.size());
    for (std::uint32_t i = 0; i < model.free_count; ++i) {
        if (held[first[i]]) continue;
        if (first[i] == i) {
            part_of[i] = parts.size();
            parts.emplace_back();
        }
        LoosePart& part = parts[part_of[first[i]]];
        part.nodes.push_back(i);
        part.mass_kg += model.mass_kg[i];
    }
    return parts;
}

bool is_touched(const LoosePart& part, const std::vector<Constraint>& constraints) noexcept {
    return std::any_of(constraints.begin(), constraints.end(), [&](const Constraint& constraint) {
        return std::binary_search(part.nodes.begin(), part.nodes.end(), constraint.node);
    });
}

template <class S>
void give_spin(const LoosePart& part, const Model& model, Real dt_s, NodeField<S>& displacements_m,
               NodeField<S>& velocities_m_per_s, NodeField<S>& beyond_m) noexcept {
    const auto at = [&](std::uint32_t i) -> Vec { return model.rest_m[i] + displacements_m.get(i); };
    Vec middle = Vec::Zero();
    for (const std::uint32_t i : part.nodes)
        middle += (model.mass_kg[i] / part.mass_kg) * at(i);
    // The scene's damping brakes it as it brakes everything.
    const Real damping = model.damping_per_s * dt_s;
    Vec moment = Vec::Zero();  // kg m^2, dt times the torque impulse
    Mat inertia = Mat::Zero();
    for (const std::uint32_t i : part.nodes) {
        const Vec arm = at(i) - middle;
        const Vec change = beyond_m.get(i) + (damping * dt_s) * velocities_m_per_s.get(i);
        moment += model.mass_kg[i] * arm.cross(change);
        inertia += model.mass_kg[i] * (arm.squaredNorm() * Mat::Identity() - arm * arm.transpose());
    }
    const Vec turn = -inertia.inverse() * moment / (1 + damping);
    if (!(turn.squaredNorm() <= kSmallTurn * kSmallTurn)) return;  // nor where it is not finite
    for (const std::uint32_t i : part.nodes) {
        const Vec way = turn.cross(at(i) - middle);
        displacements_m.add(i, way);
        velocities_m_per_s.add(i, way / dt_s);
        beyond_m.add(i, way);
    }
}

template void give_spin(const LoosePart&, const Model&, Real, NodeField<float>&, NodeField<float>&,
                        NodeField<float>&) noexcept;
template void give_spin(const LoosePart&, const Model&, Real, NodeField<double>&, NodeField<double>&,
                        NodeField<double>&) noexcept;

}  // namespace knead::core
