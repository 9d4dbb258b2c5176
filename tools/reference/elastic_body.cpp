// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/elastic_body.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/error.h"

namespace knead::tools {
namespace {

// Operations that touch a nodal force one after the other (edges, gradient, stress, sum over the tetrahedra
// around a node), each with a relative rounding of one epsilon: about this many in a usual mesh.
constexpr double kRoundedOperations = 64;

void require(const Status& status) {
    if (!status.ok()) fail_input(status.error().text());
}

/// Columns: edges from node 0 to nodes 1, 2, 3.
Eigen::Matrix3d edges(const Tetrahedron& nodes, const Eigen::VectorXd& positions) {
    Eigen::Matrix3d result;
    for (int k = 0; k < 3; ++k)
        result.col(k) =
            positions.segment<3>(first_unknown(nodes[k + 1])) - positions.segment<3>(first_unknown(nodes[0]));
    return result;
}

}  // namespace

ElasticBody::ElasticBody(const TetMesh& mesh, const Material& material) {
    require(validate(mesh));
    require(validate(material, mesh.tetrahedra.size()));
    rest_.resize(3 * static_cast<Eigen::Index>(mesh.nodes_m.size()));
    for (std::size_t n = 0; n < mesh.nodes_m.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            rest_[static_cast<Eigen::Index>(3 * n + axis)] = mesh.nodes_m[n][axis];
    mass_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.nodes_m.size()));
    elements_.reserve(mesh.tetrahedra.size());
    const double extent_m = rest_.lpNorm<Eigen::Infinity>();
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        Element element;
        element.nodes = mesh.tetrahedra[t];
        const Eigen::Matrix3d rest_edges = edges(element.nodes, rest_);
        element.volume_m3 = rest_edges.determinant() / 6;
        element.shape_gradients.rightCols<3>() = rest_edges.inverse().transpose();
        element.shape_gradients.col(0) = -element.shape_gradients.rightCols<3>().rowwise().sum();
        element.lame = lame_parameters(material.youngs_modulus_pa[t], material.poissons_ratio[t]);
        for (const std::uint32_t node : element.nodes)
            mass_[node] += element.volume_m3 * material.density_kg_per_m3[t] / 4;
        // A position is known to epsilon * extent: the strain to that times the shape gradient.
        const double gradient = element.shape_gradients.norm();
        const double stiffness_pa = 2 * element.lame.mu_pa + 3 * std::abs(element.lame.lambda_pa);
        rounding_noise_n_ = std::max(rounding_noise_n_, stiffness_pa * element.volume_m3 * gradient *
                                                            std::max(1.0, gradient * extent_m));
        largest_stiffness_n_per_m_ =
            std::max(largest_stiffness_n_per_m_, stiffness_pa * element.volume_m3 * gradient * gradient);
        elements_.push_back(element);
    }
    rounding_noise_n_ *= kRoundedOperations * std::numeric_limits<double>::epsilon();
}

ElasticBody::ElasticBody(const TetMesh& mesh, const Material& material,
                         const std::vector<ElasticityTensor>& tensors)
    : ElasticBody(mesh, material) {
    if (tensors.size() != elements_.size())
        fail_input(std::to_string(tensors.size()) + " elasticity tensors for " +
                   std::to_string(elements_.size()) + " tetrahedra");
    for (std::size_t t = 0; t < tensors.size(); ++t)
        if (!tensors[t].allFinite())
            fail_input("elasticity tensor of tetrahedron " + std::to_string(t) + " is not finite");
    tensors_ = tensors;
    const double extent_m = rest_.lpNorm<Eigen::Infinity>();
    rounding_noise_n_ = 0;
    for (std::size_t t = 0; t < tensors.size(); ++t) {
        const double gradient = elements_[t].shape_gradients.norm();
        rounding_noise_n_ = std::max(rounding_noise_n_, tensors[t].norm() * elements_[t].volume_m3 *
                                                            gradient * std::max(1.0, gradient * extent_m));
    }
    rounding_noise_n_ *= kRoundedOperations * std::numeric_limits<double>::epsilon();
}

Eigen::Matrix3d ElasticBody::deformation_gradient(const Element& element,
                                                  const Eigen::VectorXd& positions_m) const {
    return edges(element.nodes, positions_m) * element.shape_gradients.rightCols<3>().transpose();
}

CorotationalPoint ElasticBody::evaluate(const Element& element, const Eigen::VectorXd& positions_m) const {
    return {deformation_gradient(element, positions_m), element.lame};
}

TensorPoint ElasticBody::evaluate_tensor(std::size_t tetrahedron, const Eigen::VectorXd& positions_m) const {
    return {deformation_gradient(elements_[tetrahedron], positions_m), tensors_[tetrahedron]};
}

double ElasticBody::energy_j(const Eigen::VectorXd& positions_m) const {
    double sum = 0;
    for (std::size_t t = 0; t < elements_.size(); ++t)
        sum += elements_[t].volume_m3 * (tensors_.empty()
                                             ? evaluate(elements_[t], positions_m).energy_density_j_per_m3()
                                             : evaluate_tensor(t, positions_m).energy_density_j_per_m3());
    return sum;
}

Eigen::VectorXd ElasticBody::gradient_n(const Eigen::VectorXd& positions_m) const {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(rest_.size());
    for (std::size_t t = 0; t < elements_.size(); ++t) {
        const Element& element = elements_[t];
        const Eigen::Matrix3d stress_pa = tensors_.empty() ? evaluate(element, positions_m).stress_pa()
                                                           : evaluate_tensor(t, positions_m).stress_pa();
        const Eigen::Matrix<double, 3, 4> forces = element.volume_m3 * stress_pa * element.shape_gradients;
        for (int a = 0; a < 4; ++a)
            gradient.segment<3>(first_unknown(element.nodes[a])) += forces.col(a);
    }
    return gradient;
}

Matrix12d ElasticBody::stiffness_n_per_m(std::size_t tetrahedron, const Eigen::VectorXd& positions_m,
                                         Curvature curvature) const {
    const Element& element = elements_[tetrahedron];
    Eigen::Matrix<double, 9, 12> gradient_of_positions = Eigen::Matrix<double, 9, 12>::Zero();
    for (int a = 0; a < 4; ++a)
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i)
                gradient_of_positions(i + 3 * k, 3 * a + i) = element.shape_gradients(k, a);
    const Matrix9d tangent = tensors_.empty() ? evaluate(element, positions_m).tangent_pa(curvature)
                                              : evaluate_tensor(tetrahedron, positions_m).frozen_tangent_pa();
    return element.volume_m3 * gradient_of_positions.transpose() * tangent * gradient_of_positions;
}

}  // namespace knead::tools
