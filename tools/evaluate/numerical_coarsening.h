// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "evaluate/level_mesh.h"
#include "knead/formats/material.h"
#include "reference/elasticity_tensor.h"

namespace knead::tools {

/// Shape function gradients of a tetrahedron, one column a node, and its volume.
struct TetrahedronShape {
    Eigen::Matrix<double, 3, 4> gradients_per_m;
    double volume_m3 = 0;
};
[[nodiscard]] TetrahedronShape shape_of(const TetMesh& mesh, std::size_t tetrahedron);

/// Strain of a displacement field in a tetrahedron.
[[nodiscard]] VoigtVector strain_in(const TetrahedronShape& shape, const Tetrahedron& nodes,
                                    const std::vector<Point>& displacement_m);

/// Where an unheld object goes under the six uniform tractions: stress k of the boundary is the k-th unit
/// stress (order as in ElasticityTensor). Small displacements, metres per pascal; [6][nodes].
[[nodiscard]] std::vector<std::vector<Point>> traction_modes(const MaterialObject& object);

struct CoarsenedTensors {
    std::vector<ElasticityTensor> tensors;  ///< [coarse tetrahedra]
    std::uint32_t replaced = 0;  ///< whose coarse strains do not span all strains: volume average instead
};

/// Numerical coarsening: the elasticity of each coarse tetrahedron with which it stores, under any
/// combination of the traction modes, what the fine object stores in its place. The coarse strains are those
/// of the modes at the coarse nodes. Source: L. Kharevych, P. Mullen, H. Owhadi, M. Desbrun: Numerical
/// coarsening of inhomogeneous elastic materials, ACM TOG 28(3), 2009, section 4.
[[nodiscard]] CoarsenedTensors coarsen_numerically(const MaterialObject& fine, const LevelMesh& level);

}  // namespace knead::tools
