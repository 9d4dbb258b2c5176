// SPDX-License-Identifier: Apache-2.0
#include "reference/elastic_body.h"

#include <gtest/gtest.h>

#include <random>

#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

constexpr double kStepM = 1e-7;      // one millionth of the cube's side
constexpr double kTolerance = 1e-6;  // relative: rounding of the energy over the step
constexpr double kYoungsModulusPa = 1e4;

double uniform(std::mt19937_64& bits) {
    return static_cast<double>(bits() >> 11) * 0x1p-52 - 1;
}

/// Two cells a side, every node shifted by up to 0.4 of a cell: some tetrahedra are inside out.
struct Tangle {
    TetMesh mesh = test::kuhn_cube(2);
    Material material = test::uniform_material(mesh, kYoungsModulusPa, 0.4);
    Eigen::VectorXd positions;

    Tangle() {
        std::mt19937_64 bits(13);
        for (double& e : material.youngs_modulus_pa)
            e *= 1 + 0.5 * uniform(bits);
        positions = ElasticBody(mesh, material).rest_positions_m();
        for (double& x : positions)
            x += 0.02 * uniform(bits);
    }
};

TEST(ElasticBody, Gradient_of_a_tangled_body_is_the_energy_s_by_finite_differences) {
    Tangle tangle;
    const ElasticBody body(tangle.mesh, tangle.material);
    const Eigen::VectorXd gradient = body.gradient_n(tangle.positions);
    for (Eigen::Index k = 0; k < gradient.size(); ++k) {
        Eigen::VectorXd above = tangle.positions;
        Eigen::VectorXd below = tangle.positions;
        above[k] += kStepM;
        below[k] -= kStepM;
        const double slope = (body.energy_j(above) - body.energy_j(below)) / (2 * kStepM);
        EXPECT_NEAR(gradient[k], slope, kTolerance * gradient.lpNorm<Eigen::Infinity>());
    }
}

TEST(ElasticBody, Stiffness_of_tetrahedra_sums_to_the_gradient_s_derivative_by_finite_differences) {
    Tangle tangle;
    const ElasticBody body(tangle.mesh, tangle.material);
    const Eigen::Index size = tangle.positions.size();
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t t = 0; t < body.tetrahedron_count(); ++t) {
        const Matrix12d local = body.stiffness_n_per_m(t, tangle.positions, Curvature::exact);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                hessian.block<3, 3>(3 * body.nodes_of(t)[a], 3 * body.nodes_of(t)[b]) +=
                    local.block<3, 3>(3 * a, 3 * b);
    }
    for (Eigen::Index k = 0; k < size; ++k) {
        Eigen::VectorXd above = tangle.positions;
        Eigen::VectorXd below = tangle.positions;
        above[k] += kStepM;
        below[k] -= kStepM;
        const Eigen::VectorXd slope = (body.gradient_n(above) - body.gradient_n(below)) / (2 * kStepM);
        EXPECT_LT((hessian.col(k) - slope).norm(), kTolerance * hessian.norm()) << k;
    }
}

TEST(ElasticBody, Rest_state_has_no_energy_and_no_force) {
    Tangle tangle;
    const ElasticBody body(tangle.mesh, tangle.material);
    EXPECT_LT(body.gradient_n(body.rest_positions_m()).lpNorm<Eigen::Infinity>(), body.rounding_noise_n());
}

TEST(ElasticBody, Lumped_mass_sums_to_density_times_volume) {
    Tangle tangle;
    const ElasticBody body(tangle.mesh, tangle.material);
    EXPECT_NEAR(body.lumped_mass_kg().sum(), 1.0, 1e-12);  // 1000 kg/m^3, a cube of 0.1 m
}

}  // namespace
}  // namespace knead::tools
