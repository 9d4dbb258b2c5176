// SPDX-License-Identifier: Apache-2.0
#include "core/system.h"

namespace knead::core {

template <class S>
Masses<S>::Masses(const Model& model) : kg(model.rest_m.size()), per_kg(model.rest_m.size()) {
    for (std::size_t i = 0; i < model.free_count; ++i) {
        kg.set(i, Vec::Constant(model.mass_kg[i]));
        per_kg.set(i, Vec::Constant(1 / model.mass_kg[i]));
    }
}

template <class S>
void System<S>::apply(Unknowns<S>& u, NodeField<S>& out) const noexcept {
    const auto carry = [&](bool along) {
        for (std::size_t k = 0; k < tools.size(); ++k) {
            if (!tools[k].moves) continue;
            for (std::uint32_t i = model.bonded[k].begin; i < model.bonded[k].end; ++i)
                u.nodes.set(i, along ? u.tools[k] : Vec(Vec::Zero()));
        }
    };
    carry(true);
    fields.multiply(out.size(), masses.kg.data(), static_cast<S>(inertia), u.nodes.data(), out.data());
    stiffness.add_product(static_cast<S>(dt_s * dt_s), u.nodes, out);
    carry(false);
}

template <class S>
void System<S>::project(Unknowns<S>& rows) const noexcept {
    for (std::size_t k = 0; k < tools.size(); ++k) {
        if (!tools[k].moves) continue;
        for (std::uint32_t i = model.bonded[k].begin; i < model.bonded[k].end; ++i)
            rows.tools[k] += rows.nodes.get(i);
    }
    for (const Constraint& c : constraints) {
        const Vec row = rows.nodes.get(c.node);
        const Vec held = c.held * row;
        rows.nodes.set(c.node, row - held);
        if (tools[c.tool].moves) rows.tools[c.tool] += held;
    }
}

template <class S>
void System<S>::expand(Unknowns<S>& u) const noexcept {
    for (const Constraint& c : constraints) {
        const Vec node = u.nodes.get(c.node);
        u.nodes.set(c.node, node + c.held * (u.tools[c.tool] - node));
    }
}

template <class S>
Real System<S>::tool_diagonal_kg(std::size_t tool) const noexcept {
    Real diagonal = tools[tool].mass_kg + dt_s * dt_s * tools[tool].rate_n_per_m;
    for (std::uint32_t i = model.bonded[tool].begin; i < model.bonded[tool].end; ++i)
        diagonal += inertia * model.mass_kg[i];
    return diagonal;
}

template struct Masses<float>;
template struct Masses<double>;
template struct System<float>;
template struct System<double>;

}  // namespace knead::core
