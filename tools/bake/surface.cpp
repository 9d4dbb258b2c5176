// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/surface.h"

#include <algorithm>
#include <tuple>

namespace knead::tools {
namespace {

/// Corners of the face opposite to each corner of a positively oriented tetrahedron, seen from outside.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct Face {
    Triangle sorted;
    Triangle corners;
    std::size_t place;  // 4 * tetrahedron + face
};

}  // namespace

std::vector<Triangle> boundary_triangles(const std::vector<Tetrahedron>& tetrahedra) {
    std::vector<Face> faces;
    faces.reserve(tetrahedra.size() * 4);
    for (const Tetrahedron& t : tetrahedra) {
        for (const auto& f : kFaces) {
            const Triangle corners{t[f[0]], t[f[1]], t[f[2]]};
            Triangle sorted = corners;
            std::sort(sorted.begin(), sorted.end());
            faces.push_back({sorted, corners, faces.size()});
        }
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return std::tie(a.sorted, a.place) < std::tie(b.sorted, b.place);
    });
    std::vector<Face> lonely;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].sorted == faces[i].sorted)
            ++end;
        if (end == i + 1) lonely.push_back(faces[i]);
        i = end;
    }
    std::sort(lonely.begin(), lonely.end(), [](const Face& a, const Face& b) { return a.place < b.place; });
    std::vector<Triangle> triangles;
    triangles.reserve(lonely.size());
    for (const Face& face : lonely)
        triangles.push_back(face.corners);
    return triangles;
}

}  // namespace knead::tools
