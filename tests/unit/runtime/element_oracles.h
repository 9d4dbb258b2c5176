// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <algorithm>

#include "core/model.h"
#include "support/svd_rotation.h"

// What the element pass is to find: one tetrahedron after the other in double precision, rotations by Eigen's
// SVD.
namespace knead::core {

using test::svd_rotation;

/// Below this the oracle of linear elasticity is right to 1e-7, and that of F loses more beside the identity.
inline constexpr double kLinearBelow_m = 3e-9;

inline double largest(const Field& field) {
    double result = 0;
    for (const Vec& v : field)
        result = std::max(result, v.norm());
    return result;
}

inline Mat edges_of(const Element& element, const Field& x) {
    Mat edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = x[element.nodes[static_cast<std::size_t>(k) + 1]] - x[element.nodes[0]];
    return edges;
}

inline Mat deformation_gradient(const Model& model, const Element& element, const Field& u) {
    return Mat::Identity() + edges_of(element, u) * edges_of(element, model.rest_m).inverse();
}

inline double energy(const Model& model, const Field& u) {
    double sum = 0;
    for (const Element& element : model.elements) {
        const Mat f = deformation_gradient(model, element, u);
        const Mat r = svd_rotation(f);
        const double stretch = (r.transpose() * f - Mat::Identity()).trace();
        sum += element.mu_volume * (f - r).squaredNorm() + element.lambda_volume / 2 * stretch * stretch;
    }
    return sum;
}

/// force(element, F, R): 3 x 3, the forces on nodes 1 to 3 in its columns.
template <class Force>
Field assembled(const Model& model, const Field& u, Force&& force) {
    Field result(u.size(), Vec::Zero());
    for (const Element& element : model.elements) {
        const Mat f = deformation_gradient(model, element, u);
        const Mat corners =
            force(element, f, svd_rotation(f)) * edges_of(element, model.rest_m).inverse().transpose();
        for (int k = 0; k < 3; ++k) {
            result[element.nodes[static_cast<std::size_t>(k) + 1]] += corners.col(k);
            result[element.nodes[0]] -= corners.col(k);
        }
    }
    return result;
}

inline Field expected_forces(const Model& model, const Field& u) {
    return assembled(model, u, [](const Element& element, const Mat& f, const Mat& r) -> Mat {
        return -2 * element.mu_volume * (f - r) -
               element.lambda_volume * ((r.transpose() * f).trace() - 3) * r;
    });
}

/// K(R) p with the rotations at u: linear elasticity in every tetrahedron's own frame.
inline Field expected_product(const Model& model, const Field& u, const Field& p) {
    return assembled(model, u, [&](const Element& element, const Mat&, const Mat& r) -> Mat {
        const Mat h = r.transpose() * edges_of(element, p) * edges_of(element, model.rest_m).inverse();
        return r * (element.mu_volume * (h + h.transpose()) +
                    element.lambda_volume * h.trace() * Mat::Identity());
    });
}

/// Whatever the size of the displacements.
inline Field expected_small_forces(const Model& model, const Field& u) {
    if (largest(u) > kLinearBelow_m) return expected_forces(model, u);
    Field result = expected_product(model, Field(u.size(), Vec::Zero()), u);
    for (Vec& force : result)
        force = -force;
    return result;
}

}  // namespace knead::core
