// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// How much volume lies in each direction seen from a centre, smoothed over the sphere.
///
/// The sphere is cut into the cells of a cube map, the volume of each tetrahedron is added to the cell of its
/// direction, and the density at a cell's centre is the sum of all cells' volumes weighted by
/// exp(kappa (cos(angle) - 1)), which halves at about 30 degrees.
class DirectionDensity {
  public:
    DirectionDensity();

    /// Adds a volume in the direction of `offset_m`; an offset of zero has no direction and is left out.
    void add(const Point& offset_m, double volume_m3);
    /// Smooths what was added. Call once, after the last add().
    void finish();

    /// Density in a direction over the largest density, in [0, 1]. 1 where there is no direction, and
    /// everywhere if nothing was added. Precondition: finish() was called.
    [[nodiscard]] double relative(const Point& offset_m) const;

  private:
    std::vector<double> cell_;  ///< [cells] first volumes, then densities over the largest
};

}  // namespace knead::tools
