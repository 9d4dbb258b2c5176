// SPDX-License-Identifier: GPL-3.0-or-later
#include "aggregate/face_neighbours.h"

#include <algorithm>
#include <tuple>

namespace knead::tools {
namespace {

struct Face {
    std::array<std::uint32_t, 3> nodes;  ///< increasing
    std::uint32_t tetrahedron;
    std::uint32_t index;
};

}  // namespace

FaceNeighbours face_neighbours(const std::vector<Tetrahedron>& tetrahedra) {
    std::vector<Face> faces;
    faces.reserve(4 * tetrahedra.size());
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t)
        for (std::uint32_t face = 0; face < 4; ++face) {
            std::array<std::uint32_t, 3> nodes{};
            for (std::uint32_t node = 0, next = 0; node < 4; ++node)
                if (node != face) nodes[next++] = tetrahedra[t][node];
            std::sort(nodes.begin(), nodes.end());
            faces.push_back({nodes, t, face});
        }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return std::tie(a.nodes, a.tetrahedron) < std::tie(b.nodes, b.tetrahedron);
    });
    FaceNeighbours neighbours(tetrahedra.size(), {kNoNeighbour, kNoNeighbour, kNoNeighbour, kNoNeighbour});
    for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
        const Face& a = faces[i];
        const Face& b = faces[i + 1];
        if (a.nodes != b.nodes) continue;
        neighbours[a.tetrahedron][a.index] = b.tetrahedron;
        neighbours[b.tetrahedron][b.index] = a.tetrahedron;
        ++i;  // both are taken
    }
    return neighbours;
}

}  // namespace knead::tools
