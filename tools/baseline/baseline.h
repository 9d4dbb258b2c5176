// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "baseline/body.h"

namespace knead::baseline {

/// The plain way to take the same step: what the runtime's speed is compared with.
///
/// Double precision; the matrix assembled into a pattern of 3x3 blocks in compressed rows that was made once
/// (every tetrahedron knows the places of its blocks); conjugate gradients with block Jacobi, started at the
/// prediction; rotations by Newton steps from the quaternions of the step before. Arrays of plain numbers and
/// loops that a compiler can see through, no intrinsics.
///
/// Stops at |r| <= kRelativeResidual |b|: the weakest power of ten at which its own step force error stays
/// below 1e-3, the same strength as the runtime's guard (the table prints both errors).
/// Made for motions without inversion.
class Baseline {
  public:
    static constexpr double kRelativeResidual = 1e-2;

    explicit Baseline(const Body& body, double relative_residual = kRelativeResidual);  ///< keeps a reference

    void reset();
    /// @return the force on the plate, newtons
    Eigen::Vector3d step(const Pose& plate_pose, double dt_s);

    [[nodiscard]] const State& state() const { return state_; }
    [[nodiscard]] int iterations() const { return iterations_; }  ///< of the last step

  private:
    using Block = std::array<double, 9>;       // row by row
    using Vector = std::vector<double>;        // 3 numbers per active node
    using Quaternion = std::array<double, 4>;  // w, x, y, z

    void make_pattern();
    void assemble(double dt_s);
    void add_blocks(std::size_t element, const double* gradients, double dt_s);
    void invert_diagonal();
    void multiply(const Vector& x, Vector& out) const;
    void precondition(const Vector& r, Vector& z) const;
    void solve();
    [[nodiscard]] Eigen::Vector3d accept(double dt_s);

    const Body& body_;
    const double relative_residual_;
    State state_;
    Columns predicted_;
    std::vector<Quaternion> rotations_;  // [elements]

    // Rows: active nodes, then the plate's; columns: active nodes.
    std::vector<int> row_of_node_;                    // [nodes] or -1
    std::vector<int> row_start_, column_, diagonal_;  // CSR of blocks
    std::vector<std::array<int, 16>> place_;          // [elements] of block (a, b), or -1
    std::vector<Block> blocks_, diagonal_inverse_;
    Vector load_;  // [rows] dt^2 times the force at the prediction
    Vector displacement_, residual_, direction_, product_, preconditioned_;
    int iterations_ = 0;
};

}  // namespace knead::baseline
