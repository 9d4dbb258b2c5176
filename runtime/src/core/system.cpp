// SPDX-License-Identifier: Apache-2.0
#include "core/system.h"

namespace knead::core {

void System::apply(const Field& u, Field& out) const noexcept {
    pass.apply_stiffness(model, u, out);
    const Real dt2 = dt_s * dt_s;
    for (std::uint32_t i = 0; i < model.free_count; ++i) {
        out[i] = inertia * model.mass_kg[i] * u[i] + dt2 * out[i];
    }
    for (std::size_t i = model.free_count; i < out.size(); ++i)
        out[i].setZero();
}

void System::project(Unknowns& rows) const noexcept {
    for (const Constraint& c : constraints) {
        const Vec held = c.held * rows.nodes[c.node];
        rows.nodes[c.node] -= held;
        if (tool.moves) rows.tool += held;
    }
}

void System::expand(Unknowns& u) const noexcept {
    for (const Constraint& c : constraints) {
        Vec& node = u.nodes[c.node];
        node += c.held * (u.tool - node);
    }
}

}  // namespace knead::core
