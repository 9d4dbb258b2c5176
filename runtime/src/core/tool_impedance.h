// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/local_view.h"
#include "core/preconditioner.h"

namespace knead::core {

/// How the object answers to the motion of one tool, direction by direction: three translations and, if
/// asked, three rotations about the tool's origin.
///
/// The nodes that the tool holds follow it in what it holds of them (T, node by node), those of other tools
/// stay, all others follow: the shape Y. Until they are at rest, it gives the stiffness Y^T K Y, that is
/// T^T (K_ss - K_sf K_ff^-1 K_fs) T. A motion that grows as exp(s t), s = 1 / kFitted_s, has another shape
/// and what the tool feels of it is D(s) = Y^T (K + (s^2 + c s) M) Y, with the slope D'(s) = (2 s + c) Y^T M
/// Y (shapes are stationary). Mass and damping are those of m s^2 + b s + stiffness with the same D and D':
/// what moves along and what is radiated into the object. Made from shapes, matrices are symmetric and
/// positive semidefinite, and errors of the shapes enter stiffness and D squared, as too much of them.
///
/// Conjugate gradients on the operator of the last step, from the shapes found last. An object that nothing
/// supports has inertia at a time scale of kUnsupported_s to lean on. Changes nothing that steps read.
/// Allocates in the constructor only.
template <class S>
class ToolImpedance {
  public:
    /// @param directions 3, or 6 with rotations
    ToolImpedance(const Model& model, std::size_t tools, std::size_t directions);

    void reset() noexcept;

    /// @param step of the last step, linearised
    /// @param held what `tool` holds: its entries of step.constraints in their order, then what is bonded to
    /// it; rates are filled in
    void find(const System<S>& step, const Preconditioner<S>& preconditioner, std::uint32_t tool,
              std::vector<HeldPart>& held, Impedance& out) noexcept;

  private:
    struct Shape {
        Unknowns<S> motion;
        NodeField<S> rows;  ///< of the operator times it
    };

    void follow(const System<S>& system, std::uint32_t tool, const std::vector<HeldPart>& held,
                std::size_t direction, Unknowns<S>& motion) const noexcept;
    void free_part(const System<S>& system, NodeField<S>& rows) const noexcept;
    [[nodiscard]] bool solve(const System<S>& system, const Preconditioner<S>& preconditioner, Shape& shape,
                             std::uint32_t most, std::uint32_t& iterations) noexcept;
    [[nodiscard]] static Real condition(const System<S>& system, const Shape& shape, Real energy) noexcept;
    void find_shapes(const System<S>& system, const Preconditioner<S>& preconditioner, std::uint32_t tool,
                     const std::vector<HeldPart>& held, std::vector<Shape>& shapes, Energies& energies,
                     Impedance& out) noexcept;
    void measure(const System<S>& system, std::uint32_t tool, const std::vector<Shape>& shapes,
                 Energies& out) noexcept;

    const std::size_t directions_;
    std::vector<ToolUnknown> still_;                    ///< [tools] all where they are
    std::vector<std::vector<Shape>> at_rest_, fitted_;  ///< [tools][directions]
    Unknowns<S> residual_, direction_, preconditioned_;
    NodeField<S> product_;
    std::size_t shapes_left_ = 0;  ///< of the call under way
    std::uint32_t iterations_left_ = 0;
};

}  // namespace knead::core
