// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "stability/specimen.h"

namespace knead::tools::stability {
namespace {

using Corners = std::array<std::uint32_t, 8>;  // bit k of the place: at the far end of axis k

void add_positive(TetMesh& mesh, Tetrahedron t) {
    if (signed_volume_m3(mesh.nodes_m[t[0]], mesh.nodes_m[t[1]], mesh.nodes_m[t[2]], mesh.nodes_m[t[3]]) < 0)
        std::swap(t[2], t[3]);
    mesh.tetrahedra.push_back(t);
}

/// The six monotone paths from corner 0 to corner 7.
void add_cell(TetMesh& mesh, const Corners& corners) {
    constexpr std::array<std::array<unsigned, 3>, 6> kPaths{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (const auto& path : kPaths) {
        Tetrahedron t{corners[0], 0, 0, corners[7]};
        unsigned at = 0;
        for (std::size_t k = 0; k < 2; ++k) {
            at |= 1U << path[k];
            t[k + 1] = corners[at];
        }
        add_positive(mesh, t);
    }
}

/// Nodes made once for each place of an integer grid.
class NodesOnGrid {
  public:
    NodesOnGrid(TetMesh& mesh, double unit_m) : mesh_(mesh), unit_m_(unit_m) {}
    std::uint32_t operator()(const std::array<std::uint64_t, 3>& place) {
        const auto [at, is_new] =
            number_.try_emplace(place, static_cast<std::uint32_t>(mesh_.nodes_m.size()));
        if (is_new) {
            Point node{};
            for (std::size_t k = 0; k < 3; ++k)
                node[k] = unit_m_ * static_cast<double>(place[k]);
            mesh_.nodes_m.push_back(node);
        }
        return at->second;
    }

  private:
    TetMesh& mesh_;
    double unit_m_;
    std::map<std::array<std::uint64_t, 3>, std::uint32_t> number_;
};

Eigen::Vector3d vec(const Point& p) {
    return {p[0], p[1], p[2]};
}

double smallest_dihedral_rad(const TetMesh& mesh, const Tetrahedron& t) {
    std::array<Eigen::Vector3d, 4> normal;  // of the face opposite of node k, outward
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector3d a = vec(mesh.nodes_m[t[(k + 1) % 4]]);
        const Eigen::Vector3d b = vec(mesh.nodes_m[t[(k + 2) % 4]]);
        const Eigen::Vector3d c = vec(mesh.nodes_m[t[(k + 3) % 4]]);
        normal[k] = (b - a).cross(c - a).normalized();
        if (normal[k].dot(vec(mesh.nodes_m[t[k]]) - a) > 0) normal[k] = -normal[k];
    }
    double smallest = M_PI;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j)
            smallest =
                std::min(smallest, std::atan2(normal[i].cross(normal[j]).norm(), -normal[i].dot(normal[j])));
    return smallest;
}

/// The four tetrahedra about a fifth node with weight `far` on what is not the face or edge.
std::array<Tetrahedron, 4> cut(TetMesh& mesh, const Tetrahedron& t, Flaw flaw, double far) {
    const std::array<double, 4> weight = flaw == Flaw::near_face
                                             ? std::array{far, (1 - far) / 3, (1 - far) / 3, (1 - far) / 3}
                                             : std::array{far / 2, far / 2, (1 - far) / 2, (1 - far) / 2};
    Point node{};
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            node[axis] += weight[k] * mesh.nodes_m[t[k]][axis];
    const auto fifth = static_cast<std::uint32_t>(mesh.nodes_m.size());
    mesh.nodes_m.push_back(node);
    std::array<Tetrahedron, 4> parts{t, t, t, t};
    for (std::size_t k = 0; k < 4; ++k)
        parts[k][k] = fifth;
    return parts;
}

/// Weight at which the flattest of the four parts has that smallest angle, by bisection.
double weight_for(const TetMesh& mesh, const Tetrahedron& t, Flaw flaw, double angle_rad) {
    double low = 0, high = 0.25;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        TetMesh trial;
        for (const std::uint32_t node : t)
            trial.nodes_m.push_back(mesh.nodes_m[node]);
        double smallest = M_PI;
        for (const Tetrahedron& part : cut(trial, {0, 1, 2, 3}, flaw, middle))
            smallest = std::min(smallest, smallest_dihedral_rad(trial, part));
        (smallest < angle_rad ? low : high) = middle;
    }
    return high;
}

/// Uniform in [0, 1), the same on every platform.
double draw(std::mt19937_64& engine) {
    return static_cast<double>(engine() >> 11U) * 0x1.0p-53;
}

std::vector<bool> islands(std::uint32_t cells, std::size_t tetrahedra) {
    std::vector<bool> stiff(tetrahedra, false);
    for (std::uint32_t z = 1; z + 1 < cells; z += 2)
        for (std::uint32_t y = 1; y + 1 < cells; y += 2)
            for (std::uint32_t x = 1; x + 1 < cells; x += 2)
                for (std::uint32_t k = 0; k < 6; ++k)
                    stiff[std::size_t{6} * ((std::size_t{z} * cells + y) * cells + x) + k] = true;
    return stiff;
}

}  // namespace

