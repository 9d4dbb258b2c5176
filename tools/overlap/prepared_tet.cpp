// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlap/prepared_tet.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "overlap/exact.h"
#include "overlap/plane_values.h"
#include "overlap/rounding.h"
#include "overlap/with_threads.h"

namespace knead::tools {
namespace {

constexpr double kVolumeAccuracy = 4e-13;

template <class Real>
double volume_with_error(const PreparedTet& tet, const Faces<Real>& faces, double& error) {
    Point reach;
    for (int axis = 0; axis < 3; ++axis)
        reach[axis] = tet.high[axis] - tet.low[axis];
    error = plane_value_errors<Real>(tet.normal_scale, reach)[3] / 6;
    return static_cast<double>(plane_values(tet.corners, faces)[3][3] / 6);
}

double certain_volume(const PreparedTet& tet) {
    double error = 0;
    double volume = volume_with_error(tet, tet.faces, error);
    if (error <= kVolumeAccuracy * volume) return volume;
    volume = volume_with_error(tet, faces_of<long double>(tet.corners), error);
    if (error <= kVolumeAccuracy * volume) return volume;
    return exact_volume(tet.corners);
}

Corners corners_of(const TetMesh& mesh, std::size_t tetrahedron, int exponent) {
    Corners corners;
    for (int corner = 0; corner < 4; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            corners[corner][axis] =
                std::ldexp(mesh.nodes_m[mesh.tetrahedra[tetrahedron][corner]][axis], -exponent);
    return corners;
}

template <class Function>
void for_each_tetrahedron(const TetMesh& mesh, unsigned threads, const Function& function) {
    with_threads(threads, [&] { tbb::parallel_for(std::size_t{0}, mesh.tetrahedra.size(), function); });
}

}  // namespace

PreparedTet prepare(const Corners& corners) {
    PreparedTet tet;
    tet.corners = corners;
    tet.faces = faces_of<double>(corners);
    tet.normal_scale = normal_scale_of(corners);
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            std::minmax({corners[0][axis], corners[1][axis], corners[2][axis], corners[3][axis]});
        tet.low[axis] = low;
        tet.high[axis] = high;
    }
    tet.volume = certain_volume(tet);
    return tet;
}

std::vector<PreparedTet> prepare_all(const TetMesh& mesh, int exponent, unsigned threads) {
    std::vector<PreparedTet> prepared(mesh.tetrahedra.size());
    for_each_tetrahedron(mesh, threads,
                         [&](std::size_t i) { prepared[i] = prepare(corners_of(mesh, i, exponent)); });
    return prepared;
}

std::vector<double> accurate_volumes_m3(const TetMesh& mesh, unsigned threads) {
    const int exponent = exponent_of(mesh);
    std::vector<double> volumes(mesh.tetrahedra.size());
    for_each_tetrahedron(mesh, threads, [&](std::size_t i) {
        volumes[i] = std::ldexp(prepare(corners_of(mesh, i, exponent)).volume, 3 * exponent);
    });
    return volumes;
}

int exponent_of(const TetMesh& mesh) {
    double largest = 0;
    for (const Point& node : mesh.nodes_m)
        for (const double coordinate : node)
            largest = std::max(largest, std::abs(coordinate));
    return largest > 0 ? std::ilogb(largest) : 0;
}

}  // namespace knead::tools
