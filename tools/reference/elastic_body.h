// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "knead/formats/material.h"
#include "knead/formats/tet_mesh.h"
#include "reference/corotational.h"
#include "reference/tensor_point.h"

namespace knead::tools {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Index of a node's x among the unknowns; y and z follow.
[[nodiscard]] constexpr Eigen::Index first_unknown(std::uint32_t node) {
    return 3 * Eigen::Index{node};
}

/// A heterogeneous body of corotational linear tetrahedra: its elastic energy and the derivatives of it.
///
/// Positions and forces are vectors of 3 * node_count() numbers, node by node; metres and newtons.
/// @thread-safety immutable after construction
class ElasticBody {
  public:
    /// @throws ToolError(bad_input) when the mesh or the material breaks an invariant of its type
    ElasticBody(const TetMesh& mesh, const Material& material);
    /// Any linear elasticity in each tetrahedron, with the densities of `material`; the rest of it is unused.
    /// Only Curvature::rotation_frozen is to be had of such a body; the others fall back to it.
    /// @param tensors [tetrahedra] symmetric, positive semidefinite
    ElasticBody(const TetMesh& mesh, const Material& material, const std::vector<ElasticityTensor>& tensors);

    [[nodiscard]] std::size_t node_count() const { return static_cast<std::size_t>(rest_.size()) / 3; }
    [[nodiscard]] std::size_t tetrahedron_count() const { return elements_.size(); }
    [[nodiscard]] const Tetrahedron& nodes_of(std::size_t tetrahedron) const {
        return elements_[tetrahedron].nodes;
    }
    [[nodiscard]] const Eigen::VectorXd& rest_positions_m() const { return rest_; }
    /// [nodes] a quarter of the mass of every tetrahedron at each of its nodes.
    [[nodiscard]] const Eigen::VectorXd& lumped_mass_kg() const { return mass_; }

    [[nodiscard]] double energy_j(const Eigen::VectorXd& positions_m) const;
    /// Derivative of the energy to the positions: the force needed to hold each node where it is.
    [[nodiscard]] Eigen::VectorXd gradient_n(const Eigen::VectorXd& positions_m) const;
    /// Second derivative of one tetrahedron's energy; entry 3 * a + i is axis i of its node a.
    [[nodiscard]] Matrix12d stiffness_n_per_m(std::size_t tetrahedron, const Eigen::VectorXd& positions_m,
                                              Curvature curvature) const;
    /// Bound on what rounding in double precision alone leaves in a nodal force, newtons.
    [[nodiscard]] double rounding_noise_n() const { return rounding_noise_n_; }
    /// Largest diagonal entry that one tetrahedron adds to the stiffness at rest.
    [[nodiscard]] double largest_stiffness_n_per_m() const { return largest_stiffness_n_per_m_; }

  private:
    struct Element {
        Tetrahedron nodes;
        Eigen::Matrix<double, 3, 4> shape_gradients;  // column a: gradient of the shape function of node a
        double volume_m3;
        LameParameters lame;
    };
    [[nodiscard]] Eigen::Matrix3d deformation_gradient(const Element& element,
                                                       const Eigen::VectorXd& positions_m) const;
    [[nodiscard]] CorotationalPoint evaluate(const Element& element,
                                             const Eigen::VectorXd& positions_m) const;
    [[nodiscard]] TensorPoint evaluate_tensor(std::size_t tetrahedron,
                                              const Eigen::VectorXd& positions_m) const;

    Eigen::VectorXd rest_, mass_;
    std::vector<Element> elements_;
    std::vector<ElasticityTensor> tensors_;  // [tetrahedra], or empty: isotropic
    double rounding_noise_n_ = 0;
    double largest_stiffness_n_per_m_ = 0;
};

}  // namespace knead::tools