TetMesh box_mesh(const std::array<std::uint32_t, 3>& cells, const Point& size_m) {
    TetMesh mesh;
    for (std::uint32_t z = 0; z <= cells[2]; ++z)
        for (std::uint32_t y = 0; y <= cells[1]; ++y)
            for (std::uint32_t x = 0; x <= cells[0]; ++x)
                mesh.nodes_m.push_back(
                    {size_m[0] * x / cells[0], size_m[1] * y / cells[1], size_m[2] * z / cells[2]});
    const std::uint32_t row = cells[0] + 1, layer = row * (cells[1] + 1);
    for (std::uint32_t z = 0; z < cells[2]; ++z)
        for (std::uint32_t y = 0; y < cells[1]; ++y)
            for (std::uint32_t x = 0; x < cells[0]; ++x) {
                Corners corners{};
                for (std::uint32_t k = 0; k < 8; ++k)
                    corners[k] = x + (k & 1U) + row * (y + (k >> 1U & 1U)) + layer * (z + (k >> 2U));
                add_cell(mesh, corners);
            }
    return mesh;
}

TetMesh graded_corner(double side_m, std::uint32_t ratio) {
    // The cube [0, 2] of unit cells, then shells between [0, s] and [0, 2 s].
    constexpr std::uint64_t kAcross = 2;
    TetMesh mesh;
    NodesOnGrid node(mesh, side_m / (static_cast<double>(kAcross) * ratio));
    const auto block = [&](const std::array<std::uint64_t, 3>& at, std::uint64_t size) {
        Corners corners{};
        for (unsigned k = 0; k < 8; ++k)
            corners[k] =
                node({at[0] + size * (k & 1U), at[1] + size * (k >> 1U & 1U), at[2] + size * (k >> 2U)});
        add_cell(mesh, corners);
    };
    for (std::uint64_t z = 0; z < kAcross; ++z)
        for (std::uint64_t y = 0; y < kAcross; ++y)
            for (std::uint64_t x = 0; x < kAcross; ++x)
                block({x, y, z}, 1);
    // A shell maps each cell of the three far faces of [0, s] to that of [0, 2 s]: frustums, no hanging
    // nodes.
    for (std::uint64_t inner = 1; inner < ratio; inner *= 2) {
        const std::uint64_t edge = kAcross * inner;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::uint64_t j = 0; j < kAcross; ++j)
                for (std::uint64_t i = 0; i < kAcross; ++i) {
                    Corners corners{};
                    for (unsigned k = 0; k < 8; ++k) {
                        std::array<std::uint64_t, 3> place{};
                        const std::uint64_t scale = (k >> 2U) != 0 ? 2 : 1;
                        place[axis] = scale * edge;
                        place[(axis + 1) % 3] = scale * inner * (i + (k & 1U));
                        place[(axis + 2) % 3] = scale * inner * (j + (k >> 1U & 1U));
                        corners[k] = node(place);
                    }
                    add_cell(mesh, corners);
                }
    }
    return mesh;
}

TetMesh with_slivers(const TetMesh& mesh, Flaw flaw, double angle_rad, std::size_t every) {
    TetMesh spoilt;
    spoilt.nodes_m = mesh.nodes_m;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        if (t % every != 0) {
            spoilt.tetrahedra.push_back(mesh.tetrahedra[t]);
            continue;
        }
        const double far = weight_for(mesh, mesh.tetrahedra[t], flaw, angle_rad);
        for (const Tetrahedron& part : cut(spoilt, mesh.tetrahedra[t], flaw, far))
            spoilt.tetrahedra.push_back(part);
    }
    return spoilt;
}

double smallest_dihedral_rad(const TetMesh& mesh) {
    double smallest = M_PI;
    for (const Tetrahedron& t : mesh.tetrahedra)
        smallest = std::min(smallest, smallest_dihedral_rad(mesh, t));
    return smallest;
}

TetMesh side_by_side(const TetMesh& a, const TetMesh& b, const Point& b_moved_m) {
    TetMesh both = a;
    const auto first = static_cast<std::uint32_t>(a.nodes_m.size());
    for (Point node : b.nodes_m) {
        for (std::size_t k = 0; k < 3; ++k)
            node[k] += b_moved_m[k];
        both.nodes_m.push_back(node);
    }
    for (Tetrahedron t : b.tetrahedra) {
        for (std::uint32_t& node : t)
            node += first;
        both.tetrahedra.push_back(t);
    }
    return both;
}

MaterialObject contrast_cube(std::uint32_t cells, double side_m, double poissons_ratio, double contrast,
                             Layout layout) {
    constexpr double kSoft_pa = 4000;
    MaterialObject object = homogeneous(box_mesh({cells, cells, cells}, {side_m, side_m, side_m}),
                                        {kSoft_pa, poissons_ratio, kDensity_kg_per_m3});
    const std::size_t count = object.mesh.tetrahedra.size();
    std::vector<bool> stiff = islands(cells, count);
    if (layout == Layout::percolating) {
        std::mt19937_64 engine(1);
        for (std::size_t t = 0; t < count; ++t)
            stiff[t] = draw(engine) < 0.5;
    }
    for (std::size_t t = 0; t < count; ++t)
        if (stiff[t]) object.material.youngs_modulus_pa[t] *= contrast;
    return object;
}

}  // namespace knead::tools::stability
