// SPDX-License-Identifier: Apache-2.0
#include "evaluate/methods.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "evaluate/calibration.h"
#include "evaluate/loads.h"
#include "evaluate/numerical_coarsening.h"
#include "evaluate/region_adapted.h"
#include "evaluate/scene_object.h"
#include "material/scenario.h"
#include "reference/static_problem.h"
#include "reference/tensor_point.h"
#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

constexpr double kPa = 22000;
constexpr double kNu = 0.3;
// Sums over shared volumes that are exact to 1e-12 of the smaller tetrahedron.
constexpr double kMeanTolerance = 1e-10;
// A direct solve on a well-conditioned matrix, strains from differences of positions.
constexpr double kTensorTolerance = 1e-8;

MaterialObject uniform_object(std::uint32_t cells) {
    MaterialObject object{test::kuhn_cube(cells), {}};
    object.material = test::uniform_material(object.mesh, kPa, kNu);
    return object;
}

MaterialObject scenario_object(std::uint32_t cells, int scenario) {
    MaterialObject object{test::kuhn_cube(cells), {}};
    object.material = scenario_material(object.mesh, scenario, 1, kNu, 1000);
    return object;
}

LevelMesh level_of(const MaterialObject& fine, std::uint32_t cells) {
    return make_level_mesh(fine.mesh, test::kuhn_cube(cells), false);
}

std::vector<bool> held_bottom(const TetMesh& mesh) {
    std::vector<bool> held;
    for (const Point& node : mesh.nodes_m)
        held.push_back(node[2] == 0);
    return held;
}

class SimpleMethod : public testing::TestWithParam<MethodKind> {};

TEST_P(SimpleMethod, Homogeneous_object_keeps_its_elasticity) {
    const MaterialObject fine = uniform_object(5);
    const LevelMesh level = level_of(fine, 3);
    const Material coarse = simple_material({GetParam(), 2, 3}, fine, level, 1);
    ASSERT_EQ(coarse.youngs_modulus_pa.size(), level.mesh.tetrahedra.size());
    for (std::size_t t = 0; t < coarse.youngs_modulus_pa.size(); ++t) {
        EXPECT_NEAR(coarse.youngs_modulus_pa[t], kPa, kMeanTolerance * kPa);
        EXPECT_NEAR(coarse.poissons_ratio[t], kNu, kMeanTolerance);
    }
}

INSTANTIATE_TEST_SUITE_P(All, SimpleMethod,
                         testing::Values(MethodKind::homogenised, MethodKind::paper, MethodKind::raw_dominant,
                                         MethodKind::voigt, MethodKind::reuss, MethodKind::geometric,
                                         MethodKind::hill));

/// One coarse tetrahedron over eight fine ones of the same volume, four of 1 kPa and four of 9 kPa:
/// arithmetic mean 5, harmonic 1.8, geometric 3, the middle of the first two 3.4.
TEST(Means, Half_and_half_of_one_and_nine_give_the_means_computed_by_hand) {
    MaterialObject whole;
    whole.mesh.nodes_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    whole.mesh.tetrahedra = {{0, 1, 2, 3}};
    whole.material = test::uniform_material(whole.mesh, 1000, kNu);
    MaterialObject fine = split_in_eight(whole);
    for (std::size_t t = 0; t < 8; t += 2)
        fine.material.youngs_modulus_pa[t] = 9000;
    const LevelMesh level = make_level_mesh(fine.mesh, whole.mesh, false);
    const auto mean = [&](MethodKind kind) { return mean_material(kind, fine, level).youngs_modulus_pa[0]; };
    EXPECT_NEAR(mean(MethodKind::voigt), 5000, 5000 * kMeanTolerance);
    EXPECT_NEAR(mean(MethodKind::reuss), 1800, 1800 * kMeanTolerance);
    EXPECT_NEAR(mean(MethodKind::geometric), 3000, 3000 * kMeanTolerance);
    EXPECT_NEAR(mean(MethodKind::hill), 3400, 3400 * kMeanTolerance);
}

