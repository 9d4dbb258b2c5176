// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/factor/matrix_pattern.h"
#include "core/model.h"

namespace knead::core {

/// The matrix A = inertia * M + dt^2 * K of implicit Euler over the unknown nodes [0, free_count), in double
/// precision: what a factor is made of. The other nodes are held.
///
/// K is the stiffness of the corotational tetrahedra with given rotations, at rest all identity. Allocates in
/// the constructor only.
class RestMatrix {
  public:
    enum class Kind : std::uint8_t {
        elastic,    ///< 3 x 3 blocks, column-major: the stiffness itself
        laplacian,  ///< one number for each pair of nodes, sum of (2 mu + lambda) V grad a . grad b: the same
                    ///< for the three directions, whatever the rotations
    };

    /// At rest; values for dt_s = 0, inertia = 1.
    RestMatrix(const Model& model, Kind kind);

    /// K anew, element e turned by rotations[e]. No effect on a Laplacian. Takes effect with the next set().
    void rotate(const Model& model, const Mat* rotations) noexcept;

    /// values() = inertia * M + dt^2 * K.
    void set(double dt_s, double inertia) noexcept;

    [[nodiscard]] Kind kind() const noexcept { return kind_; }
    /// Rows of one block: 3 or 1.
    [[nodiscard]] int block_size() const noexcept { return kind_ == Kind::elastic ? 3 : 1; }
    [[nodiscard]] const MatrixPattern& pattern() const noexcept { return pattern_; }
    /// [pattern().row_nodes] blocks of block_size()^2 numbers, kg.
    [[nodiscard]] const double* values() const noexcept { return values_.data(); }

  private:
    void add_element(const Element& element, const std::uint32_t* pairs, const Mat* rotation) noexcept;

    Kind kind_;
    std::vector<std::uint32_t> pairs_;  ///< [elements][10] entry of nodes (a, b), a <= b, of the element
    MatrixPattern pattern_;             ///< made together with them
    std::vector<double> mass_kg_;       ///< [node_count]
    std::vector<double> stiffness_, values_;
};

}  // namespace knead::core
