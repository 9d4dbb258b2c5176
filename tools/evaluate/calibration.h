// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "evaluate/level_mesh.h"
#include "evaluate/loads.h"
#include "knead/formats/material.h"

namespace knead::tools {

/// How the elasticities are fitted.
struct CalibrationOptions {
    int iterations = 12;
    double regularisation = 1;  ///< added to the diagonal of the probes' matrix, shares of energy squared
    double lowest = 0.5;        ///< of the softest fine tetrahedron
    double highest = 1.5;       ///< of the stiffest
};

struct Calibration {
    Material material;        ///< of the level's mesh
    double worst_before = 0;  ///< largest |log(answer / fine answer)| of a probe, start
    double worst_after = 0;   ///< the same at the end
    double root_mean_square_after = 0;
};

/// Pads that the fit uses: rectangles of 0.2 x 0.3 of a face and the same turned, a tenth apart along one side
/// and two along the other, on the upper side and the four beside it. None is a load of loads.h (those are
/// squares), many overlap one.
/// @param object bounding box of the fine mesh
[[nodiscard]] std::vector<Load> probe_pads(const Box& object);

/// What the object is asked in small displacements.
///
/// Six probes move the whole upper surface rigidly along and about each axis; the others move a pad straight
/// into the object, bonded to the surface on average just as a load is (loads.h). Answers are twice the
/// energy: force times motion.
class Probes {
  public:
    /// @param object bounding box of the fine mesh
    /// @param pads each on this mesh's surface and clear of what is held
    Probes(const TetMesh& mesh, const std::vector<bool>& is_held, const Box& object,
           const std::vector<Load>& pads);

    struct Answers {
        std::vector<double> values_j;  ///< [probes]
        std::vector<std::vector<double>>
            shares;  ///< [probes][tetrahedra] d log(answer) / d log(E), if asked for
    };
    [[nodiscard]] Answers ask(const Material& material, bool with_shares) const;
    [[nodiscard]] std::size_t count() const { return motions_.size() + pads_.size(); }

  private:
    /// A sum of weighted nodes that follows the pad; the same weights in each axis.
    struct Row {
        std::vector<std::pair<std::uint32_t, double>> nodes;
        Point motion_m{};
    };
    struct Pad {
        std::size_t face = 0;
        std::vector<Row> rows;
    };

    const TetMesh& mesh_;
    std::vector<bool> is_held_, is_held_or_tool_;    // [3 nodes]
    std::vector<std::vector<double>> motions_;       // [probes][3 nodes] displacements
    std::vector<Pad> pads_;                          // in the order of their faces
    std::vector<std::vector<std::uint32_t>> faces_;  // [faces] nodes of all pads on it, increasing
};

/// Which pads this mesh can be asked for: those that have a surface under them and touch nothing held.
[[nodiscard]] std::vector<bool> askable_pads(const std::vector<Load>& pads, const TetMesh& mesh,
                                             const std::vector<bool>& is_held);

/// Finds, from the volume average on, elasticities of the level's mesh with which it answers the probes like
/// the fine object: Gauss-Newton on log E with the least change that does it. Pads that one of the two meshes
/// cannot be asked for are left out.
/// Source: the design of this project (docs/method.md); in the spirit of the data-driven fit of [CLSM15].
[[nodiscard]] Calibration calibrate(const MaterialObject& fine, const std::vector<bool>& fine_is_held,
                                    const LevelMesh& level, const std::vector<bool>& level_is_held,
                                    const CalibrationOptions& options = {});

/// Whether the loads of this name are combinations of the probes' motions of the upper surface.
[[nodiscard]] bool is_probed(const std::string& load);

}  // namespace knead::tools
