// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/numerical_coarsening.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "common/error.h"
#include "evaluate/methods.h"
#include "reference/free_system.h"

namespace knead::tools {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr std::array<std::array<int, 2>, 6> kAxes{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
/// Coarse strains whose reciprocal condition is below this leave a direction open.
constexpr double kSmallestCondition = 1e-4;

Eigen::Vector3d place(const TetMesh& mesh, std::uint32_t node) {
    const Point& p = mesh.nodes_m[node];
    return {p[0], p[1], p[2]};
}

Eigen::Matrix3d unit_stress(int mode) {
    const auto& [i, j] = kAxes[static_cast<std::size_t>(mode)];
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    stress(i, j) = stress(j, i) = 1;
    return stress;
}

/// Six unknowns that keep a body from moving as a whole, without forces when the load is in balance: of three
/// nodes far apart the first in all axes, the second across the line to it, the third across their plane. The
/// axes are those in which the lines have the least share.
std::vector<bool> pins(const TetMesh& mesh) {
    std::uint32_t second = 0;
    std::uint32_t third = 0;
    const Eigen::Vector3d origin = place(mesh, 0);
    double farthest = 0;
    for (std::uint32_t n = 1; n < mesh.nodes_m.size(); ++n)
        if (const double d = (place(mesh, n) - origin).norm(); d > farthest) {
            farthest = d;
            second = n;
        }
    const Eigen::Vector3d line = (place(mesh, second) - origin).normalized();
    double widest = 0;
    for (std::uint32_t n = 1; n < mesh.nodes_m.size(); ++n)
        if (const double d = line.cross(place(mesh, n) - origin).norm(); d > widest) {
            widest = d;
            third = n;
        }
    int along = 0;
    line.cwiseAbs().maxCoeff(&along);
    int across = 0;
    line.cross(place(mesh, third) - origin).cwiseAbs().maxCoeff(&across);
    std::vector<bool> pinned(3 * mesh.nodes_m.size(), false);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        pinned[axis] = true;
        if (axis != static_cast<std::size_t>(along)) pinned[3 * std::size_t{second} + axis] = true;
    }
    pinned[3 * std::size_t{third} + static_cast<std::size_t>(across)] = true;
    return pinned;
}

std::vector<TetrahedronShape> shapes_of(const TetMesh& mesh) {
    std::vector<TetrahedronShape> shapes;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        shapes.push_back(shape_of(mesh, t));
    return shapes;
}

Matrix6d strains_in(const TetrahedronShape& shape, const Tetrahedron& nodes,
                    const std::vector<std::vector<Point>>& modes) {
    Matrix6d strains;
    for (int mode = 0; mode < 6; ++mode)
        strains.col(mode) = strain_in(shape, nodes, modes[static_cast<std::size_t>(mode)]);
    return strains;
}

/// 2 x energy density between every two modes, in each fine tetrahedron.
std::vector<ElasticityTensor> fine_energies(const MaterialObject& fine,
                                            const std::vector<std::vector<Point>>& modes) {
    std::vector<ElasticityTensor> energies;
    for (std::size_t t = 0; t < fine.mesh.tetrahedra.size(); ++t) {
        const Matrix6d strains = strains_in(shape_of(fine.mesh, t), fine.mesh.tetrahedra[t], modes);
        energies.emplace_back(
            strains.transpose() *
            isotropic_tensor(fine.material.youngs_modulus_pa[t], fine.material.poissons_ratio[t]) * strains);
    }
    return energies;
}

}  // namespace

TetrahedronShape shape_of(const TetMesh& mesh, std::size_t tetrahedron) {
    const Tetrahedron& nodes = mesh.tetrahedra[tetrahedron];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = place(mesh, nodes[static_cast<std::size_t>(k + 1)]) - place(mesh, nodes[0]);
    TetrahedronShape shape;
    shape.volume_m3 = edges.determinant() / 6;
    shape.gradients_per_m.rightCols<3>() = edges.inverse().transpose();
    shape.gradients_per_m.col(0) = -shape.gradients_per_m.rightCols<3>().rowwise().sum();
    return shape;
}

