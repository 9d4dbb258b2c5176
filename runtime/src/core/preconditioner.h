// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/factor/contact_correction.h"
#include "core/node_rotations.h"
#include "core/sparse_inverse.h"
#include "core/system.h"
#include "knead/formats/numerics.h"

namespace knead::core {

/// The inverse that conjugate gradients are given: of the rest-state matrix, turned node by node with the
/// matter (NodeRotations).
///
/// Where mass outweighs stiffness it is the sparse approximate inverse, else a factor. Made for one dt when
/// constructed. Another dt of the steps only costs iterations; when it lasts, the numbers
/// are made anew, a bounded piece of work in each step, and taken into use at a step that depends on nothing
/// but the steps so far. S is float or double. Allocates in the constructor only.
template <class S>
class Preconditioner {
  public:
    /// @param touchable free nodes that constraints may hold
    Preconditioner(const Model& model, const Stiffness<S>& at_rest, const Numerics& numerics,
                   SimdTarget target, Real dt_s, const std::vector<std::uint32_t>& touchable);

    /// As just constructed. Makes the numbers anew if they follow another dt.
    void reset() noexcept;

    /// Once for each step, after elements have been linearised.
    void begin_step(const System<S>& system) noexcept;
    /// A part of it: after they have been linearised again in the same step.
    void turn(const System<S>& system) noexcept;

    /// Takes the held nodes of `system` into account, whenever they changed.
    void hold(const System<S>& system) noexcept;

    /// @param residual projected  @param out expanded
    void apply(const System<S>& system, const Unknowns<S>& residual, Unknowns<S>& out) const noexcept;

    /// Whether force_owed() says anything: of a bonded tool that does not move, at about the dt that this was
    /// made for.
    [[nodiscard]] bool knows_force_owed(const System<S>& system, std::size_t tool) const noexcept;
    /// By how much what is left of the residual would change the force of a bonded tool that does not move,
    /// to first order in how far this is from the inverse: the response to the tool's motion is that of its
    /// force to loads, by symmetry. Zero for other tools.
    [[nodiscard]] Vec force_owed(const System<S>& system, std::size_t tool,
                                 const NodeField<S>& residual) const noexcept;

    /// Largest squared error of a tool's force for a unit of squared energy error, N^2 / (kg m^2).
    [[nodiscard]] Real force_sensitivity(const System<S>& system, std::size_t tool) const noexcept;

    /// Whether it is near enough to the inverse for r^T P r to be a fair measure of the error, as far as dt
    /// matters.
    [[nodiscard]] bool is_close(Real dt_s) const noexcept;
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

    void find_held_stiffness(const System<S>& system) noexcept;
    void correct_for(const System<S>& system) noexcept;
    [[nodiscard]] bool sparse_suffices(Real dt_s) const noexcept;
    void make_for(Real dt_s) noexcept;
    [[nodiscard]] bool advance(std::uint64_t work) noexcept;
    void find_borders(const Stiffness<S>& at_rest);
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
    [[nodiscard]] bool laplacian() const noexcept { return laplacian_matrix_ != nullptr; }

    const Model& model_;
    const FieldKernels<S>& fields_;
    const Real expected_dt_s_;
    Real dt_s_;  ///< of the numbers in use
    std::uint32_t rotation_shares_;
    NodeRotations<S> rotations_;
    RestMatrix matrix_;
    SparseInverse<S> sparse_;
    bool uses_sparse_ = true;
    bool turns_ = false;  ///< the sparse inverse is turned with the matter, in this step
    std::unique_ptr<RestMatrix> laplacian_matrix_;  ///< what the factor is of; none: of matrix_
    std::unique_ptr<SupernodalFactor> factor_;      ///< none: always the sparse inverse
    mutable std::unique_ptr<SupernodalFactor::Scratch> scratch_;
    mutable NodeField<S> turned_;
    std::unique_ptr<ContactCorrection> correction_;  ///< none: held nodes are left to the projection
    mutable std::unique_ptr<ContactCorrection::Scratch> correction_scratch_;
    std::vector<HeldNode> held_;
    std::vector<Mat> own_inverse_;  ///< [tools] of moving ones without their nodes, 1/kg; else zero
    bool corrects_ = false;         ///< for the constraints of now
    mutable AlignedArray<float> packed_float_, solved_float_;
    mutable AlignedArray<double> packed_double_, solved_double_;
    std::vector<Border> borders_;       ///< [tools]
    std::vector<Real> node_stiffness_;  ///< [free nodes] bound of the diagonal block, N/m
    std::vector<Real> held_stiffness_;  ///< [tools] of the nodes in the constraints together, N/m
    /// Of which nodes that is.
    struct Felt {
        std::uint32_t node = 0, tool = 0;
        bool alike = false;  ///< held as the first one of its tool
        Mat held = Mat::Zero();
    };
    std::vector<Felt> felt_;
    std::size_t felt_count_ = 0;
    std::vector<std::uint32_t> felt_at_;  ///< [free nodes] index in felt_, if that says so too
    std::vector<Mat> felt_stiffness_;     ///< [tools]
    /// [tools] The part of it that comes of nodes held alike, before `held` is applied.
    struct FeltAlike {
        Mat held = Mat::Zero(), own = Mat::Zero(), between = Mat::Zero();
    };
    std::vector<FeltAlike> felt_alike_;
    Real matrix_dt_s_ = 0;           ///< of matrix_
    std::vector<Mat> tool_inverse_;  ///< [tools] moving ones: of what is left for the tool itself

    /// New numbers for another dt, what is being made.
    enum class Job : std::uint8_t { none, sparse, factor, contact };
    Real stiffness_per_s2_ = 0;  ///< sum of node stiffnesses over the free mass
    Real wanted_dt_s_ = 0;
    int steps_wanted_ = 0;
    Job job_ = Job::none;
    std::uint32_t next_row_ = 0;
};

}  // namespace knead::core
