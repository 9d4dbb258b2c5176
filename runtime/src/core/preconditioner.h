// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/factor/contact_correction.h"
#include "core/node_rotations.h"
#include "core/system.h"
#include "knead/formats/numerics.h"

namespace knead::core {

/// The inverse that conjugate gradients are given: of the rest-state matrix, turned node by node with the
/// matter (NodeRotations).
///
/// Made for one dt when constructed. Another dt of the steps only costs iterations; when it lasts, the numbers
/// are made anew, a bounded piece of work in each step, and taken into use at a step that depends on nothing
/// but the steps so far. S is float or double. Allocates in the constructor only.
template <class S>
class Preconditioner {
  public:
    /// @param elements not yet linearised; left at rest  @param touchable free nodes that constraints may hold
    Preconditioner(const Model& model, Elements<S>& elements, const Numerics& numerics, SimdTarget target,
                   Real dt_s, const std::vector<std::uint32_t>& touchable);

    /// As just constructed. Makes the numbers anew if they follow another dt.
    void reset() noexcept;

    /// Once for each step, after elements have been linearised.
    void begin_step(const System<S>& system) noexcept;

    /// Takes the held nodes of `system` into account, whenever they changed.
    void hold(const System<S>& system) noexcept;

    /// @param residual projected  @param out expanded
    void apply(const System<S>& system, const Unknowns<S>& residual, Unknowns<S>& out) const noexcept;

    /// Largest squared error of a tool's force for a unit of squared energy error, N^2 / (kg m^2).
    [[nodiscard]] Real force_sensitivity(const System<S>& system, std::size_t tool) const noexcept;

    [[nodiscard]] Real dt_s() const noexcept { return dt_s_; }
    [[nodiscard]] std::size_t factor_bytes() const noexcept;

  private:
    using Columns = std::array<NodeField<S>, 3>;  ///< one for each direction of a tool's motion
    /// What a bonded tool does to the free nodes, and how they answer.
    struct Border {
        Mat stiffness = Mat::Zero();     ///< felt by the tool with all free nodes still, N/m
        Columns force;                   ///< on the free nodes for a unit motion of the tool, N/m
        Columns response;                ///< A^-1 dt^2 force: how they follow
        Mat following_kg = Mat::Zero();  ///< dt^2 force^T response
        Real sensitivity = 0;            ///< largest eigenvalue of following_kg
    };

    void correct_for(const System<S>& system) noexcept;
    bool make_factor(FactorStorage storage, SimdTarget target);
    void make_blocks(std::uint32_t first, std::uint32_t stride) noexcept;
    void find_borders(Elements<S>& elements);
    void find_responses() noexcept;
    void follow(Real dt_s) noexcept;
    void solve(const NodeField<S>& residual, NodeField<S>& out) const noexcept;
    template <class T>
    void solve_with(AlignedArray<T>& packed, const NodeField<S>& residual, NodeField<S>& out) const noexcept;
    template <class T>
    void solve_corrected(AlignedArray<T>& packed, AlignedArray<T>& solved, const Unknowns<S>& residual,
                         Unknowns<S>& out) const noexcept;
    [[nodiscard]] bool in_double() const noexcept {
        return factor_->storage() == FactorStorage::double_precision;
    }
    [[nodiscard]] bool turns() const noexcept { return matrix_.kind() == RestMatrix::Kind::elastic; }

    const Model& model_;
    const FieldKernels<S>& fields_;
    const Masses<S> masses_;
    const Real expected_dt_s_;
    Real dt_s_;  ///< of the numbers in use
    std::uint32_t rotation_shares_;
    NodeRotations<S> rotations_;
    RestMatrix matrix_;
    std::unique_ptr<SupernodalFactor> factor_;  ///< none: block Jacobi
    mutable std::unique_ptr<SupernodalFactor::Scratch> scratch_;
    std::vector<std::array<S, 9>> blocks_;  ///< block Jacobi: [free nodes] inverse, row-major
    std::unique_ptr<ContactCorrection> correction_;  ///< none: held nodes are left to the projection
    mutable std::unique_ptr<ContactCorrection::Scratch> correction_scratch_;
    std::vector<HeldNode> held_;
    std::vector<Mat> own_inverse_;  ///< [tools] of moving ones without their nodes, 1/kg; else zero
    bool corrects_ = false;         ///< for the constraints of now
    mutable AlignedArray<float> packed_float_, solved_float_;
    mutable AlignedArray<double> packed_double_, solved_double_;
    std::vector<Border> borders_;         ///< [tools]
    std::vector<Real> node_stiffness_;    ///< [free nodes] bound of the diagonal block, N/m
    std::vector<Real> held_stiffness_;    ///< [tools] of the nodes in the constraints together, N/m
    std::vector<Mat> tool_inverse_;       ///< [tools] moving ones: of what is left for the tool itself

    // Another dt.
    Real wanted_dt_s_ = 0;
    int steps_wanted_ = 0;
    bool working_ = false;      ///< new numbers are being made
    bool factored_ = false;     ///< those of the factor are
    std::uint32_t next_block_ = 0;
};

}  // namespace knead::core
