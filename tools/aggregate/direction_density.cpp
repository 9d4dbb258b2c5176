// SPDX-License-Identifier: GPL-3.0-or-later
#include "aggregate/direction_density.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace knead::tools {
namespace {

/// Cells along an edge of a cube face: 7.5 degrees each, fine against the smoothing.
constexpr int kCellsPerEdge = 12;
constexpr std::size_t kCells = std::size_t{6} * kCellsPerEdge * kCellsPerEdge;
/// ln 2 / (1 - cos 30 degrees): the weight halves at 30 degrees.
constexpr double kKappa = 5.17;

/// Cell of a direction, which need not have unit length but must not be zero.
std::size_t cell_of(const Point& direction) {
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (std::abs(direction[other]) > std::abs(direction[axis])) axis = other;
    const double scale = 1.0 / std::abs(direction[axis]);
    const auto index = [scale](double coordinate) {
        // Equal angles rather than equal lengths, so that cells have about the same size everywhere.
        const double share = std::atan(coordinate * scale) / std::atan(1.0);
        const int cell = static_cast<int>(std::floor(0.5 * (share + 1.0) * kCellsPerEdge));
        return static_cast<std::size_t>(std::clamp(cell, 0, kCellsPerEdge - 1));
    };
    const std::size_t face = 2 * static_cast<std::size_t>(axis) + (direction[axis] < 0 ? 1 : 0);
    return (face * kCellsPerEdge + index(direction[(axis + 1) % 3])) * kCellsPerEdge +
           index(direction[(axis + 2) % 3]);
}

/// Unit vector through the middle of every cell, in the order of cell_of().
std::vector<Point> cell_centres() {
    const auto middle = [](int cell) {
        return std::tan(((cell + 0.5) / kCellsPerEdge * 2.0 - 1.0) * std::atan(1.0));
    };
    std::vector<Point> centres;
    for (int face = 0; face < 6; ++face)
        for (int u = 0; u < kCellsPerEdge; ++u)
            for (int v = 0; v < kCellsPerEdge; ++v) {
                const int axis = face / 2;
                Point centre{};
                centre[axis] = face % 2 == 0 ? 1.0 : -1.0;
                centre[(axis + 1) % 3] = middle(u);
                centre[(axis + 2) % 3] = middle(v);
                const double length = std::hypot(centre[0], centre[1], centre[2]);
                for (double& coordinate : centre)
                    coordinate /= length;
                centres.push_back(centre);
            }
    return centres;
}

bool has_direction(const Point& offset) {
    return offset[0] != 0 || offset[1] != 0 || offset[2] != 0;
}

}  // namespace

DirectionDensity::DirectionDensity() : cell_(kCells, 0.0) {}

void DirectionDensity::add(const Point& offset_m, double volume_m3) {
    if (has_direction(offset_m)) cell_[cell_of(offset_m)] += volume_m3;
}

void DirectionDensity::finish() {
    const std::vector<Point> centres = cell_centres();
    std::vector<double> smooth(kCells, 0.0);
    for (std::size_t from = 0; from < kCells; ++from) {
        if (cell_[from] <= 0) continue;
        for (std::size_t to = 0; to < kCells; ++to) {
            double cosine = 0;
            for (int axis = 0; axis < 3; ++axis)
                cosine += centres[from][axis] * centres[to][axis];
            smooth[to] += cell_[from] * std::exp(kKappa * (cosine - 1.0));
        }
    }
    const double largest = *std::max_element(smooth.begin(), smooth.end());
    for (std::size_t cell = 0; cell < kCells; ++cell)
        cell_[cell] = largest > 0 ? smooth[cell] / largest : 1.0;
}

double DirectionDensity::relative(const Point& offset_m) const {
    return has_direction(offset_m) ? cell_[cell_of(offset_m)] : 1.0;
}

}  // namespace knead::tools
