// SPDX-License-Identifier: GPL-3.0-or-later
#include "aggregate/interest.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace knead::tools {
namespace {

Point difference(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Eigen::Vector3d vector(const Point& a) {
    return {a[0], a[1], a[2]};
}

}  // namespace

Interest::Interest(InterestKind kind, double weight, const TetMesh& mesh, const ClusterShape& cluster)
    : kind_(kind),
      weight_(weight),
      centre_m_(cluster.barycentre_m),
      radius_m_(std::cbrt(0.75 * cluster.volume_m3 / std::numbers::pi)) {
    if (kind == InterestKind::combined || kind == InterestKind::direction) measure_directions(mesh, cluster);
    if (kind == InterestKind::mahalanobis) measure_ellipsoid(mesh, cluster);
}

void Interest::measure_directions(const TetMesh& mesh, const ClusterShape& cluster) {
    for (const std::uint32_t tetrahedron : cluster.tetrahedra)
        directions_.add(difference(barycentre_m(mesh, tetrahedron), centre_m_),
                        signed_volume_m3(mesh, tetrahedron));
    directions_.finish();
}

/// Covariance of the solid cluster about its barycentre: that of the tetrahedra's barycentres plus that of
/// each tetrahedron about its own (1/20 of the sum over its corners), which keeps it regular for a single
/// one.
void Interest::measure_ellipsoid(const TetMesh& mesh, const ClusterShape& cluster) {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const std::uint32_t tetrahedron : cluster.tetrahedra) {
        const Point centre = barycentre_m(mesh, tetrahedron);
        const Eigen::Vector3d offset = vector(difference(centre, centre_m_));
        Eigen::Matrix3d moment = offset * offset.transpose();
        for (const std::uint32_t node : mesh.tetrahedra[tetrahedron]) {
            const Eigen::Vector3d arm = vector(difference(mesh.nodes_m[node], centre));
            moment += arm * arm.transpose() / 20.0;
        }
        covariance += signed_volume_m3(mesh, tetrahedron) * moment;
    }
    inverse_covariance_ = (covariance / cluster.volume_m3).inverse();
}

double Interest::operator()(const Point& barycentre_m, bool member) const {
    const Point offset = difference(barycentre_m, centre_m_);
    const double distance = std::hypot(offset[0], offset[1], offset[2]) / radius_m_;
    switch (kind_) {
        case InterestKind::combined:
            return distance + weight_ * (1.0 - directions_.relative(offset));
        case InterestKind::distance:
            return distance;
        case InterestKind::direction:
            return 1.0 - directions_.relative(offset);
        case InterestKind::membership:
            return distance + (member ? 0.0 : weight_);
        case InterestKind::mahalanobis: {
            const Eigen::Vector3d arm = vector(offset);
            return std::sqrt(arm.dot(inverse_covariance_ * arm));
        }
    }
    return distance;
}

}  // namespace knead::tools
