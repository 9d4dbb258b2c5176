// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// A k-d tree over the barycentres of a mesh's tetrahedra. It answers which tetrahedron contains a point, and
/// which of those not yet removed is nearest. Ties go to the lower index.
///
/// Allocates at construction only. Keeps a reference to the mesh. Not safe to change from several threads.
class TetrahedronTree {
  public:
    explicit TetrahedronTree(const TetMesh& mesh);

    /// A tetrahedron that contains the point, with its boundary (to within rounding); none: std::nullopt.
    /// Tetrahedra that were removed count too.
    [[nodiscard]] std::optional<std::uint32_t> containing(const Point& point) const;

    /// The tetrahedron with the nearest barycentre, removed or not.
    [[nodiscard]] std::uint32_t nearest(const Point& point) const;

    /// The tetrahedron with the nearest barycentre among those not removed; all removed: std::nullopt.
    [[nodiscard]] std::optional<std::uint32_t> nearest_present(const Point& point) const;

    /// Takes a tetrahedron out of nearest_present(). Precondition: not removed before.
    void remove(std::uint32_t tetrahedron);

  private:
    struct Box {
        Point low;
        Point high;
    };
    struct Cell {
        Box barycentres;          ///< of all tetrahedra of the cell
        Box tetrahedra;           ///< the same, with their full extent
        std::uint32_t begin = 0;  ///< in order_
        std::uint32_t end = 0;
        std::uint32_t right_child = 0;  ///< 0: a leaf; the left child is the next cell
        std::uint32_t present = 0;      ///< tetrahedra not removed
    };
    struct Nearest {
        bool present_only;
        double squared_distance;
        std::uint32_t tetrahedron;
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    void fit(Cell& cell) const;
    void search_containing(std::uint32_t cell, const Point& point, std::uint32_t& found) const;
    void search_nearest(std::uint32_t cell, const Point& point, Nearest& best) const;
    [[nodiscard]] bool contains(std::uint32_t tetrahedron, const Point& point) const;

    const TetMesh& mesh_;
    std::vector<Point> barycentre_m_;   ///< [tetrahedra]
    std::vector<std::uint32_t> order_;  ///< tetrahedra in the order of the leaves
    std::vector<std::uint32_t> place_;  ///< [tetrahedra] where each stands in order_
    std::vector<bool> removed_;         ///< [tetrahedra]
    std::vector<Cell> cells_;
};

}  // namespace knead::tools