TEST(Means, Reuss_is_at_most_geometric_and_hill_which_are_at_most_voigt) {
    const MaterialObject fine = scenario_object(5, 9);
    const LevelMesh level = level_of(fine, 3);
    const Material voigt = mean_material(MethodKind::voigt, fine, level);
    const Material reuss = mean_material(MethodKind::reuss, fine, level);
    const Material geometric = mean_material(MethodKind::geometric, fine, level);
    const Material hill = mean_material(MethodKind::hill, fine, level);
    for (std::size_t t = 0; t < voigt.youngs_modulus_pa.size(); ++t) {
        EXPECT_LT(reuss.youngs_modulus_pa[t], geometric.youngs_modulus_pa[t]);
        EXPECT_LT(geometric.youngs_modulus_pa[t], voigt.youngs_modulus_pa[t]);
        EXPECT_LT(reuss.youngs_modulus_pa[t], hill.youngs_modulus_pa[t]);
        EXPECT_LT(hill.youngs_modulus_pa[t], voigt.youngs_modulus_pa[t]);
    }
}

TEST(Methods, Paper_with_two_bins_leaves_two_elasticities) {
    const MaterialObject fine = scenario_object(5, 1);
    const Material coarse = simple_material({MethodKind::paper, 2, 3}, fine, level_of(fine, 3), 1);
    std::vector<double> values = coarse.youngs_modulus_pa;
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    EXPECT_EQ(values.size(), 2u);
}

TEST(Methods, Fine_mesh_as_a_level_keeps_the_raw_elasticities) {
    const MaterialObject fine = scenario_object(3, 1);
    const LevelMesh level = make_level_mesh(fine.mesh, fine.mesh, true);
    for (const MethodKind kind : {MethodKind::raw_dominant, MethodKind::voigt, MethodKind::reuss})
        EXPECT_EQ(simple_material({kind, 0, 0}, fine, level, 1).youngs_modulus_pa,
                  fine.material.youngs_modulus_pa);
}

TEST(SplitInEight, Volume_of_every_child_is_an_eighth_and_elasticity_its_parents) {
    const MaterialObject coarse = scenario_object(3, 1);
    const MaterialObject fine = split_in_eight(coarse);
    ASSERT_EQ(fine.mesh.tetrahedra.size(), 8 * coarse.mesh.tetrahedra.size());
    EXPECT_TRUE(validate(fine.mesh).ok());
    EXPECT_EQ(fine.mesh.nodes_m.size(), 343u);  // the nodes of the cube of six cells
    for (std::size_t t = 0; t < fine.mesh.tetrahedra.size(); ++t) {
        const double parent_m3 = signed_volume_m3(coarse.mesh, t / 8);
        EXPECT_NEAR(signed_volume_m3(fine.mesh, t), parent_m3 / 8, 1e-12 * parent_m3);
        EXPECT_EQ(fine.material.youngs_modulus_pa[t], coarse.material.youngs_modulus_pa[t / 8]);
    }
}

TEST(NumericalCoarsening, Homogeneous_object_gives_the_isotropic_tensor_everywhere) {
    const MaterialObject fine = uniform_object(4);
    const CoarsenedTensors coarse = coarsen_numerically(fine, level_of(fine, 3));
    EXPECT_EQ(coarse.replaced, 0u);
    const ElasticityTensor expected = isotropic_tensor(kPa, kNu);
    for (const ElasticityTensor& tensor : coarse.tensors)
        EXPECT_LT((tensor - expected).cwiseAbs().maxCoeff(), kTensorTolerance * expected.maxCoeff());
}

TEST(NumericalCoarsening, Unit_traction_on_a_homogeneous_object_strains_it_by_hookes_law) {
    const MaterialObject fine = uniform_object(3);
    const auto modes = traction_modes(fine);
    for (std::size_t t = 0; t < fine.mesh.tetrahedra.size(); ++t) {
        const VoigtVector pulled = strain_in(shape_of(fine.mesh, t), fine.mesh.tetrahedra[t], modes[2]);
        EXPECT_NEAR(pulled[2], 1 / kPa, kTensorTolerance / kPa);
        EXPECT_NEAR(pulled[0], -kNu / kPa, kTensorTolerance / kPa);
        const VoigtVector sheared = strain_in(shape_of(fine.mesh, t), fine.mesh.tetrahedra[t], modes[3]);
        EXPECT_NEAR(sheared[3], 2 * (1 + kNu) / kPa, kTensorTolerance / kPa);
    }
}