VoigtVector strain_in(const TetrahedronShape& shape, const Tetrahedron& nodes,
                      const std::vector<Point>& displacement_m) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int a = 0; a < 4; ++a) {
        const Point& u = displacement_m[nodes[static_cast<std::size_t>(a)]];
        gradient += Eigen::Vector3d(u[0], u[1], u[2]) * shape.gradients_per_m.col(a).transpose();
    }
    VoigtVector strain;
    for (int k = 0; k < 6; ++k) {
        const auto& [i, j] = kAxes[static_cast<std::size_t>(k)];
        strain[k] = i == j ? gradient(i, i) : gradient(i, j) + gradient(j, i);
    }
    return strain;
}

std::vector<std::vector<Point>> traction_modes(const MaterialObject& object) {
    const TetMesh& mesh = object.mesh;
    const ElasticBody body(mesh, object.material);
    FreeSystem system(body, pins(mesh));
    if (!system.factorise(body.rest_positions_m(), Curvature::rotation_frozen, {}))
        fail_result("numerical coarsening: the object is not of one piece, so it cannot be pulled as one");
    const std::vector<TetrahedronShape> shapes = shapes_of(mesh);
    std::vector<std::vector<Point>> modes;
    for (int mode = 0; mode < 6; ++mode) {
        Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.nodes_m.size()));
        for (std::size_t t = 0; t < shapes.size(); ++t) {
            const Eigen::Matrix<double, 3, 4> nodal =
                shapes[t].volume_m3 * unit_stress(mode) * shapes[t].gradients_per_m;
            for (int a = 0; a < 4; ++a)
                force.segment<3>(first_unknown(mesh.tetrahedra[t][static_cast<std::size_t>(a)])) +=
                    nodal.col(a);
        }
        const Eigen::VectorXd moved = system.solve(force);
        std::vector<Point> displacement(mesh.nodes_m.size());
        for (std::size_t n = 0; n < displacement.size(); ++n)
            for (std::size_t axis = 0; axis < 3; ++axis)
                displacement[n][axis] = moved[static_cast<Eigen::Index>(3 * n + axis)];
        modes.push_back(std::move(displacement));
    }
    return modes;
}

CoarsenedTensors coarsen_numerically(const MaterialObject& fine, const LevelMesh& level) {
    CoarsenedTensors result;
    const Material average = mean_material(MethodKind::voigt, fine, level);
    for (std::size_t t = 0; t < level.mesh.tetrahedra.size(); ++t)
        result.tensors.push_back(isotropic_tensor(average.youngs_modulus_pa[t], average.poissons_ratio[t]));
    if (level.is_fine) return result;
    const std::vector<std::vector<Point>> modes = traction_modes(fine);
    const std::vector<ElasticityTensor> energies = fine_energies(fine, modes);
    const std::vector<Interpolated> places = interpolate(level.mesh.nodes_m, fine.mesh);
    std::vector<std::vector<Point>> coarse_modes;
    for (const std::vector<Point>& mode : modes)
        coarse_modes.push_back(values_at(places, mode));
    const OverlapMatrix& overlap = level.overlap;
    for (std::size_t row = 0; row < result.tensors.size(); ++row) {
        Matrix6d energy = Matrix6d::Zero();
        double volume = 0;
        for (std::uint64_t k = overlap.row_offsets[row]; k < overlap.row_offsets[row + 1]; ++k) {
            energy += overlap.volumes_m3[k] * energies[overlap.columns[k]];
            volume += overlap.volumes_m3[k];
        }
        const Matrix6d strains =
            strains_in(shape_of(level.mesh, row), level.mesh.tetrahedra[row], coarse_modes);
        const Eigen::PartialPivLU<Matrix6d> factor(strains);
        if (!(volume > 0) || !(factor.rcond() > kSmallestCondition)) {
            ++result.replaced;
            continue;
        }
        const Matrix6d inverse = factor.inverse();
        const Matrix6d tensor = inverse.transpose() * (energy / volume) * inverse;
        result.tensors[row] = (tensor + tensor.transpose()) / 2;
    }
    return result;
}

}  // namespace knead::tools
