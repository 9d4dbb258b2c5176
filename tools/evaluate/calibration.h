// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "evaluate/level_mesh.h"
#include "evaluate/surface_region.h"
#include "knead/formats/material.h"

namespace knead::tools {

/// How the elasticities are fitted.
struct CalibrationOptions {
    int iterations = 12;
    double regularisation = 0.1;  ///< added to the diagonal of the probes' matrix, shares of energy squared
    double lowest = 0.5;          ///< of the softest fine tetrahedron
    double highest = 1.5;         ///< of the stiffest
};

struct Calibration {
    Material material;        ///< of the level's mesh
    double worst_before = 0;  ///< largest |log(answer / fine answer)| of a probe, start
    double worst_after = 0;   ///< the same at the end
    double root_mean_square_after = 0;
};

/// What the object is asked in small displacements.
///
/// Six probes move the whole upper surface rigidly along and about each axis and take the force or moment;
/// the others press a pad with one newton, evenly, and take how far it gives: 3 x 3 pads, each a third of the
/// side, on the upper surface and on the four sides, and 4 x 4 pads of a quarter on the upper surface.
/// Answers are energies: force times motion.
class Probes {
  public:
    /// @param object bounding box of the fine mesh
    Probes(const TetMesh& mesh, const std::vector<bool>& is_held, const Box& object);

    struct Answers {
        std::vector<double> values_j;  ///< [probes]
        std::vector<std::vector<double>>
            shares;  ///< [probes][tetrahedra] d log(answer) / d log(E), if asked for
    };
    [[nodiscard]] Answers ask(const Material& material, bool with_shares) const;
    [[nodiscard]] std::size_t count() const { return motions_.size() + pushes_.size(); }

  private:
    const TetMesh& mesh_;
    std::vector<bool> is_held_, is_held_or_tool_;        // [3 nodes]
    std::vector<std::vector<double>> motions_, pushes_;  // [probes][3 nodes] displacements, forces
};

/// Finds, from the volume average on, elasticities of the level's mesh with which it answers the probes like
/// the fine object: Gauss-Newton on log E with the least change that does it.
/// Source: the design of this project (docs/method.md); in the spirit of the data-driven fit of [CLSM15].
[[nodiscard]] Calibration calibrate(const MaterialObject& fine, const std::vector<bool>& fine_is_held,
                                    const LevelMesh& level, const std::vector<bool>& level_is_held,
                                    const CalibrationOptions& options = {});

/// Whether the loads of this name are combinations of the probes' motions of the upper surface.
[[nodiscard]] bool is_probed(const std::string& load);

}  // namespace knead::tools