/// Layers in series along z carry one stress: the fine object stores V (mean of 1 / E), and so must the
/// coarse one in the strains that its nodes see.
TEST(NumericalCoarsening, Layers_under_traction_store_in_the_coarse_mesh_what_springs_in_series_store) {
    MaterialObject fine = uniform_object(4);
    for (std::size_t t = 0; t < fine.mesh.tetrahedra.size(); ++t) {
        fine.material.poissons_ratio[t] = 0;  // no layer holds its neighbour back sideways
        const bool stiff = static_cast<int>(barycentre_m(fine.mesh, t)[2] / 0.025) % 2 == 1;
        fine.material.youngs_modulus_pa[t] = stiff ? 9000 : 1000;
    }
    const LevelMesh level = level_of(fine, 3);
    const CoarsenedTensors coarse = coarsen_numerically(fine, level);
    EXPECT_EQ(coarse.replaced, 0u);
    const auto pulled = values_at(interpolate(level.mesh.nodes_m, fine.mesh), traction_modes(fine)[2]);
    double twice_energy = 0;
    for (std::size_t t = 0; t < level.mesh.tetrahedra.size(); ++t) {
        const VoigtVector strain = strain_in(shape_of(level.mesh, t), level.mesh.tetrahedra[t], pulled);
        twice_energy += signed_volume_m3(level.mesh, t) * strain.dot(coarse.tensors[t] * strain);
    }
    constexpr double kExpected = 1e-3 / 1800;  // a litre; the harmonic mean of 1 and 9 kPa
    EXPECT_NEAR(twice_energy, kExpected, 1e-8 * kExpected);
}

/// An oracle that knows only the energy: central differences of it.
TEST(TensorBody, Stress_of_any_tensor_is_the_derivative_of_the_energy) {
    ElasticityTensor tensor = ElasticityTensor::Zero();
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            tensor(i, j) = std::sin(1.0 + i * j) + std::sin(1.0 + j * i) + (i == j ? 20 : 0);
    Eigen::Matrix3d gradient;
    gradient << 0.8, 0.3, -0.1, -0.2, 1.2, 0.25, 0.15, -0.3, 0.9;
    const Eigen::Matrix3d stress = TensorPoint(gradient, tensor).stress_pa();
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            Eigen::Matrix3d more = gradient;
            Eigen::Matrix3d less = gradient;
            more(i, k) += kStep;
            less(i, k) -= kStep;
            const double slope = (TensorPoint(more, tensor).energy_density_j_per_m3() -
                                  TensorPoint(less, tensor).energy_density_j_per_m3()) /
                                 (2 * kStep);
            EXPECT_NEAR(stress(i, k), slope, 1e-7);  // rounding of the energy over the step
        }
}

