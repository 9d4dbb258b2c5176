// SPDX-License-Identifier: Apache-2.0
#include "baseline/body.h"

#include <Eigen/Dense>

namespace knead::baseline {
namespace {

Eigen::Vector3d vector(const Point& p) {
    return {p[0], p[1], p[2]};
}

Eigen::Matrix3d rotation(const std::array<double, 4>& wxyz) {
    return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
}

Body::Element make_element(const Columns& rest_m, const Tetrahedron& nodes, const PaletteEntry& material) {
    Body::Element element;
    element.nodes = nodes;
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = rest_m.col(nodes[static_cast<std::size_t>(k) + 1]) - rest_m.col(nodes[0]);
    element.volume_m3 = edges.determinant() / 6;
    element.shape_gradients.rightCols<3>() = edges.inverse().transpose();
    element.shape_gradients.col(0) = -element.shape_gradients.rightCols<3>().rowwise().sum();
    const double e = material.youngs_modulus_pa;
    const double nu = material.poissons_ratio;
    element.mu_pa = e / (2 * (1 + nu));
    element.lambda_pa = e * nu / ((1 + nu) * (1 - 2 * nu));
    return element;
}

}  // namespace

State Body::at_rest() const {
    return {rest_m, Columns::Zero(3, rest_m.cols())};
}

Columns Body::predict(const State& from, const Pose& plate_pose, double dt_s) const {
    Columns predicted = rest_m;
    for (const std::uint32_t i : active)
        predicted.col(i) = from.positions_m.col(i) + dt_s * from.velocities_m_per_s.col(i);
    const Eigen::Matrix3d turn =
        rotation(plate_pose.orientation_wxyz) * rotation(plate_rest.orientation_wxyz).transpose();
    for (const std::uint32_t i : plate)
        predicted.col(i) =
            vector(plate_pose.position_m) + turn * (rest_m.col(i) - vector(plate_rest.position_m));
    return predicted;
}

Eigen::Matrix3d Body::deformation_gradient(const Element& element, const Columns& positions_m) const {
    Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
    const Eigen::Vector3d origin = positions_m.col(element.nodes[0]);
    for (int a = 1; a < 4; ++a)
        f += (positions_m.col(element.nodes[static_cast<std::size_t>(a)]) - origin) *
             element.shape_gradients.col(a).transpose();
    return f;
}

Body make_body(const Asset& asset) {
    Body body;
    body.free_count = asset.free_node_count;
    body.rest_m.resize(3, static_cast<Eigen::Index>(asset.nodes_m.size()));
    for (std::size_t i = 0; i < asset.nodes_m.size(); ++i)
        body.rest_m.col(static_cast<Eigen::Index>(i)) = vector(asset.nodes_m[i]);
    body.mass_kg = Eigen::VectorXd::Zero(body.rest_m.cols());
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        const PaletteEntry& material = asset.palette[asset.palette_index[t]];
        body.elements.push_back(make_element(body.rest_m, asset.tetrahedra[t], material));
        for (const std::uint32_t node : asset.tetrahedra[t])
            body.mass_kg[node] += material.density_kg_per_m3 * body.elements.back().volume_m3 / 4;
    }
    const ToolSet& tool = asset.tools.front();
    body.plate = tool.nodes;
    body.plate_rest = {tool.rest_position_m, tool.rest_orientation_wxyz};
    std::vector<bool> follows(asset.nodes_m.size(), false);
    for (const std::uint32_t node : body.plate)
        follows[node] = true;
    for (std::uint32_t i = 0; i < body.free_count; ++i)
        if (!follows[i]) body.active.push_back(i);
    body.gravity_m_per_s2 = vector(asset.gravity_m_per_s2);
    body.damping_per_s = asset.damping_per_s;
    return body;
}

}  // namespace knead::baseline
