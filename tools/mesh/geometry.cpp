// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry.h"

#include <cmath>
#include <limits>

#include "common/error.h"

namespace knead::tools {
namespace {

/// The six ways to walk from corner (0,0,0) to (1,1,1) one axis at a time. Odd permutations give left-handed
/// tetrahedra: their two middle nodes are swapped.
struct KuhnPath {
    std::array<int, 3> axes;
    bool even;
};
constexpr std::array<KuhnPath, 6> kKuhnPaths{{{{0, 1, 2}, true},
                                              {{0, 2, 1}, false},
                                              {{1, 0, 2}, false},
                                              {{1, 2, 0}, true},
                                              {{2, 0, 1}, true},
                                              {{2, 1, 0}, false}}};

void require_valid(const std::array<std::uint32_t, 3>& divisions, const std::array<double, 3>& size_m) {
    std::uint64_t nodes = 1;
    std::uint64_t cubes = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (divisions[axis] == 0) fail_usage("the number of divisions must be at least 1 along each axis");
        if (!std::isfinite(size_m[axis]) || size_m[axis] <= 0)
            fail_usage("the size must be finite and greater than 0 along each axis");
        // Bounded before each product, so that the products cannot wrap around.
        constexpr std::uint64_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();
        nodes *= std::uint64_t{divisions[axis]} + 1;
        cubes *= divisions[axis];
        if (nodes > kMaxIndex || 6 * cubes > kMaxIndex)
            fail_usage("so many divisions make more nodes or tetrahedra than a 32-bit index can name");
    }
}

std::vector<Point> make_nodes(const std::array<std::uint32_t, 3>& divisions,
                              const std::array<double, 3>& size_m) {
    // Each coordinate is computed from its own index, so that opposite faces are exactly 0 and the size.
    const auto coordinate = [&](int axis, std::uint32_t i) {
        return i == divisions[axis] ? size_m[axis] : size_m[axis] * i / divisions[axis];
    };
    std::vector<Point> nodes;
    nodes.reserve(std::size_t{divisions[0] + 1} * (divisions[1] + 1) * (divisions[2] + 1));
    for (std::uint32_t k = 0; k <= divisions[2]; ++k)
        for (std::uint32_t j = 0; j <= divisions[1]; ++j)
            for (std::uint32_t i = 0; i <= divisions[0]; ++i)
                nodes.push_back({coordinate(0, i), coordinate(1, j), coordinate(2, k)});
    return nodes;
}

}  // namespace

TetMesh make_cubes(const std::array<std::uint32_t, 3>& divisions, const std::array<double, 3>& size_m) {
    require_valid(divisions, size_m);
    TetMesh mesh;
    mesh.nodes_m = make_nodes(divisions, size_m);
    mesh.tetrahedra.reserve(std::size_t{6} * divisions[0] * divisions[1] * divisions[2]);
    const std::array<std::uint32_t, 3> stride{1, divisions[0] + 1, (divisions[0] + 1) * (divisions[1] + 1)};
    for (std::uint32_t k = 0; k < divisions[2]; ++k)
        for (std::uint32_t j = 0; j < divisions[1]; ++j)
            for (std::uint32_t i = 0; i < divisions[0]; ++i) {
                const std::uint32_t origin = i * stride[0] + j * stride[1] + k * stride[2];
                for (const KuhnPath& path : kKuhnPaths) {
                    const std::uint32_t first = origin + stride[path.axes[0]];
                    const std::uint32_t second = first + stride[path.axes[1]];
                    const std::uint32_t last = second + stride[path.axes[2]];
                    mesh.tetrahedra.push_back(path.even ? Tetrahedron{origin, first, second, last}
                                                        : Tetrahedron{origin, second, first, last});
                }
            }
    return mesh;
}

}  // namespace knead::tools
