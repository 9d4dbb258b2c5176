// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// Finds the tetrahedron of a mesh whose barycentre is nearest to a point; ties: the lower index.
/// The barycentres are sorted along x and searched outwards, which is enough for the few tetrahedra that an
/// overlap leaves uncovered.
class NearestBarycentre {
  public:
    explicit NearestBarycentre(const TetMesh& mesh);
    [[nodiscard]] std::uint32_t operator()(const Point& point) const;

  private:
    struct Entry {
        Point barycentre;
        std::uint32_t tetrahedron;
    };
    std::vector<Entry> entries_;  ///< by x, then index
};

}  // namespace knead::tools
