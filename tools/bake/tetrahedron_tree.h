// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// A tetrahedron near a point, and the point in terms of it.
struct NearTetrahedron {
    std::uint32_t tetrahedron = 0;
    std::array<double, 4> weights{};  ///< barycentric; outside of the tetrahedron some are negative
    double distance_m = 0;            ///< 0 inside
};

/// Finds the tetrahedra nearest to a point, by a tree of boxes. Keeps references to its arguments.
class NearestTetrahedra {
  public:
    NearestTetrahedra(const std::vector<Point>& nodes_m, const std::vector<Tetrahedron>& tetrahedra);

    /// Every tetrahedron at most `slack_m` farther from `point` than the nearest one, by index.
    [[nodiscard]] std::vector<NearTetrahedron> nearest(const Point& point, double slack_m) const;

    /// Longest edge of the bounding box.
    [[nodiscard]] double size_m() const { return branches_.front().box.sizes().maxCoeff(); }

  private:
    struct Branch {
        Eigen::AlignedBox3d box;
        std::uint32_t begin = 0;  ///< of its tetrahedra in order_
        std::uint32_t end = 0;
        std::uint32_t second = 0;  ///< branch of its second half; 0: a leaf. The first half stands behind it
    };
    struct Search;

    std::uint32_t grow(std::uint32_t begin, std::uint32_t end, const std::vector<Eigen::Vector3d>& centres);
    void descend(std::uint32_t branch, Search& search) const;
    [[nodiscard]] Eigen::Vector3d corner(std::uint32_t tetrahedron, int k) const;
    [[nodiscard]] NearTetrahedron locate(std::uint32_t tetrahedron, const Eigen::Vector3d& point) const;

    const std::vector<Point>& nodes_m_;
    const std::vector<Tetrahedron>& tetrahedra_;
    std::vector<std::uint32_t> order_;
    std::vector<Branch> branches_;
};

}  // namespace knead::tools
