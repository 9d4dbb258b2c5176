// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "aggregate/direction_density.h"
#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// What draws the growth of a cluster to a tetrahedron. The lowest value is taken first.
/// d: distance of the barycentres; R: radius of the ball of the cluster's volume; w: the weight.
enum class InterestKind : std::uint8_t {
    combined,     ///< d/R + w (1 - D/Dmax), D the density of the cluster's tetrahedra in that direction
    distance,     ///< d/R
    direction,    ///< 1 - D/Dmax; equal values: the nearer first
    membership,   ///< d/R + w for tetrahedra that were not in the cluster
    mahalanobis,  ///< distance measured with the covariance of the cluster: the shape of its ellipsoid
};

/// One cluster as the clustering left it.
struct ClusterShape {
    Point barycentre_m{};
    double volume_m3 = 0;
    std::vector<std::uint32_t> tetrahedra;  ///< increasing
};

/// The measure of interest of one cluster. Source: paper section 3.2, "Aggregation"; the weights and the
/// form of the direction term are ours (docs/method.md).
class Interest {
  public:
    Interest(InterestKind kind, double weight, const TetMesh& mesh, const ClusterShape& cluster);

    /// @param member the tetrahedron was in the cluster
    [[nodiscard]] double operator()(const Point& barycentre_m, bool member) const;

  private:
    void measure_directions(const TetMesh& mesh, const ClusterShape& cluster);
    void measure_ellipsoid(const TetMesh& mesh, const ClusterShape& cluster);

    InterestKind kind_;
    double weight_;
    Point centre_m_;
    double radius_m_;
    DirectionDensity directions_;                                   ///< combined and direction only
    Eigen::Matrix3d inverse_covariance_ = Eigen::Matrix3d::Zero();  ///< mahalanobis only
};

}  // namespace knead::tools
