// SPDX-License-Identifier: GPL-3.0-or-later
#include "coarsen/nearest.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace knead::tools {

NearestBarycentre::NearestBarycentre(const TetMesh& mesh) {
    entries_.reserve(mesh.tetrahedra.size());
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
        entries_.push_back({barycentre_m(mesh, t), t});
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.barycentre[0], a.tetrahedron) < std::tie(b.barycentre[0], b.tetrahedron);
    });
}

std::uint32_t NearestBarycentre::operator()(const Point& point) const {
    double best_squared = std::numeric_limits<double>::infinity();
    std::uint32_t best = UINT32_MAX;
    // Returns false when this entry, and so everything beyond it, is farther along x alone than the best.
    const auto look_at = [&](const Entry& entry) {
        const double x = entry.barycentre[0] - point[0];
        if (x * x > best_squared) return false;
        const double y = entry.barycentre[1] - point[1];
        const double z = entry.barycentre[2] - point[2];
        const double squared = x * x + y * y + z * z;
        if (std::tie(squared, entry.tetrahedron) < std::tie(best_squared, best)) {
            best_squared = squared;
            best = entry.tetrahedron;
        }
        return true;
    };
    const auto middle =
        std::lower_bound(entries_.begin(), entries_.end(), point[0],
                         [](const Entry& entry, double x) { return entry.barycentre[0] < x; });
    auto right = middle;
    auto left = middle;
    bool more_right = true;
    bool more_left = true;
    while (more_right || more_left) {
        more_right = more_right && right != entries_.end() && look_at(*right++);
        more_left = more_left && left != entries_.begin() && look_at(*--left);
    }
    return best;
}

}  // namespace knead::tools