TEST(TensorBody, Isotropic_tensors_give_the_equilibrium_of_the_material) {
    const MaterialObject object = scenario_object(3, 1);
    std::vector<ElasticityTensor> tensors;
    for (std::size_t t = 0; t < object.mesh.tetrahedra.size(); ++t)
        tensors.push_back(isotropic_tensor(object.material.youngs_modulus_pa[t], kNu));
    PrescribedMotion motion;
    for (std::uint32_t n = 0; n < object.mesh.nodes_m.size(); ++n) {
        const double z = object.mesh.nodes_m[n][2];
        if (z > 0 && z < 0.0999) continue;
        motion.nodes.push_back(n);
        motion.displacement_m.push_back(z > 0 ? Point{0.01, 0, -0.01} : Point{});
    }
    const StaticSolution expected = StaticProblem(object.mesh, object.material).solve(motion);
    const StaticSolution found = StaticProblem(object.mesh, object.material, tensors).solve(motion);
    EXPECT_NEAR(found.energy_j, expected.energy_j, 1e-8 * expected.energy_j);
    for (std::size_t n = 0; n < expected.positions_m.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(found.positions_m[n][axis], expected.positions_m[n][axis], 1e-9);
}

TEST(RegionAdapted, Profile_that_steps_is_cut_where_it_steps) {
    const std::vector<double> profile{0, 0, 0, 1, 1, 1, 1, 1, 1, 1};
    const std::vector<double> borders = cut_profile(profile, 2);
    EXPECT_EQ(borders, (std::vector<double>{0, 0.3, 1}));
}

TEST(RegionAdapted, Even_profile_is_cut_into_equal_parts) {
    const std::vector<double> borders = cut_profile(std::vector<double>(10, 5.0), 6);
    for (std::size_t k = 0; k < borders.size(); ++k)
        EXPECT_NEAR(borders[k], static_cast<double>(k) / 6, 1e-12);
}

TEST(Calibration, Homogeneous_object_on_its_own_mesh_stays_as_it_is) {
    const MaterialObject fine = uniform_object(3);
    LevelMesh level = make_level_mesh(fine.mesh, fine.mesh, false);
    const auto held = held_bottom(fine.mesh);
    const Calibration found = calibrate(fine, held, level, held);
    for (const double modulus : found.material.youngs_modulus_pa)
        EXPECT_NEAR(modulus, kPa, 1e-6 * kPa);
}

/// Those of the fit's pads that the mesh can be asked for.
std::vector<Load> pads_for(const TetMesh& mesh) {
    const std::vector<Load> all = probe_pads(bounding_box(mesh.nodes_m));
    const std::vector<bool> askable = askable_pads(all, mesh, held_bottom(mesh));
    std::vector<Load> pads;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (askable[k]) pads.push_back(all[k]);
    return pads;
}

/// The oracle ties the surface by elimination and solves each pad alone; the probes solve for the forces of
/// the bond from the responses of a face.
TEST(Calibration, Answer_to_a_pad_is_the_force_that_the_same_load_is_felt_with) {
    const MaterialObject object = scenario_object(3, 1);
    const std::vector<bool> held = held_bottom(object.mesh);
    const std::vector<Load> pads = pads_for(object.mesh);
    const Probes probes(object.mesh, held, bounding_box(object.mesh.nodes_m), pads);
    const Probes::Answers answers = probes.ask(object.material, false);
    StaticProblem problem(object.mesh, object.material);
    ASSERT_EQ(answers.values_j.size(), 6 + pads.size());
    for (std::size_t k = 0; k < pads.size(); k += 17) {
        const AppliedLoad applied = apply_load(pads[k], object.mesh, held);
        const double force_n = felt_force_n(applied, problem.solve_linear(applied.motion));
        EXPECT_NEAR(answers.values_j[6 + k], force_n, 1e-8 * force_n) << k;  // two direct solves
    }
}

TEST(Calibration, Pads_of_the_fit_are_none_of_the_loads) {
    const Box box{{0, 0, 0}, {0.1, 0.1, 0.1}};
    for (const Load& pad : probe_pads(box))
        for (const char* name : {"pad4", "pad3", "tip2", "side"}) {
            const SurfaceRegion& load = named_load(name, box).region;
            const Point probe_size = pad.region.within.size_m();
            const Point load_size = load.within.size_m();
            bool same = pad.region.facing == load.facing;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (load.facing[axis] == 0 && std::abs(probe_size[axis] - load_size[axis]) > 1e-9)
                    same = false;
            EXPECT_FALSE(same) << name;
        }
}

TEST(Calibration, Shares_of_a_probe_are_the_derivative_of_its_answer) {
    MaterialObject object = scenario_object(3, 1);
    const Box box = bounding_box(object.mesh.nodes_m);
    const Probes probes(object.mesh, held_bottom(object.mesh), box, pads_for(object.mesh));
    const Probes::Answers answers = probes.ask(object.material, true);
    constexpr double kStep = 1e-4;
    constexpr std::size_t kTetrahedron = 100;
    object.material.youngs_modulus_pa[kTetrahedron] *= std::exp(kStep);
    const Probes::Answers stiffer = probes.ask(object.material, false);
    for (std::size_t k = 0; k < probes.count(); ++k)
        EXPECT_NEAR(std::log(stiffer.values_j[k] / answers.values_j[k]) / kStep,
                    answers.shares[k][kTetrahedron],
                    1e-5);  // one-sided difference: half of the step times a share
}

TEST(Calibration, Heterogeneous_object_answers_the_probes_better_than_the_volume_average) {
    const MaterialObject fine = scenario_object(6, 1);
    const LevelMesh level = level_of(fine, 4);
    const Calibration found = calibrate(fine, held_bottom(fine.mesh), level, held_bottom(level.mesh));
    // More pads than a coarse mesh can answer to: what is left is spread, not gone.
    EXPECT_LT(found.worst_after, 0.8 * found.worst_before);
}

}  // namespace
}  // namespace knead::tools
