// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/contact_problem.h"
#include "reference/plate_press.h"
#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools::contact_test {

inline constexpr double kYoungsModulusPa = 22000;
inline constexpr double kSideM = 0.1;
inline constexpr double kDtS = 0.002;
inline constexpr double kTolerance = 1e-9;  // Newton's residual of 1e-10, with room for sums
inline constexpr double kBalance = 1e-10;   // relative: forces are sums of a few hundred nodal ones

inline Eigen::Vector3d vec(const Point& p) {
    return {p[0], p[1], p[2]};
}

/// A cube that stands on held nodes, with two materials in turn, and its upper nodes.
struct Scene {
    explicit Scene(std::uint32_t cells, bool heterogeneous = true, double nu = 0.3)
        : mesh(test::kuhn_cube(cells)), material(test::uniform_material(mesh, kYoungsModulusPa, nu)) {
        if (heterogeneous)
            for (std::size_t t = 0; t < mesh.tetrahedra.size(); t += 3)
                material.youngs_modulus_pa[t] = 5000;
        const PlatePress press = plate_press(mesh, 0.1);
        held.nodes = press.held_nodes;
        held.displacement_m.assign(held.nodes.size(), Point{});
        top = press.plate_nodes;
    }
    [[nodiscard]] ContactTool plate(ToolContact law, double depth_m, double x_m = kSideM / 2) const {
        ContactTool tool;
        tool.law = law;
        tool.friction_coefficient = 0.4;
        tool.nodes = top;
        tool.pose.position_m = {x_m, kSideM / 2, kSideM - depth_m};
        tool.pose_before = tool.pose;
        return tool;
    }
    [[nodiscard]] ContactTool ball(ToolContact law, double depth_m, double x_m = kSideM / 2) const {
        ContactTool tool = plate(law, depth_m, x_m);
        tool.shape = ToolShape::sphere;
        tool.radius_m = 0.04;
        tool.pose.position_m[2] += tool.radius_m;
        return tool;
    }

    TetMesh mesh;
    Material material;
    PrescribedMotion held;
    std::vector<std::uint32_t> top;
};

}  // namespace knead::tools::contact_test
